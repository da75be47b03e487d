#include "bus/lcm_url.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <arpa/inet.h>

namespace terra::bus {
namespace {

constexpr char kLcmGroup[] = "239.255.76.67";
constexpr int kLcmPort = 7667;
constexpr char kLcmHub[] = "127.0.0.1";
constexpr int kLcmHubPort = 7700;
constexpr int kMaxPort = 65'535;
constexpr int kMaxTtl = 255;
constexpr int kMaxRecvBuffer = 1 << 30;

Error BadUrl(const std::string& text, const std::string& why) {
  return Error{ErrorCode::kInvalid, "LCM URL \"" + text + "\": " + why +
                                        "; expected udpm://GROUP:PORT?ttl=0"};
}

// Digits alone. A zero before others is refused: LCM would read it as octal.
std::optional<int> Decimal(std::string_view text, int low, int high) {
  int value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last || value < low || value > high ||
      (text.size() > 1 && text.front() == '0')) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::uint32_t> MulticastGroup(const std::string& address) {
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1 ||
      !IN_MULTICAST(ntohl(parsed.s_addr))) {
    return std::nullopt;
  }
  return ntohl(parsed.s_addr);
}

// HOST:PORT, of which either may be left out. Returns whether the port is good.
bool ReadHostAndPort(std::string_view network, LcmUrl& url) {
  const std::size_t colon = network.find(':');
  if (const auto host = network.substr(0, colon); !host.empty()) {
    url.host = host;
  }
  if (colon == std::string_view::npos) return true;
  const auto port = Decimal(network.substr(colon + 1), 1, kMaxPort);
  url.port = port.value_or(0);
  return port.has_value();
}

// Reads the options that are known, the last of each as LCM does. Returns the
// one that is wrong, or nothing.
std::string_view ReadOptions(LcmUrl& url) {
  constexpr std::string_view kTtl = "ttl=";
  constexpr std::string_view kRecvBuffer = "recv_buf_size=";
  for (std::string_view left = url.options; !left.empty();) {
    const std::string_view option = left.substr(0, left.find_first_of("&,"));
    left.remove_prefix(std::min(left.size(), option.size() + 1));
    if (option.starts_with(kTtl)) {
      if (!Decimal(option.substr(kTtl.size()), 0, kMaxTtl)) return option;
    } else if (option.starts_with(kRecvBuffer)) {
      const auto size =
          Decimal(option.substr(kRecvBuffer.size()), 1, kMaxRecvBuffer);
      if (!size) return option;
      url.recv_buf_size = *size;
    }
  }
  return {};
}

}  // namespace

std::string LcmUrl::text() const {
  const std::string network =
      port == 0 ? target : host + ":" + std::to_string(port);
  return provider + "://" + network + (options.empty() ? "" : "?" + options);
}

Result<LcmUrl> ParseLcmUrl(const std::string& text) {
  const std::size_t scheme = text.find("://");
  if (scheme == std::string::npos || scheme == 0) {
    return BadUrl(text, "no provider before \"://\"");
  }
  const auto is_control = [](unsigned char c) {
    return c < 0x20 || c == 0x7f;
  };
  if (std::any_of(text.begin(), text.end(), is_control)) {
    return BadUrl(text, "it holds a control character");
  }
  LcmUrl url;
  url.provider = text.substr(0, scheme);
  url.target = text.substr(scheme + 3);
  if (const std::size_t at = url.target.find('?'); at != std::string::npos) {
    url.options = url.target.substr(at + 1);
    url.target.resize(at);
  }
  if (!url.is_udpm() && !url.is_tcpq()) return url;
  url.host = url.is_udpm() ? kLcmGroup : kLcmHub;
  url.port = url.is_udpm() ? kLcmPort : kLcmHubPort;
  if (!ReadHostAndPort(url.target, url)) {
    return BadUrl(text, "the port must be 1 to 65535, in decimal digits");
  }
  if (url.is_tcpq()) return url;
  const std::optional<std::uint32_t> group = MulticastGroup(url.host);
  if (!group) {
    return BadUrl(text, url.host + " is no IPv4 multicast address");
  }
  url.address = *group;
  if (const std::string_view wrong = ReadOptions(url); !wrong.empty()) {
    return BadUrl(text, "\"" + std::string(wrong) +
                            "\" is not a number in its range (ttl 0 to 255, "
                            "recv_buf_size 1 to 2^30, in decimal digits)");
  }
  return url;
}

bool SameBus(const LcmUrl& a, const LcmUrl& b) {
  return a.provider == b.provider && a.host == b.host && a.port == b.port &&
         (a.port != 0 || a.target == b.target);
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
  Result<LcmUrl> url = ParseLcmUrl(deployed_url);
  if (!url) return url.error();
  if (!url->is_udpm()) return deployed_url;
  if (url->port == kMaxPort) {
    return BadUrl(deployed_url,
                  "the advice bus needs the next port; give --advice-url");
  }
  ++url->port;
  return url->text();
}

Result<std::string> JournalUrlFor(const std::string& deployed_url) {
  Result<LcmUrl> url = ParseLcmUrl(deployed_url);
  if (!url) return url.error();
  if (!url->is_udpm()) return deployed_url;
  if (url->port > kMaxPort - 2) {
    return BadUrl(deployed_url,
                  "the gate's journal needs this port plus two; give a smaller "
                  "port");
  }
  url->port += 2;
  return url->text();
}

}  // namespace terra::bus
