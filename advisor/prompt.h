#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// What the model is asked for.
enum class Method {
  kAdvisor,   ///< The paper's: keep the baseline, or propose another route.
  kDirect,    ///< A whole route, without any baseline shown.
  kLlmAstar,  ///< Intermediate targets, without any baseline shown.
};

/// "advisor", "direct", "llm-astar".
std::string_view MethodName(Method method);
std::optional<Method> FindMethod(std::string_view name);

/// What goes into the question. The defaults are the paper's.
struct PromptSwitches {
  bool overlay = true;     ///< The picture with the baseline (advisor).
  bool route_text = true;  ///< Its sampled points and total cost (advisor).
  bool rea = true;         ///< The reference pair (advisor).
  bool axes = false;       ///< Pictures at 2x with ticks and grid lines.
  bool regions = false;    ///< The terrain description as a table.
  bool stretches = false;  ///< The baseline's cost by stretch of terrain.
  int candidates = 1;      ///< Routes asked for, best first; 1 to 8.
};

/// How a picture's pixels relate to the map's cells.
struct PictureFrame {
  int pixels_per_cell = 1;  ///< Enlarged, or 1.
  int cells_per_pixel = 1;  ///< Reduced, or 1; never both above 1.
  int left_px = 0;          ///< Margin left of cell 0.
  int top_px = 0;           ///< Margin above cell 0.
  int grid_cells = 0;       ///< Distance of ticks and grid lines; 0 = none.
};

/// Costs of the reference pair shown.
struct ReferenceCosts {
  double left = 0;   ///< The cheaper, longer route.
  double right = 0;  ///< The dearer, shorter one.
};

/// All that the text is written from.
struct PromptInput {
  Method method = Method::kAdvisor;
  PromptSwitches switches;
  const TerrainMap& shown;  ///< The map as the model sees it (noise included).
  Cell start;
  Cell goal;
  /// The baseline and its costs come from the clean map, which may differ.
  const TerrainMap& clean;
  const Route& baseline;
  double baseline_cost = 0;
  PictureFrame frame;
  std::optional<ReferenceCosts> reference;  ///< None = no pair is shown.
};

/// Writes the question's text. Deterministic; no part that a switch turns off
/// leaves a trace in it.
/// Source: paper, LLM-Advisor, for what it conveys; the wording is our own.
std::string WritePrompt(const PromptInput& input);

/// Identifies the wording: changes when any sentence of any form changes.
const std::string& PromptId();

}  // namespace terra::advisor
