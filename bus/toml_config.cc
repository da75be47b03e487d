#include "bus/toml_config.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <istream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

// toml++ 3.3 asserts, or assumes, some of what its input decides (what follows
// the "[" of a section), and handles it all the same a few lines on.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expression) static_cast<void>(0)
#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace terra::bus {
namespace {

constexpr std::size_t kMaxConfigBytes = std::size_t{64} * 1024;
// toml++ makes a table within a table of each part of a dotted key, and frees
// them by recursion.
constexpr int kMaxDotsInLine = 32;

[[noreturn]] void Refuse(const toml::source_position& at,
                         const std::string& why) {
  throw CLI::ConfigError("line " + std::to_string(at.line) + ": " + why);
}

std::string ReadBounded(std::istream& input) {
  std::string text(kMaxConfigBytes + 1, '\0');
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(input.gcount()));
  if (text.size() > kMaxConfigBytes) {
    throw CLI::ConfigError("a configuration is no larger than 64 kB");
  }
  return text;
}

void CheckDots(const std::string& text) {
  std::istringstream lines(text);
  toml::source_position at{1, 1};
  for (std::string line; std::getline(lines, line); ++at.line) {
    const auto key_end = std::find(line.begin(), line.end(), '=');
    if (std::count(line.begin(), key_end, '.') > kMaxDotsInLine) {
      Refuse(at, "no option has so many dots in its name");
    }
  }
}

std::string Text(const toml::node& value) {
  if (const auto* text = value.as_string()) return text->get();
  if (const auto* number = value.as_integer()) {
    return std::to_string(number->get());
  }
  if (const auto* truth = value.as_boolean()) {
    return truth->get() ? "true" : "false";
  }
  if (const auto* number = value.as_floating_point()) {
    std::array<char, 32> digits{};
    char* const end = digits.data() + digits.size();
    return {digits.data(),
            std::to_chars(digits.data(), end, number->get()).ptr};
  }
  Refuse(value.source().begin,
         "expected a string, a number, true, false or a list of these");
}

std::vector<std::string> Inputs(const toml::node& value) {
  const toml::array* list = value.as_array();
  if (list == nullptr) return {Text(value)};
  std::vector<std::string> inputs;
  for (const toml::node& each : *list) inputs.push_back(Text(each));
  return inputs;
}

// CLI11 writes a string between double quotes as it is.
std::string EscapeBackslashes(const std::string& config) {
  std::string escaped;
  char quote = '\0';
  for (const char c : config) {
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote || c == '\n') {
      quote = '\0';
    }
    escaped += c;
    if (c == '\\' && quote == '"') escaped += c;
  }
  return escaped;
}

class TomlConfig : public CLI::ConfigTOML {
 public:
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    const std::string text = ReadBounded(input);
    CheckDots(text);
    const toml::parse_result parsed = toml::parse(text);
    if (!parsed) {
      Refuse(parsed.error().source().begin,
             "this is no TOML: " + std::string(parsed.error().description()));
    }
    std::vector<CLI::ConfigItem> read;
    for (const auto& [key, value] : parsed.table()) {
      if (value.is_table()) {
        Refuse(value.source().begin, "options stand in no section");
      }
      CLI::ConfigItem item;
      item.name = std::string(key.str());
      item.inputs = Inputs(value);
      read.push_back(std::move(item));
    }
    return read;
  }

  std::string to_config(const CLI::App* app, bool default_also,
                        bool write_description,
                        std::string prefix) const override {
    return EscapeBackslashes(CLI::ConfigTOML::to_config(
        app, default_also, write_description, std::move(prefix)));
  }
};

}  // namespace

void ReadConfigAsToml(CLI::App& app) {
  app.config_formatter(std::make_shared<TomlConfig>());
}

}  // namespace terra::bus
