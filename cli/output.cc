#include "cli/output.h"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <iostream>

#include <nlohmann/json.hpp>

#include "terrain/legend.h"

namespace terra::cli {

int Fail(const Error& error, int exit_code) {
  std::cerr << "terra: " << error.message << "\n";
  return exit_code;
}

nlohmann::json JsonCost(double cost) {
  return cost == kImpassable ? nlohmann::json(nullptr) : nlohmann::json(cost);
}

double SavingPercent(double baseline_cost, double cost) {
  return baseline_cost > 0 && std::isfinite(baseline_cost)
             ? 100 * (baseline_cost - cost) / baseline_cost
             : 0;
}

nlohmann::json JsonRoute(const Route& route) {
  nlohmann::json points = nlohmann::json::array();
  for (const Cell cell : route) points.push_back({cell.x, cell.y});
  return points;
}

std::string Printed(const char* format, ...) {
  std::array<char, 512> text{};
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(text.data(), text.size(), format, values);
  va_end(values);
  return text.data();
}

std::string Printable(std::string text, std::size_t longest) {
  if (text.size() > longest) text.resize(longest);
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text;
}

}  // namespace terra::cli
