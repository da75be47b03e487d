#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/map_sender.h"
#include "bus/node.h"
#include "terrain/files/map_file.h"

namespace terra::bus {

/// The map server: reads a map file, serves it by tiles, and reads it again
/// when it changes. A file that cannot be read later leaves the map in force as
/// it is; the heartbeat says why.
class MapNode : public Node {
 public:
  MapNode(std::string path, MapFileOptions options, Outbox& out);

  /// Reads the file. To be called once, before the node runs.
  Status Load();

  Time Advance(Time now) override;
  std::string state() const override;
  std::string last_error() const override { return last_error_; }
  void AddCounters(Counters& counters) const override;

 private:
  void LookAtFiles();

  std::string path_;
  MapFileOptions options_;
  MapSender sender_;
  std::string last_error_;
  std::string loaded_stamp_;
  std::string seen_stamp_;
  Periodic look_{std::chrono::milliseconds(500)};
  std::int64_t loads_ = 0;
};

}  // namespace terra::bus
