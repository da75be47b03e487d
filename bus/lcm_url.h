#pragma once

#include <string>

#include "terrain/result.h"

namespace terra::bus {

/// Where the deployed bus is when nobody says otherwise. ttl=0: what we send
/// stays on the host.
inline constexpr char kDefaultLcmUrl[] =
    "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";

/// The parts of an LCM URL that this project reads.
struct LcmUrl {
  std::string provider;  ///< "udpm", "memq", "file", ...
  std::string group;     ///< udpm only: multicast address.
  int port = 0;          ///< udpm only.
  std::string options;   ///< After '?', without it.

  bool is_udpm() const { return provider == "udpm"; }
};

/// Errors: no provider, a bad port, a group that is no IPv4 multicast address.
Result<LcmUrl> ParseLcmUrl(const std::string& text);

/// Returns `given`, else LCM_DEFAULT_URL, else kDefaultLcmUrl.
std::string EffectiveLcmUrl(const std::string& given);

/// Returns the advice bus that belongs to a deployed bus: the same URL with its
/// port plus one (LCM 1.3.1 separates traffic by port, not by group); the same
/// URL where there are no ports.
Result<std::string> AdviceUrlFor(const std::string& deployed_url);

}  // namespace terra::bus
