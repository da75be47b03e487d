#include "benchmark/run_fields.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <nlohmann/json.hpp>

#include "advisor/prompt.h"
#include "advisor/reference_pool.h"
#include "terrain/files/csv.h"

namespace terra::benchmark {
namespace {

using nlohmann::json;

constexpr std::string_view kConfiguration = "/configuration";
constexpr std::string_view kSettings = "/configuration/settings/";
constexpr std::string_view kModelSettings =
    "/configuration/settings/model_settings/";
constexpr std::string_view kMethodField = "/configuration/method";
constexpr std::string_view kRoundsField = "/configuration/settings/rounds";
constexpr std::string_view kSeedField = "/configuration/settings/seed";
constexpr std::string_view kPromptField = "/configuration/settings/prompt_id";
constexpr std::string_view kPoolField =
    "/configuration/settings/reference_pool";
constexpr std::string_view kStretchesField =
    "/configuration/settings/stretches";
constexpr std::string_view kRoundsDeadlineField =
    "/configuration/settings/rounds_deadline_s";

using enum FieldRole;

constexpr RunField kFields[] = {
    {"/configuration/method", kMethod, "", ""},
    {"/configuration/backend", kMethod, "", ""},
    {"/configuration/title", kName, "", ""},
    {"/configuration/fallback", kMethod, "", ""},
    {"/configuration/every_case_attempts", kMethod, "", ""},
    {"/configuration/asks_model", kMethod, "", ""},
    {"/configuration/simulated", kMethod, "", ""},
    {"/configuration/dataset/name", kName, "", ""},
    {"/configuration/dataset/version", kName, "", ""},
    {"/configuration/dataset/digest", kCases, "", ""},
    {"/configuration/case_list_digest", kCases, "", ""},
    {"/configuration/cases", kName, "", ""},  // The list's length.
    {kStrideField, kCases, "50", "stride {}"},
    {kJointsField, kCases, "\"2r\"", "joints {}"},
    {"/configuration/cost_model/corner_cutting", kCases, "true",
     "no corner cutting"},
    {"/configuration/cost_model/clearance_cells", kCases, "0",
     "clearance {} cells"},
    {"/configuration/repeats", kVersion, "1", "asked {} times"},
    {"/configuration/settings/provider", kMethod, "", ""},
    {"/configuration/settings/endpoint_class", kMethod, "\"provider\"",
     "endpoint {}"},
    {"/configuration/settings/model", kMethod, "", ""},
    {"/configuration/settings/model_settings/effort", kBeyond, "\"low\"",
     "effort {}"},
    {"/configuration/settings/model_settings/max_output_tokens", kBeyond,
     "8000", "at most {} output tokens"},
    {"/configuration/settings/model_settings/image_detail", kBeyond,
     "\"original\"", "image detail {}"},
    // The paper prints neither its wording nor its pool. Empty = those of this
    // program (OfThisProgram).
    {kPromptField, kVersion, "\"\"", "prompt {}"},
    {kOverlayField, kAblation, "true", "no overlay"},
    {kRouteTextField, kAblation, "true", "no route text"},
    {kReaField, kAblation, "true", "no REA"},
    {kPoolField, kVersion, "\"\"", "reference pool {}"},
    {"/configuration/settings/axes", kBeyond, "false", "picture with axes"},
    {"/configuration/settings/regions", kBeyond, "false", "regions"},
    {kStretchesField, kBeyond, "false", "stretches"},
    {"/configuration/settings/candidates", kBeyond, "1", "{} candidates"},
    {kRoundsField, kBeyond, "1", "{} rounds"},
    {kRoundsDeadlineField, kBeyond, "900", "rounds within {} s"},
    {kNoiseField, kNoise, "0", "noise {} %"},
    {kSeedField, kVersion, "0", "seed {}"},
    {"/configuration/settings/polish", kBeyond, "false", "polished"},
    {"/schema", kOrigin, "", ""},
    {"/shard/index", kOrigin, "", ""},
    {"/shard/count", kOrigin, "", ""},
    {"/jobs", kOrigin, "", ""},
    {"/build/id", kOrigin, "", ""},
    {"/build/dirty", kOrigin, "", ""},
    {"/command_line", kOrigin, "", ""},
    {"/machine", kOrigin, "", ""},
    {"/started/*", kOrigin, "", ""},
    {"/finished", kOrigin, "", ""},
    // Which model answered and when a recording was made stand in titles by
    // themselves.
    {"/models/*", kOrigin, "", ""},
    {"/recorded/first", kOrigin, "", ""},
    {"/recorded/last", kOrigin, "", ""},
};

bool IsIndex(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
}

bool IsPathOf(std::string_view path, const RunField& field) {
  if (!field.path.ends_with('*')) return path == field.path;
  const std::string_view array = field.path.substr(0, field.path.size() - 1);
  return path.starts_with(array) && IsIndex(path.substr(array.size()));
}

// One text for one value: 5 and 5.0 are the same percentage.
std::string TextOf(const json& value) {
  return value.is_number_float()
             ? FormatNumber(value.get<double>())
             : value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string Quoted(const std::string& text) {
  return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

bool Decides(FieldRole role) {
  return role != kOrigin && role != kName;
}

FieldRole RoleOf(std::string_view path) {
  const RunField* field = FindField(path);
  return field == nullptr ? kBeyond : field->role;
}

// Is it the wording or the pool that comes with this program?
bool OfThisProgram(std::string_view path, const json& value) {
  if (!value.is_string()) return false;
  const auto& id = value.get_ref<const std::string&>();
  return (path == kPromptField && id == advisor::PromptId()) ||
         (path == kPoolField && !id.empty() &&
          id == advisor::ReferencePool::Builtin().id());
}

// The leaves of the configuration, without its empty objects.
FieldValues WrittenValues(const RunDescription& description) {
  FieldValues values;
  const json flat = json(ConfigurationJson(description)).flatten();
  for (const auto& [key, value] : flat.items()) {
    if (value.is_null()) continue;
    const std::string path = std::string(kConfiguration) + key;
    values.emplace(path,
                   OfThisProgram(path, value) ? Quoted("") : TextOf(value));
  }
  return values;
}

void SetToPaper(FieldValues& values, std::string_view path) {
  values.insert_or_assign(std::string(path),
                          std::string(FindField(path)->paper));
}

bool Is(const FieldValues& values, std::string_view path,
        std::string_view text) {
  const auto found = values.find(path);
  return found != values.end() && found->second == text;
}

// What changes nothing beside the other values counts as the paper's.
void DropWithoutEffect(FieldValues& values) {
  const bool advisor = Is(values, kMethodField, "\"advisor\"");
  if (!advisor) {
    // Without a baseline in the question.
    for (const std::string_view path :
         {kOverlayField, kRouteTextField, kReaField, kStretchesField,
          kPoolField}) {
      SetToPaper(values, path);
    }
  }
  if (Is(values, kRouteTextField, "false")) SetToPaper(values, kStretchesField);
  const bool reference = advisor && Is(values, kReaField, "true");
  if (!reference) SetToPaper(values, kPoolField);
  if (!reference && Is(values, kNoiseField, "0")) {
    SetToPaper(values, kSeedField);
  }
  if (Is(values, kRoundsField, "1")) SetToPaper(values, kRoundsDeadlineField);
}

bool IsPaperValue(std::string_view path, const std::string& text) {
  const RunField* field = FindField(path);
  return field != nullptr && text == field->paper;
}

// As a title has it: strings without quotes.
std::string ForPeople(const std::string& text) {
  const json value = json::parse(text, nullptr, false);
  if (!value.is_string()) return text;
  const auto content = value.get<std::string>();
  return content.empty() ? "not sent" : content;
}

std::string Filled(std::string_view words, const std::string& value) {
  std::string text(words);
  const std::size_t at = text.find("{}");
  if (at != std::string::npos) text.replace(at, 2, value);
  return text;
}

// Of a field that this program does not know.
std::string UnknownWords(std::string_view path, const std::string& text) {
  for (const std::string_view prefix : {kModelSettings, kSettings}) {
    if (path.starts_with(prefix)) {
      path.remove_prefix(prefix.size());
      break;
    }
  }
  return std::string(path) + " " + ForPeople(text);
}

}  // namespace

std::span<const RunField> RunFields() {
  return kFields;
}

const RunField* FindField(std::string_view path) {
  const auto found = std::find_if(std::begin(kFields), std::end(kFields),
                                  [path](const RunField& field) {
                                    return IsPathOf(path, field);
                                  });
  return found == std::end(kFields) ? nullptr : &*found;
}

FieldValues DecidingValues(const RunDescription& description) {
  FieldValues values = WrittenValues(description);
  std::erase_if(values, [](const auto& value) {
    return !Decides(RoleOf(value.first));
  });
  for (const RunField& field : kFields) {
    if (!Decides(field.role)) continue;
    values.try_emplace(std::string(field.path), std::string(field.paper));
  }
  DropWithoutEffect(values);
  return values;
}

bool IsAtPaper(const RunDescription& description, FieldRole role) {
  const FieldValues values = DecidingValues(description);
  return std::all_of(values.begin(), values.end(), [&](const auto& value) {
    return RoleOf(value.first) != role ||
           IsPaperValue(value.first, value.second);
  });
}

std::vector<std::string> WordsOf(const RunDescription& description,
                                 const std::set<std::string_view>& shown) {
  const FieldValues values = DecidingValues(description);
  std::vector<std::string> words;
  for (const RunField& field : kFields) {
    const auto value = values.find(field.path);
    if (value == values.end() || field.words.empty() ||
        shown.contains(field.path) || IsPaperValue(field.path, value->second)) {
      continue;
    }
    words.push_back(Filled(field.words, ForPeople(value->second)));
  }
  for (const auto& [path, text] : values) {
    if (FindField(path) == nullptr) words.push_back(UnknownWords(path, text));
  }
  return words;
}

}  // namespace terra::benchmark
