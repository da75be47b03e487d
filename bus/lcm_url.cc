#include "bus/lcm_url.h"

#include <charconv>
#include <cstdlib>

#include <arpa/inet.h>

namespace terra::bus {
namespace {

constexpr char kLcmGroup[] = "239.255.76.67";
constexpr int kLcmPort = 7667;

Error BadUrl(const std::string& text, const std::string& why) {
  return Error{ErrorCode::kInvalid, "LCM URL \"" + text + "\": " + why +
                                        "; expected udpm://GROUP:PORT?ttl=0"};
}

bool IsMulticast(const std::string& address) {
  in_addr parsed{};
  return inet_pton(AF_INET, address.c_str(), &parsed) == 1 &&
         IN_MULTICAST(ntohl(parsed.s_addr));
}

}  // namespace

Result<LcmUrl> ParseLcmUrl(const std::string& text) {
  const std::size_t scheme = text.find("://");
  if (scheme == std::string::npos || scheme == 0) {
    return BadUrl(text, "no provider before \"://\"");
  }
  LcmUrl url;
  url.provider = text.substr(0, scheme);
  std::string network = text.substr(scheme + 3);
  if (const std::size_t query = network.find('?'); query != std::string::npos) {
    url.options = network.substr(query + 1);
    network.resize(query);
  }
  if (!url.is_udpm()) return url;
  const std::size_t colon = network.find(':');
  url.group = network.substr(0, colon);
  if (url.group.empty()) url.group = kLcmGroup;
  if (!IsMulticast(url.group)) {
    return BadUrl(text, url.group + " is no IPv4 multicast address");
  }
  url.port = kLcmPort;
  if (colon != std::string::npos) {
    const char* first = network.data() + colon + 1;
    const char* last = network.data() + network.size();
    const auto [end, error] = std::from_chars(first, last, url.port);
    if (error != std::errc() || end != last || url.port < 1 ||
        url.port > 65535) {
      return BadUrl(text, "the port must be 1 to 65535");
    }
  }
  return url;
}

std::string EffectiveLcmUrl(const std::string& given) {
  if (!given.empty()) return given;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  if (from_environment != nullptr && *from_environment != '\0') {
    return from_environment;
  }
  return kDefaultLcmUrl;
}

Result<std::string> AdviceUrlFor(const std::string& deployed_url) {
  const Result<LcmUrl> url = ParseLcmUrl(deployed_url);
  if (!url) return url.error();
  if (!url->is_udpm()) return deployed_url;
  if (url->port == 65535) {
    return BadUrl(deployed_url,
                  "the advice bus needs the next port; give --advice-url");
  }
  return url->provider + "://" + url->group + ":" +
         std::to_string(url->port + 1) +
         (url->options.empty() ? "" : "?" + url->options);
}

}  // namespace terra::bus
