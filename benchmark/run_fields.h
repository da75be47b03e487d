#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "benchmark/run_description.h"

namespace terra::benchmark {

/// What a field of run.json means for a row of a table.
enum class FieldRole {
  kOrigin,    ///< How the run came about. No figure depends on it.
  kName,      ///< A name for people of what another field identifies.
  kCases,     ///< What is solved. Rows of one table have it alike.
  kMethod,    ///< Who plans, and how it is counted.
  kVersion,   ///< Wording, reference pool, seed, repeats of a question.
  kAblation,  ///< What the paper's ablation turns off.
  kNoise,     ///< How much of the shown map is wrong.
  kBeyond,    ///< A setting that the paper has at this one value.
};

/// A field of run.json.
struct RunField {
  /// JSON pointer from the root of run.json; `*` stands for any index.
  std::string_view path;
  FieldRole role;
  /// The paper's value as JSON text, which also holds where the field is
  /// missing. Empty = the paper has none.
  std::string_view paper;
  /// What a row's title says of any other value, which replaces `{}`. Empty =
  /// nothing: the beginning of the title says it, or no table has rows that
  /// differ in it.
  std::string_view words;
};

/// All fields of run.json. A field that is missing here counts as kBeyond and
/// stands in titles by its name; a test fails then.
std::span<const RunField> RunFields();

/// The field that a path of run.json belongs to; null where none does.
const RunField* FindField(std::string_view path);

/// JSON texts by path.
using FieldValues = std::map<std::string, std::string, std::less<>>;

/// The values that decide a run's figures (all but kOrigin and kName). A field
/// that is missing, or has no effect beside the others (the reference pool
/// without a reference pair), has the paper's value.
FieldValues DecidingValues(const RunDescription& description);

/// Has every field of this role the paper's value?
bool IsAtPaper(const RunDescription& description, FieldRole role);

/// What a title says of the values that are not the paper's, in order of the
/// fields. Leaves out the paths in `shown`.
std::vector<std::string> WordsOf(const RunDescription& description,
                                 const std::set<std::string_view>& shown = {});

/// Paths that code asks for by name.
inline constexpr std::string_view kStrideField = "/configuration/stride";
inline constexpr std::string_view kJointsField = "/configuration/joints";
inline constexpr std::string_view kNoiseField = "/configuration/settings/noise";
inline constexpr std::string_view kOverlayField =
    "/configuration/settings/overlay";
inline constexpr std::string_view kRouteTextField =
    "/configuration/settings/route_text";
inline constexpr std::string_view kReaField = "/configuration/settings/rea";

}  // namespace terra::benchmark
