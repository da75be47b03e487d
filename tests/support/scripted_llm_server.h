#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace terra::testing {

/// How the body's end is told.
enum class Framing {
  kLength,      ///< By content-length.
  kChunked,     ///< In chunks of 16 bytes, with extensions and a trailer.
  kUntilClose,  ///< HTTP/1.0: by closing the connection.
};

/// One step of the script: what the server does with the next request.
struct ScriptedReply {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string content_type = "application/json";  ///< Empty = not sent.
  std::string body;
  Framing framing = Framing::kLength;
  double delay_s = 0;        ///< Before anything is sent.
  bool reset = false;        ///< Close with a TCP reset instead of replying.
  bool silent = false;       ///< Never reply; hold the connection.
  double body_share = 1;     ///< Send only this share, then close.
  bool stall = false;        ///< After that share hold the connection instead.
  bool close_after = false;  ///< Close after the reply without saying so.
};

/// A request as it came.
struct SeenRequest {
  std::string method;
  std::string path;
  std::vector<std::pair<std::string, std::string>> headers;  ///< Lower case.
  std::string body;

  /// The header's value; empty where there is none.
  std::string Header(const std::string& name) const;
};

/// Replies in the form of a provider that say `text`, or fail in its way.
std::string ReplyBody(const std::string& provider, const std::string& text);
std::string ErrorBody(const std::string& provider, const std::string& message);

/// An HTTP server on a loopback port of its own that plays a script: one entry
/// a request, the last one for ever; or asks a function.
///
/// THREADING: one thread accepts and one serves each connection; all end with
/// the object. Members are safe from any thread.
class ScriptedLlmServer {
 public:
  using Handler = std::function<ScriptedReply(const SeenRequest&)>;

  explicit ScriptedLlmServer(std::vector<ScriptedReply> script);
  explicit ScriptedLlmServer(Handler handler, int port = 0);
  ~ScriptedLlmServer();
  ScriptedLlmServer(const ScriptedLlmServer&) = delete;
  ScriptedLlmServer& operator=(const ScriptedLlmServer&) = delete;

  int port() const { return port_; }
  std::string url() const;
  std::int64_t request_count() const { return request_count_; }
  /// The last requests, at most 64.
  std::vector<SeenRequest> requests() const;
  /// Waits until so many requests have come; false after the time.
  bool WaitForRequests(std::int64_t count, double seconds);

 private:
  void Accept();
  void Serve(int socket);
  bool Play(int socket, const ScriptedReply& reply);
  void Hold(int socket);
  bool Pause(double seconds);

  Handler handler_;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<std::int64_t> request_count_{0};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<SeenRequest> seen_;
  std::vector<int> open_;
  int serving_ = 0;  ///< Threads, detached so that none is kept when done.
  bool ending_ = false;
  std::thread accepting_;
};

}  // namespace terra::testing
