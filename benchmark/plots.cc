#include "benchmark/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "base/html.h"
#include "benchmark/paper_rows.h"
#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

std::string Number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

// A drawing that grows.
class Svg {
 public:
  Svg(int width, int height, const std::string& label) {
    text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
            std::to_string(width) + " " + std::to_string(height) +
            "\" role=\"img\" aria-label=\"" + EscapeHtml(label) +
            "\" font-family=\"system-ui, sans-serif\" font-size=\"12\">\n";
  }

  void Line(double x1, double y1, double x2, double y2,
            const std::string& style) {
    text_ += "<line x1=\"" + Number(x1) + "\" y1=\"" + Number(y1) + "\" x2=\"" +
             Number(x2) + "\" y2=\"" + Number(y2) + "\" style=\"" + style +
             "\"/>\n";
  }
  void Dot(double x, double y, const std::string& style) {
    text_ += "<circle cx=\"" + Number(x) + "\" cy=\"" + Number(y) +
             "\" r=\"4.5\" style=\"" + style + "\"/>\n";
  }
  void Path(const std::vector<std::pair<double, double>>& points,
            const std::string& style) {
    text_ += "<polyline points=\"";
    for (const auto& [x, y] : points) {
      text_ += Number(x) + "," + Number(y) + " ";
    }
    text_ += "\" style=\"fill:none;" + style + "\"/>\n";
  }
  void Text(double x, double y, const std::string& anchor,
            const std::string& content) {
    text_ += "<text x=\"" + Number(x) + "\" y=\"" + Number(y) +
             "\" text-anchor=\"" + anchor +
             "\" style=\"fill:var(--ink,#222)\">" + EscapeHtml(content) +
             "</text>\n";
  }

