#pragma once

#include <cstdint>
#include <string>

#include "terrain/result.h"

namespace terra::bus {

/// Where the deployed bus is when nobody says otherwise. ttl=0: what we send
/// stays on the host.
inline constexpr char kDefaultLcmUrl[] =
    "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";

/// An LCM URL, as every process reads it: what liblcm is given is made from
/// this, since its versions read ports that are left out differently (1.3.1
/// takes port 0) and numbers as C does (07667 is octal).
struct LcmUrl {
  std::string provider;       ///< "udpm", "tcpq", "memq", "file", ...
  std::string host;           ///< udpm: multicast group; tcpq: the hub.
  std::uint32_t address = 0;  ///< udpm: the group, in host order.
  int port = 0;               ///< udpm and tcpq.
  int recv_buf_size = 0;      ///< udpm: bytes; 0 = not given.
  std::string target;         ///< Other providers: between "://" and '?'.
  std::string options;        ///< After '?', without it.

  bool is_udpm() const { return provider == "udpm"; }
  bool is_tcpq() const { return provider == "tcpq"; }

  /// The same URL with host and port in full.
  std::string text() const;
};

/// Reads a URL. What is left out is LCM's default: udpm 239.255.76.67:7667,
/// tcpq 127.0.0.1:7700.
/// Errors: no provider, a bad port, a group that is no IPv4 multicast address,
/// a ttl or recv_buf_size that is no number in its range.
Result<LcmUrl> ParseLcmUrl(const std::string& text);

/// Returns whether two URLs name one bus, however they are written.
bool SameBus(const LcmUrl& a, const LcmUrl& b);

/// Returns `given`, else LCM_DEFAULT_URL, else kDefaultLcmUrl.
std::string EffectiveLcmUrl(const std::string& given);

/// Returns the advice bus that belongs to a deployed bus: the same URL with its
/// port plus one (LCM 1.3.1 separates traffic by port, not by group); the same
/// URL where it is not udpm.
Result<std::string> AdviceUrlFor(const std::string& deployed_url);

/// Returns where the gate of a deployed bus says what it heard, for the
/// recorder: the same URL with its port plus two; the same URL where it is not
/// udpm.
Result<std::string> JournalUrlFor(const std::string& deployed_url);

}  // namespace terra::bus
