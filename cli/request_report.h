#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli/request_node.h"

namespace terra::cli {

/// Why no route is deployed, in a sentence.
std::string WhyNoRoute(const RequestNode& node);

/// What `terra request` tells, as JSON; null for what never came.
nlohmann::json RequestJson(const RequestNode& node);

/// The same for people, on stdout. Needs a route.
void PrintRequest(const RequestNode& node);

}  // namespace terra::cli
