#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"

namespace terra::benchmark {

/// report.html as it grows: one page with its style, pictures and plots inside,
/// without script or link to anywhere.
class ReportPage {
 public:
  /// The head: what was run, on what, and what these figures are not.
  void Intro(const std::vector<LoadedRun>& runs);
  void Section(const std::string& title, const std::string& text);
  /// Adds ready HTML.
  void Html(const std::string& html) { body_ += html; }
  void Figure(const std::string& svg, const std::string& caption);
  void BeginPanels(const std::string& title);
  void AddPanel(const std::string& caption, const std::string& png_base64);
  void EndPanels();

  /// Returns the whole page.
  std::string Finish() const;

 private:
  std::string intro_;
  std::string contents_;
  std::string body_;
  int sections_ = 0;
};

}  // namespace terra::benchmark
