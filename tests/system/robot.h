#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "terrain/map.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_bus.h"

namespace terra::testing {

/// The whole set as real processes on a bus of its own, with the test as a peer
/// on it.
class Robot {
 public:
  /// Writes the map to a file that terra-map will serve.
  explicit Robot(const TerrainMap& map);

  /// Starts a process, or starts it anew after it was killed. Names: "map",
  /// "planner", "graph-planner", "verifier", "logger", "advisor"; any other is
  /// an advisor of that name.
  ChildProcess& Start(const std::string& name,
                      const std::vector<std::string>& options = {});
  /// What stands in front of the command of each process started from now on.
  void StartBehind(std::vector<std::string> before) {
    before_ = std::move(before);
  }
  void Kill(const std::string& name) { processes_.erase(name); }
  ChildProcess& process(const std::string& name) {
    return *processes_.at(name);
  }

  /// Asks as a requester that repeats itself until planner and gate answer.
  /// Returns what the gate deployed first for it; nothing when nothing came.
  std::optional<terra_msg::deployed_t> Ask(std::int64_t request_id, Cell start,
                                           Cell goal);
  /// Waits for a deployment of a request in a mode.
  std::optional<terra_msg::deployed_t> WaitForDeployed(std::int64_t request_id,
                                                       std::int8_t mode);
  /// Waits for a heartbeat of the process that now has this name, whose state
  /// begins with "ready".
  bool WaitForReady(const std::string& name,
                    std::chrono::milliseconds at_most = BusPeer::kPatience);

  void SaveMap(const TerrainMap& map);

  /// --lcm-url and --advice-url, for programs that the test starts itself.
  std::vector<std::string> BusOptions() const;
  std::string map_path() const { return folder_.Path("map.png"); }
  const TempFolder& folder() const { return folder_; }
  const TestBus& buses() const { return buses_; }
  BusPeer& deployed_bus() { return deployed_; }
  BusPeer& advice_bus() { return advice_; }
  /// Where the process of this name says its STATUS.
  BusPeer& BusOf(const std::string& name);

 private:
  TestBus buses_;
  TempFolder folder_;
  BusPeer deployed_;
  BusPeer advice_;
  std::vector<std::string> before_;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;
};

}  // namespace terra::testing
