#include "tests/system/robot.h"

#include "terrain/files/map_file.h"

namespace terra::testing {
namespace {

using std::chrono::milliseconds;
using terra_msg::baseline_t;
using terra_msg::deployed_t;

bool IsAdvisor(const std::string& name) {
  return name != "map" && name != "planner" && name != "graph-planner" &&
         name != "verifier" && name != "logger";
}

}  // namespace

BusPeer& Robot::BusOf(const std::string& name) {
  return IsAdvisor(name) ? advice_ : deployed_;
}

Robot::Robot(const TerrainMap& map)
    : deployed_(buses_.url()), advice_(buses_.advice_url()) {
  SaveMap(map);
}

void Robot::SaveMap(const TerrainMap& map) {
  // Renamed into place, so that nobody reads half a file.
  const std::string written = folder_.Path("written.png");
  if (!WriteIdPng(map, written).ok()) throw std::runtime_error("no map file");
  std::filesystem::rename(written, map_path());
}

std::vector<std::string> Robot::BusOptions() const {
  return {"--lcm-url", buses_.url(), "--advice-url", buses_.advice_url()};
}

ChildProcess& Robot::Start(const std::string& name,
                           const std::vector<std::string>& options) {
  const bool has_program = !IsAdvisor(name);
  std::vector<std::string> command = before_;
  command.push_back(
      ProgramPath(has_program ? "terra-" + name : "terra-advisor"));
  for (const std::string& option : BusOptions()) command.push_back(option);
  if (name == "map") {
    command.insert(command.end(), {"--map", map_path()});
  } else {
    command.insert(command.end(), {"--name", name});
  }
  command.insert(command.end(), options.begin(), options.end());
  processes_.erase(name);  // Dead before the new one speaks.
  return *(processes_[name] = std::make_unique<ChildProcess>(command));
}

std::optional<deployed_t> Robot::Ask(std::int64_t request_id, Cell start,
                                     Cell goal) {
  terra_msg::plan_request_t request{};
  request.request_id = request_id;
  request.action = terra_msg::plan_request_t::ACTION_GO;
  request.start_x = start.x;
  request.start_y = start.y;
  request.goal_x = goal.x;
  request.goal_y = goal.y;
  const bus::Time until = bus::Clock::now() + BusPeer::kPatience;
  do {
    deployed_.Send(request);
    const auto deployed = deployed_.WaitFor<deployed_t>(
        [request_id](const deployed_t& message) {
          return message.request_id == request_id &&
                 message.mode != deployed_t::MODE_NONE;
        },
        milliseconds(200));
    if (deployed) return deployed;
  } while (bus::Clock::now() < until);
  return std::nullopt;
}

std::optional<deployed_t> Robot::WaitForDeployed(std::int64_t request_id,
                                                 std::int8_t mode) {
  return deployed_.WaitFor<deployed_t>([=](const deployed_t& message) {
    return message.request_id == request_id && message.mode == mode;
  });
}

bool Robot::WaitForReady(const std::string& name, milliseconds at_most) {
  const pid_t pid = process(name).pid();
  return BusOf(name)
      .WaitFor<terra_msg::status_t>(
          [&](const terra_msg::status_t& status) {
            return status.status_name == name && status.pid == pid &&
                   status.state.starts_with("ready");
          },
          at_most)
      .has_value();
}

}  // namespace terra::testing
