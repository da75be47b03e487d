#include "bus/decimal_options.h"

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace terra::bus {
namespace {

template <typename T>
bool IsDecimal(std::string_view text) {
  T value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

bool HasLeadingZero(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return text.size() > 1 && text.starts_with('0');
}

CLI::Validator WholeNumber(bool has_sign) {
  CLI::Validator validator(
      [has_sign](const std::string& text) -> std::string {
        const bool decimal = has_sign ? IsDecimal<std::int64_t>(text)
                                      : IsDecimal<std::uint64_t>(text);
        if (decimal && !HasLeadingZero(text)) return {};
        return text + " is not a whole number in decimal form, as 50";
      },
      "");
  return validator;
}

// The kinds of value that stand for whole numbers in the help texts.
bool IsWholeNumber(std::string_view type) {
  const std::string_view name = type.substr(0, type.find(':'));
  return name == "INT" || name == "UINT" || name == "N" || name == "K" ||
         name == "R,...";
}

}  // namespace

void TakeDecimalNumbersOnly(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (!IsWholeNumber(type)) continue;
    option->check(WholeNumber(!type.starts_with("UINT")));
  }
  for (CLI::App* command : app.get_subcommands({})) {
    TakeDecimalNumbersOnly(*command);
  }
}

}  // namespace terra::bus
