#pragma once

#include <string>

namespace terra::advisor {

/// Where a request goes, of a base address as people write it and the path of
/// the form ("/v1/messages"). The base may end with slashes, with a version, or
/// with the whole path; where it holds a version of its own, as in
/// "https://host/api/v4", that one counts.
std::string EndpointUrl(std::string base, const std::string& path);

}  // namespace terra::advisor
