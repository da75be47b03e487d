#include "benchmark/speed/speed_folder.h"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "output/output_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

std::string NameOf(int side, const std::string& family, int index) {
  return std::to_string(side) + "-" + family + "-" + std::to_string(index);
}
std::string NameOf(const SpeedCase& c) {
  return NameOf(c.map.width(), c.family, c.index);
}

void Write(const fs::path& path, const std::string& bytes) {
  const Status written = WriteWholeFile(path.string(), bytes);
  if (!written.ok()) throw std::runtime_error(written.error().message);
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
  Write(folder_ / "maps" / (NameOf(c) + ".f32"), costs);
  std::ostringstream ends;
  ends << "side,family,index,start_x,start_y,goal_x,goal_y\n"
       << c.map.width() << ',' << c.family << ',' << c.index << ',' << c.start.x
       << ',' << c.start.y << ',' << c.goal.x << ',' << c.goal.y << '\n';
  Write(folder_ / "maps" / (NameOf(c) + ".csv"), ends.str());
}

void SpeedFolder::WriteSamples(const SpeedCase& c,
                               const std::vector<TimedSample>& samples) const {
  std::ostringstream text;
  text << "side,family,index,work,microseconds,amount\n";
  for (const TimedSample& s : samples) {
    text << c.map.width() << ',' << c.family << ',' << c.index << ",\""
         << s.name << "\"," << s.microseconds << ',' << s.amount << '\n';
  }
  Write(folder_ / "samples" / (NameOf(c) + ".csv"), text.str());
}

}  // namespace terra::benchmark
