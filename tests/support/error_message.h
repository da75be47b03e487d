#pragma once

#include <string>

#include "terrain/result.h"

namespace terra::testing {

/// Returns the message of an error; "" when there is a value.
template <typename T>
std::string ErrorMessage(const Result<T>& result) {
  return result.ok() ? "" : result.error().message;
}

}  // namespace terra::testing
