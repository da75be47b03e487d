#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/backend.h"

namespace terra::advisor {

/// Returns the deterministic backend of that name ("search", "shortcut"), or
/// null. It proposes a strictly cheaper route or
/// says that it retains.
std::unique_ptr<Backend> MakeRefinerBackend(std::string_view name);

/// The names that MakeRefinerBackend knows.
std::vector<std::string> RefinerBackendNames();

}  // namespace terra::advisor
