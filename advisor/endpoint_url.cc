#include "advisor/endpoint_url.h"

#include <cctype>
#include <string_view>

namespace terra::advisor {
namespace {

/// "v1", "v1beta", "v4": what APIs put into their paths.
bool IsVersion(std::string_view segment) {
  return segment.size() >= 2 && segment[0] == 'v' &&
         std::isdigit(static_cast<unsigned char>(segment[1])) != 0;
}

bool HoldsVersion(std::string_view path) {
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    if (IsVersion(path.substr(0, slash))) return true;
    path.remove_prefix(slash == std::string_view::npos ? path.size()
                                                       : slash + 1);
  }
  return false;
}

bool RemoveEnd(std::string& text, std::string_view end) {
  if (!text.ends_with(end)) return false;
  text.resize(text.size() - end.size());
  return true;
}

}  // namespace

std::string EndpointUrl(std::string base, const std::string& path) {
  while (base.ends_with('/')) base.pop_back();
  const std::size_t host = base.find("://");
  if (host == std::string::npos ||
      base.find('/', host + 3) == std::string::npos) {
    return base + path;
  }
  if (RemoveEnd(base, path) || RemoveEnd(base, "/v1beta") ||
      RemoveEnd(base, "/v1")) {
    return base + path;
  }
  const std::size_t own = base.find('/', host + 3);
  const bool has_version = HoldsVersion(std::string_view(base).substr(own + 1));
  return base + (has_version ? path.substr(path.find('/', 1)) : path);
}

}  // namespace terra::advisor
