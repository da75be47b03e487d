#include "benchmark/panels.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "benchmark/results_reader.h"
#include "benchmark/rugd.h"
#include "benchmark/run_description.h"
#include "planner/coarse_lattice.h"
#include "terrain/files/case_reader.h"
#include "terrain/files/image.h"
#include "terrain/files/picture.h"
#include "terrain/files/whole_file.h"
#include "terrain/segment.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

cv::Scalar Bgr(Color color) {
  return {double(color.b), double(color.g), double(color.r)};
}

cv::Mat TerrainImage(const TerrainMap& map) {
  std::array<cv::Vec3b, 256> colors{};
  for (const Terrain& terrain : map.legend().terrains()) {
    const Color c = terrain.color;
    colors[static_cast<std::size_t>(terrain.id)] = {c.b, c.g, c.r};
  }
  cv::Mat image(map.height(), map.width(), CV_8UC3);
  for (int y = 0; y < map.height(); ++y) {
    auto* row = image.ptr<cv::Vec3b>(y);
    for (int x = 0; x < map.width(); ++x) row[x] = colors[map.ids()(y, x)];
  }
  return image;
}

void DrawGrid(cv::Mat& image, int stride) {
  const cv::Scalar gray(170, 170, 170);
  for (int x = 0; x < image.cols; x += stride) {
    cv::line(image, {x, 0}, {x, image.rows - 1}, gray);
  }
  for (int y = 0; y < image.rows; y += stride) {
    cv::line(image, {0, y}, {image.cols - 1, y}, gray);
  }
}

void DrawRoute(cv::Mat& image, const Route& route, Color color) {
  std::vector<cv::Point> points;
  for (const Cell cell : RasterizeRoute(route)) {
    points.emplace_back(cell.x, cell.y);
  }
  cv::polylines(image, points, false, cv::Scalar::all(255), 7, cv::LINE_AA);
  cv::polylines(image, points, false, Bgr(color), 3, cv::LINE_AA);
}

void DrawEnd(cv::Mat& image, Cell cell, const char* letter) {
  const cv::Point center(cell.x, cell.y);
  cv::circle(image, center, 10, cv::Scalar::all(255), cv::FILLED, cv::LINE_AA);
  cv::circle(image, center, 10, cv::Scalar::all(0), 2, cv::LINE_AA);
  cv::putText(image, letter, center + cv::Point(-5, 5),
              cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar::all(0), 1,
              cv::LINE_AA);
}

// A row that may be shown, and what was gained.
struct Candidate {
  double gain = 0;
  std::int64_t row = 0;
};

// At even distances from the largest gain to the smallest.
std::vector<Candidate> Spread(std::vector<Candidate> all, int wanted) {
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.row < b.row;
  });
  std::vector<Candidate> chosen;
  const std::size_t count =
      std::min(all.size(), static_cast<std::size_t>(wanted));
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(all[i * all.size() / count]);
  }
  return chosen;
}

// The candidates of a group: all, or of very many those of every n-th row.
class Candidates {
 public:
  void Add(const Candidate& candidate) {
    if (candidate.row % every_ == 0) kept_.push_back(candidate);
    if (std::ssize(kept_) <= kMostKept) return;
    every_ *= 2;
    std::erase_if(kept_, [this](const Candidate& c) {
      return c.row % every_ != 0;
    });
  }
  std::vector<Candidate> Take() { return std::move(kept_); }

 private:
  static constexpr std::ptrdiff_t kMostKept = 1'000'000;

  std::vector<Candidate> kept_;
  std::int64_t every_ = 1;
};

// The rows to show, by case. Twice through the file, so that only their routes
// are kept.
Result<std::map<std::string, CaseResult>> ChooseRows(const std::string& path,
                                                     int per_group) {
  std::map<std::string, Candidates> groups;
  std::int64_t row = 0;
  const Status ranked = ReadResults(path, [&](const CaseResult& r) {
    const std::int64_t number = row++;
    if (r.code != verifier::Code::kAccepted || r.repeat != 0) return;
    const double gain = (r.baseline_cost - r.final_cost) / r.baseline_cost;
    groups[r.group].Add({gain, number});
  });
  if (!ranked.ok()) return ranked.error();
  std::set<std::int64_t> wanted;
  for (auto& [group, all] : groups) {
    for (const Candidate& candidate : Spread(all.Take(), per_group)) {
      wanted.insert(candidate.row);
    }
  }
  std::map<std::string, CaseResult> chosen;
  row = 0;
  const Status read = ReadResults(path, [&](CaseResult r) {
    if (wanted.contains(row++)) chosen.emplace(r.case_id, std::move(r));
  });
  if (!read.ok()) return read.error();
  return chosen;
}

// The cases of these rows. Errors: the dataset lacks one.
Result<std::map<std::string, DatasetCase>> FindCases(
    const std::string& folder, const std::map<std::string, CaseResult>& rows) {
  std::map<std::string, DatasetCase> cases;
  Result<CaseReader> reader = CaseReader::Open(folder);
  if (!reader.ok()) return reader.error();
  while (cases.size() < rows.size()) {
    Result<std::optional<DatasetCase>> next = reader->Next();
    if (!next.ok()) return next.error();
    if (!next->has_value()) break;
    const std::string id = (*next)->case_id;
    if (rows.contains(id)) cases.emplace(id, **std::move(next));
  }
  for (const auto& [id, row] : rows) {
    if (cases.contains(id)) continue;
    return Error{ErrorCode::kInvalid, folder + ": has no case " + id};
  }
  return cases;
}

