#include "bus/map_node.h"

#include <utility>

#include "bus/log.h"
#include "bus/subscribers.h"

namespace terra::bus {

MapNode::MapNode(std::string path, MapFileOptions options, Outbox& out)
    : path_(std::move(path)),
      options_(std::move(options)),
      sender_(out),
      watch_([this]() -> Status {
        Result<MapFile> file = ReadMap(path_, options_);
        if (!file) return file.error();
        read_ = *std::move(file);
        return Done{};
      }) {
  Listen<terra_msg::map_request_t>([this](const auto& message, Time now) {
    sender_.OnRequest(message, now);
  });
}

Status MapNode::Load() {
  Status loaded = watch_.Begin();
  if (loaded) Serve();
  return loaded;
}

void MapNode::Serve() {
  const MapFile file = *std::exchange(read_, std::nullopt);
  terra_msg::map_header_t header = MakeMapHeader(file.map);
  header.cell_size_m = file.placement.cell_size;
  header.origin_x_m = file.placement.origin_x;
  header.origin_y_m = file.placement.origin_y;
  header.origin_yaw_rad = file.placement.origin_yaw;
  ++loads_;
  sender_.SetMap(file.map.ids(), std::move(header));
  if (file.notices == said_) return;
  said_ = file.notices;
  for (const std::string& notice : said_) LogWarning(notice);
}

void MapNode::LookAtFiles() {
  const std::optional<Status> loaded = watch_.Look();
  if (!loaded) return;
  if (*loaded) Serve();
  last_error_ = *loaded ? "" : "map not reloaded: " + loaded->error().message;
}

Time MapNode::Advance(Time now) {
  if (look_.Due(now)) LookAtFiles();
  return std::min(look_.next(), sender_.Advance(now));
}

std::string MapNode::state() const {
  return "ready, " + std::to_string(sender_.header().width) + " x " +
         std::to_string(sender_.header().height) + " cells";
}

std::string MapNode::last_error() const {
  return last_error_.empty() ? SubscribersWarning(subscribers_) : last_error_;
}

void MapNode::AddCounters(Counters& counters) const {
  Node::AddCounters(counters);
  counters.emplace_back("loads", loads_);
  counters.emplace_back("subscribers", subscribers_);
  counters.emplace_back("tiles_sent", sender_.tiles_sent());
}

}  // namespace terra::bus
