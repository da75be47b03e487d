#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "terrain/cell.h"
#include "terrain/result.h"

namespace terra::cli {

/// Exit codes of every command.
inline constexpr int kDone = 0;
inline constexpr int kCouldNot = 1;
inline constexpr int kWrongUsage = 2;

/// Says on stderr why a command could not do its work; returns the exit code.
int Fail(const Error& error, int exit_code = kCouldNot);

/// A cost for JSON: null instead of infinity, which JSON does not have.
nlohmann::json JsonCost(double cost);

/// How much of the baseline's cost a route saves, in percent; 0 where there is
/// nothing to compare with (a baseline of cost 0, or none).
double SavingPercent(double baseline_cost, double cost);

/// As printf; at most 511 characters.
[[gnu::format(printf, 1, 2)]] std::string Printed(const char* format, ...);

/// A text of a stranger's, cut to a length and without control characters,
/// which must not reach a terminal; what is not ASCII becomes '?'.
std::string Printable(std::string text, std::size_t longest);

/// Waypoints for JSON: [[x, y], ...].
nlohmann::json JsonRoute(const Route& route);

}  // namespace terra::cli