  std::string Finish() { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

const std::string kGrid = "stroke:var(--grid,#ddd);stroke-width:1";

struct DotRow {
  std::vector<std::string> label;  // In lines.
  Estimate estimate;
  bool control = false;
};

// A title in lines that fit beside the plot, parted at spaces.
std::vector<std::string> TitleLines(const std::string& title) {
  constexpr std::size_t kLongest = 56;
  std::vector<std::string> lines(1);
  std::istringstream words(title);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    if (!line.empty() && line.size() + 1 + word.size() > kLongest) {
      lines.push_back(word);
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
  }
  return lines;
}

std::string DotPlot(const std::vector<DotRow>& rows, const std::string& label) {
  constexpr double kLeft = 370;
  constexpr double kWidth = 420;
  constexpr double kLine = 15;
  constexpr double kGap = 11;  // Between rows.
  constexpr double kTop = 26;
  double bottom = kTop;
  for (const DotRow& row : rows) {
    bottom += kGap + kLine * static_cast<double>(row.label.size());
  }
  Svg svg(840, static_cast<int>(bottom) + 30, label);
  for (int percent = 0; percent <= 100; percent += 20) {
    const double x = kLeft + kWidth * percent / 100;
    svg.Line(x, kTop - 8, x, bottom, kGrid);
    svg.Text(x, bottom + 18, "middle", std::to_string(percent) + " %");
  }
  double top = kTop + 8;  // Of the row: its first line.
  for (const DotRow& row : rows) {
    const auto x = [&](double share) {
      return kLeft + kWidth * std::clamp(share, 0.0, 1.0);
    };
    const double height = kLine * static_cast<double>(row.label.size());
    const double y = top + (height - kLine) / 2;
    const std::string color =
        row.control ? "var(--muted,#8a8f98)" : "var(--accent,#1f4fe0)";
    for (std::size_t i = 0; i < row.label.size(); ++i) {
      svg.Text(kLeft - 12, top + 4 + kLine * static_cast<double>(i), "end",
               row.label[i]);
    }
    svg.Line(x(row.estimate.low), y, x(row.estimate.high), y,
             "stroke:" + color + ";stroke-width:3;stroke-linecap:round");
    svg.Dot(x(row.estimate.value), y, "fill:" + color);
    svg.Text(kLeft + kWidth + 10, y + 4, "start",
             Number(100 * row.estimate.value));
    top += kGap + height;
  }
  return svg.Finish();
}

using Pick = std::optional<Estimate> Metrics::*;

std::string MetricPlot(const std::vector<LoadedRun>& runs,
                       const std::string& group, Pick pick,
                       const std::string& label) {
  std::vector<DotRow> rows;
  for (const LoadedRun& run : runs) {
    const Metrics& m = MetricsOf(run, group);
    if (m.paths == 0 || !(m.*pick)) continue;
    const bool control = run.description.method != "advisor" &&
                         run.description.method != "direct" &&
                         run.description.method != "llm-astar";
    rows.push_back({TitleLines(RowTitle(run)), *(m.*pick), control});
  }
  return rows.empty() ? "" : DotPlot(rows, label);
}

}  // namespace

std::string FirPlot(const std::vector<LoadedRun>& runs,
                    const std::string& group) {
  return MetricPlot(runs, group, &Metrics::fir,
                    "Final improvement rate, " + group + " subset");
}

std::string MogrPlot(const std::vector<LoadedRun>& runs,
                     const std::string& group) {
  return MetricPlot(runs, group, &Metrics::mogr,
                    "Mean oracle-gap recovery, " + group + " subset");
}

std::string GapPlot(const std::vector<LoadedRun>& runs) {
  constexpr double kLeft = 60;
  constexpr double kWidth = 640;
  constexpr double kTop = 20;
  constexpr double kHeight = 260;
  constexpr double kMaxGap = 25;  // Percent.
  // Strides on a log axis from 10 to 100.
  const auto x = [&](double stride) {
    return kLeft + kWidth * std::log10(stride / 10);
  };
  const auto y = [&](double percent) {
    return kTop + kHeight * (1 - std::min(percent, kMaxGap) / kMaxGap);
  };
  Svg svg(760, 340, "Mean gap by stride, here and in the paper");
  for (int percent = 0; percent <= 25; percent += 5) {
    svg.Line(kLeft, y(percent), kLeft + kWidth, y(percent), kGrid);
    svg.Text(kLeft - 8, y(percent) + 4, "end", std::to_string(percent) + " %");
  }
  for (const int stride : {10, 20, 50, 100}) {
    svg.Text(x(stride), kTop + kHeight + 20, "middle", std::to_string(stride));
  }
  svg.Text(kLeft + kWidth / 2, kTop + kHeight + 42, "middle",
           "stride in cells; lines: measured here, rings: paper");
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    const bool easy = subset == Subset::kEasy;
    const std::string color =
        easy ? "var(--accent,#1f4fe0)" : "var(--accent2,#c2410c)";
    const std::string group(SubsetName(subset));
    std::map<int, double> gaps;
    for (const LoadedRun& run : runs) {
      const Metrics& m = MetricsOf(run, group);
      if (m.mean_gap) gaps[run.description.stride] = 100 * m.mean_gap->value;
    }
    std::vector<std::pair<double, double>> points;
    for (const auto& [stride, gap] : gaps) {
      if (stride < 10 || stride > 100) continue;
      points.emplace_back(x(stride), y(gap));
    }
    svg.Path(points, "stroke:" + color + ";stroke-width:2.5");
    for (const auto& [px, py] : points) svg.Dot(px, py, "fill:" + color);
    for (const int stride : {10, 20, 50, 100}) {
      svg.Dot(x(stride), y(PaperGapOf(subset, stride).mean_gap),
              "fill:none;stroke:" + color + ";stroke-width:2");
    }
    svg.Dot(kLeft + 24, kTop + (easy ? 14 : 34), "fill:" + color);
    svg.Text(kLeft + 36, kTop + (easy ? 18 : 38), "start", group);
  }
  return svg.Finish();
}

}  // namespace terra::benchmark
