#pragma once

#include <string>
#include <string_view>

namespace terra::benchmark {

/// SHA-256 in 64 hexadecimal digits, as sha256sum prints it.
std::string Sha256Hex(std::string_view bytes);

}  // namespace terra::benchmark
