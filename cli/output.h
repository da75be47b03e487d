#pragma once

#include <nlohmann/json_fwd.hpp>

#include "terrain/cell.h"
#include "terrain/result.h"

namespace terra::cli {

/// Exit codes of every command; wrong usage (2) is main's business.
inline constexpr int kDone = 0;
inline constexpr int kCouldNot = 1;

/// Says on stderr why a command could not do its work; returns kCouldNot.
int Fail(const Error& error);

/// A cost for JSON: null instead of infinity, which JSON does not have.
nlohmann::json JsonCost(double cost);

/// Waypoints for JSON: [[x, y], ...].
nlohmann::json JsonRoute(const Route& route);

}  // namespace terra::cli
