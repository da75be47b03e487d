#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "advisor/retry_policy.h"
#include "advisor/wire_format.h"
#include "terrain/result.h"

namespace terra::advisor {

/// Checks an address that requests may go to: https anywhere, plain http only
/// to this machine (localhost, 127.0.0.0/8, ::1), in any case; no user name,
/// password or query in it, which might be keys. Returns "loopback" or "other".
Result<std::string> CheckBaseUrl(const std::string& url);

struct HttpRequest {
  std::string url;
  HeaderList headers;  ///< Besides content-type: application/json.
  std::string body;
  double connect_timeout_s = 10;
  double timeout_s = 600;  ///< Of the whole exchange.
  std::size_t max_reply_bytes = 8u << 20;
};

struct HttpReply {
  TransportFault fault = TransportFault::kNone;
  std::string fault_text;
  int status = 0;
  std::map<std::string, std::string> headers;  ///< Names in lower case.
  std::string body;
};

/// Something that brings a request to a server: HTTP, or a test's.
class HttpSender {
 public:
  virtual ~HttpSender() = default;
  virtual HttpReply Post(const HttpRequest& request, std::stop_token stop) = 0;
};

/// Sends POST requests over HTTP. The only place that knows the HTTP library.
///
/// TLS certificates are verified; redirects are never followed; what goes to
/// this machine goes past every proxy of the environment; a reply larger than
/// allowed is cut off at once; headers with control characters are not
/// sent.
/// THREADING: Post works in the calling thread alone, with one request at a
/// time; a stop request from any thread wakes it at once. Connections are kept
/// open between calls.
class HttpTransport : public HttpSender {
 public:
  HttpTransport();
  ~HttpTransport() override;
  HttpTransport(const HttpTransport&) = delete;
  HttpTransport& operator=(const HttpTransport&) = delete;

  HttpReply Post(const HttpRequest& request, std::stop_token stop) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace terra::advisor
