#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace terra::bus {

/// Accepts a number in [low, high], ends included. (CLI::Range lets "nan" pass,
/// which is neither below nor above anything.)
inline CLI::Validator InRange(double low, double high) {
  CLI::Validator validator(
      [low, high](std::string& text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= low &&
            value <= high) {
          return {};
        }
        return text + " is not a number from " + CLI::detail::to_string(low) +
               " to " + CLI::detail::to_string(high);
      },
      "", "number");
  validator.description("in [" + CLI::detail::to_string(low) + " - " +
                        CLI::detail::to_string(high) + "]");
  return validator;
}

}  // namespace terra::bus
