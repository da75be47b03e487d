#include "benchmark/speed/speed_folder.h"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

std::string NameOf(int side, const std::string& family, int index) {
  return std::to_string(side) + "-" + family + "-" + std::to_string(index);
}
std::string NameOf(const SpeedCase& c) {
  return NameOf(c.map.width(), c.family, c.index);
}

void WriteAtOnce(const fs::path& path, const std::string& bytes) {
  const fs::path part = path.string() + ".part";
  std::ofstream file(part, std::ios::binary);
  file << bytes;
  file.close();
  if (file.fail()) {
    throw std::runtime_error("cannot write " + part.string());
  }
  fs::rename(part, path);
}

}  // namespace

SpeedFolder::SpeedFolder(fs::path folder) : folder_(std::move(folder)) {
  fs::create_directories(folder_ / "samples");
  fs::create_directories(folder_ / "maps");
}

bool SpeedFolder::Has(int side, const std::string& family, int index) const {
  return fs::exists(folder_ / "samples" /
                    (NameOf(side, family, index) + ".csv"));
}

void SpeedFolder::WriteMap(const SpeedCase& c) const {
  std::string costs;
  for (int y = 0; y < c.map.height(); ++y) {
    for (int x = 0; x < c.map.width(); ++x) {
      const auto cost = static_cast<float>(c.map.Cost({x, y}));
      costs.append(reinterpret_cast<const char*>(&cost), sizeof(cost));
    }
  }
  WriteAtOnce(folder_ / "maps" / (NameOf(c) + ".f32"), costs);
  std::ostringstream ends;
  ends << "side,family,index,start_x,start_y,goal_x,goal_y\n"
       << c.map.width() << ',' << c.family << ',' << c.index << ',' << c.start.x
       << ',' << c.start.y << ',' << c.goal.x << ',' << c.goal.y << '\n';
  WriteAtOnce(folder_ / "maps" / (NameOf(c) + ".csv"), ends.str());
}

void SpeedFolder::WriteSamples(const SpeedCase& c,
                               const std::vector<TimedSample>& samples) const {
  std::ostringstream text;
  text << "side,family,index,work,microseconds,amount\n";
  for (const TimedSample& s : samples) {
    text << c.map.width() << ',' << c.family << ',' << c.index << ",\""
         << s.name << "\"," << s.microseconds << ',' << s.amount << '\n';
  }
  WriteAtOnce(folder_ / "samples" / (NameOf(c) + ".csv"), text.str());
}

}  // namespace terra::benchmark