std::string Caption(const CaseResult& r) {
  std::array<char, 160> text{};
  const double gain = 100 * (r.baseline_cost - r.final_cost) / r.baseline_cost;
  std::snprintf(text.data(), text.size(),
                ": baseline %.1f, deployed %.1f (-%.2f %%), optimum %.1f",
                r.baseline_cost, r.final_cost, gain, r.oracle_cost);
  return r.case_id + text.data();
}

using FramePaths = std::map<std::string, std::string>;

Result<FramePaths> FindFrames(const std::string& folder) {
  FramePaths paths;
  if (folder.empty()) return paths;
  const auto frames = FindRugdFrames(folder);
  if (!frames.ok()) return frames.error();
  for (const RugdFrame& frame : frames->frames)
    paths.emplace(frame.name, frame.path);
  return paths;
}

Result<cv::Mat> ReadFrame(const std::string& path, cv::Size size) {
  const Result<std::string> bytes = ReadWholeFile(path, kMaxImageBytes);
  if (!bytes.ok()) return bytes.error();
  Result<Pixels> frame = DecodePng(*bytes, TerrainMap::kMaxSide, path);
  if (!frame.ok()) return frame.error();
  if (cv::Size(frame->width, frame->height) != size ||
      frame->order != PixelOrder::kRgb) {
    return Error{ErrorCode::kInvalid,
                 path + ": a frame must be 24-bit colour, of its map's size"};
  }
  cv::Mat image;
  cv::cvtColor(cv::Mat(size, CV_8UC3, frame->bytes.data()), image,
               cv::COLOR_RGB2BGR);
  return image;
}

void DrawRoutes(cv::Mat& image, const Route& baseline,
                const Route& final_route) {
  if (!baseline.empty()) DrawRoute(image, baseline, kBaselineColor);
  if (!final_route.empty() && final_route != baseline) {
    DrawRoute(image, final_route, kCandidateColor);
  }
  if (baseline.empty()) return;
  DrawEnd(image, baseline.front(), "S");
  DrawEnd(image, baseline.back(), "G");
}

cv::Mat DrawPanel(const TerrainMap& map, const Route& baseline,
                  const Route& final_route, int stride) {
  cv::Mat image = TerrainImage(map);
  DrawGrid(image, stride);
  DrawRoutes(image, baseline, final_route);
  return image;
}

// A page with many of them should be small.
std::string Encode(const cv::Mat& image) {
  return EncodePng({image.data, image.cols, image.rows, PixelOrder::kBgr},
                   PngEffort::kSmall);
}

// The baseline that the run had.
Route BaselineOf(const RunDescription& run, const TerrainMap& map,
                 const DatasetCase& c) {
  planner::LatticeOptions lattice;
  lattice.stride = run.stride;
  for (const auto rule :
       {planner::JointRule::kCell, planner::JointRule::kVisible}) {
    if (JointsName(rule) == run.joints) lattice.joints = rule;
  }
  return planner::PlanOnLattice(map, c.start, c.goal, lattice).waypoints;
}

Result<Panel> MakePanel(const RunDescription& run, const DatasetFolder& dataset,
                        const DatasetCase& c, const FramePaths& frames,
                        const CaseResult& result) {
  const CostModel model{run.corner_cutting, run.clearance_cells};
  const Result<TerrainMap> map = ReadCaseMap(dataset, c, model);
  if (!map.ok()) return map.error();
  const Route baseline = BaselineOf(run, *map, c);
  cv::Mat image = DrawPanel(*map, baseline, result.final_route, run.stride);
  const auto path = frames.find(result.case_id);
  if (path != frames.end()) {
    Result<cv::Mat> frame = ReadFrame(path->second, image.size());
    if (!frame.ok()) return frame.error();
    DrawRoutes(*frame, baseline, result.final_route);
    cv::vconcat(*frame, image.clone(), image);
  }
  return Panel{Caption(result), Encode(image)};
}

}  // namespace

std::string DrawPanelPng(const TerrainMap& map, const Route& baseline,
                         const Route& final_route, int stride) {
  return Encode(DrawPanel(map, baseline, final_route, stride));
}

Result<std::vector<Panel>> MakePanels(const std::string& run_folder,
                                      const DatasetFolder& dataset,
                                      int per_group,
                                      const std::string& frames) {
  const Result<FramePaths> paths = FindFrames(frames);
  if (!paths.ok()) return paths.error();
  const Result<RunDescription> run =
      ReadRunDescription((fs::path(run_folder) / "run.json").string());
  if (!run.ok()) return run.error();
  const auto rows =
      ChooseRows((fs::path(run_folder) / "results.csv").string(), per_group);
  if (!rows.ok()) return rows.error();
  const auto cases = FindCases(dataset.folder, *rows);
  if (!cases.ok()) return cases.error();
  std::vector<Panel> panels;
  for (const auto& [id, result] : *rows) {
    Result<Panel> panel =
        MakePanel(*run, dataset, cases->at(id), *paths, result);
    if (!panel.ok()) return panel.error();
    panels.push_back(*std::move(panel));
  }
  return panels;
}

}  // namespace terra::benchmark
