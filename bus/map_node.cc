#include "bus/map_node.h"

#include <filesystem>
#include <system_error>

namespace terra::bus {
namespace {

namespace fs = std::filesystem;

// Size and time of a file, as a text that changes when the file does.
std::string StampOf(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) return "-";
  const auto time = fs::last_write_time(path, error);
  return std::to_string(size) + "@" +
         std::to_string(time.time_since_epoch().count());
}

// All files that the map is made of: a ROS yaml names a picture, which by
// custom lies beside it under the same name.
std::string StampOfAll(const std::string& path, const std::string& legend) {
  std::string stamp = StampOf(path) + " " + StampOf(legend);
  const fs::path yaml(path);
  if (yaml.extension() == ".yaml" || yaml.extension() == ".yml") {
    for (const char* extension : {".pgm", ".png"}) {
      fs::path picture(yaml);
      stamp += " " + StampOf(picture.replace_extension(extension));
    }
  }
  return stamp;
}

}  // namespace

MapNode::MapNode(std::string path, MapFileOptions options, Outbox& out)
    : path_(std::move(path)), options_(std::move(options)), sender_(out) {
  Listen<terra_msg::map_request_t>([this](const auto& message, Time now) {
    sender_.OnRequest(message, now);
  });
}

Status MapNode::Load() {
  loaded_stamp_ = seen_stamp_ = StampOfAll(path_, options_.legend);
  const Result<MapFile> file = ReadMap(path_, options_);
  if (!file) return file.error();
  terra_msg::map_header_t header = MakeMapHeader(file->map);
  header.cell_size_m = file->placement.cell_size;
  header.origin_x_m = file->placement.origin_x;
  header.origin_y_m = file->placement.origin_y;
  header.origin_yaw_rad = file->placement.origin_yaw;
  ++loads_;
  sender_.SetMap(file->map.ids(), std::move(header));
  return Done{};
}

void MapNode::LookAtFiles() {
  const std::string stamp = StampOfAll(path_, options_.legend);
  // Read only what was the same twice: a file that is being written is not.
  const bool at_rest = stamp == seen_stamp_;
  seen_stamp_ = stamp;
  if (!at_rest || stamp == loaded_stamp_) return;
  const Status loaded = Load();
  last_error_ = loaded ? "" : "map not reloaded: " + loaded.error().message;
}

Time MapNode::Advance(Time now) {
  if (look_.Due(now)) LookAtFiles();
  return std::min(look_.next(), sender_.Advance(now));
}

std::string MapNode::state() const {
  return "ready, " + std::to_string(sender_.header().width) + " x " +
         std::to_string(sender_.header().height) + " cells";
}

void MapNode::AddCounters(Counters& counters) const {
  Node::AddCounters(counters);
  counters.emplace_back("loads", loads_);
  counters.emplace_back("tiles_sent", sender_.tiles_sent());
}

}  // namespace terra::bus
