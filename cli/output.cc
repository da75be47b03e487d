#include "cli/output.h"

#include <iostream>

#include <nlohmann/json.hpp>

#include "terrain/legend.h"

namespace terra::cli {
int Fail(const Error& error) {
  std::cerr << "terra: " << error.message << "\n";
  return kCouldNot;
}

nlohmann::json JsonCost(double cost) {
  return cost == kImpassable ? nlohmann::json(nullptr) : nlohmann::json(cost);
}

nlohmann::json JsonRoute(const Route& route) {
  nlohmann::json points = nlohmann::json::array();
  for (const Cell cell : route) points.push_back({cell.x, cell.y});
  return points;
}

}  // namespace terra::cli
