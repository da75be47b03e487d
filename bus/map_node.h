#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/map_sender.h"
#include "bus/node.h"
#include "terrain/files/file_watch.h"
#include "terrain/files/map_file.h"

namespace terra::bus {

/// The map server: reads a map file, serves it by tiles, and reads it again
/// when it, its legend or a picture that it names changes. Files that cannot be
/// read later leave the map in force as it is; the heartbeat says why.
class MapNode : public Node {
 public:
  MapNode(std::string path, MapFileOptions options, Outbox& out);

  /// Reads the file. To be called once, before the node runs.
  Status Load();

  /// For the heartbeat: how many sockets hear the deployed bus. From
  /// kManySubscribers on it warns.
  void NoteSubscribers(std::int64_t sockets) { subscribers_ = sockets; }

  Time Advance(Time now) override;
  std::string state() const override;
  std::string last_error() const override;
  void AddCounters(Counters& counters) const override;

 private:
  void Serve();
  void LookAtFiles();

  std::string path_;
  MapFileOptions options_;
  MapSender sender_;
  FileWatch watch_;
  std::optional<MapFile> read_;  ///< Not yet served.
  std::vector<std::string> said_;
  std::string last_error_;
  Periodic look_{std::chrono::milliseconds(FileWatch::kPeriodMs)};
  std::int64_t loads_ = 0;
  std::int64_t subscribers_ = 0;
};

}  // namespace terra::bus
