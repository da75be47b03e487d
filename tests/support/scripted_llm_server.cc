#include "tests/support/scripted_llm_server.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace terra::testing {
namespace {

constexpr std::size_t kRequestsKept = 64;
constexpr std::size_t kMaxRequestBytes = 64u << 20;

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return text;
}

bool SendAll(int socket, const std::string& data) {
  for (std::size_t sent = 0; sent < data.size();) {
    const ssize_t n =
        send(socket, data.data() + sent, data.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

bool ReceiveMore(int socket, std::string& buffer) {
  char chunk[16'384];
  const ssize_t n = recv(socket, chunk, sizeof chunk, 0);
  if (n <= 0 || buffer.size() > kMaxRequestBytes) return false;
  buffer.append(chunk, static_cast<std::size_t>(n));
  return true;
}

SeenRequest ParseHead(const std::string& head) {
  SeenRequest request;
  const std::size_t first = head.find("\r\n");
  const std::string line = head.substr(0, first);
  const std::size_t space = line.find(' ');
  request.method = line.substr(0, space);
  request.path = line.substr(space + 1, line.rfind(' ') - space - 1);
  for (std::size_t at = first; at != std::string::npos && at < head.size();) {
    const std::size_t begin = at + 2;
    at = head.find("\r\n", begin);
    const std::string field = head.substr(begin, at - begin);
    const std::size_t colon = field.find(':');
    if (colon == std::string::npos) continue;
    const std::size_t value = field.find_first_not_of(' ', colon + 1);
    request.headers.emplace_back(
        Lower(field.substr(0, colon)),
        value == std::string::npos ? "" : field.substr(value));
  }
  return request;
}

/// Takes one request from the connection; `buffer` keeps what follows it.
std::optional<SeenRequest> TakeRequest(int socket, std::string& buffer) {
  std::size_t end = 0;
  while ((end = buffer.find("\r\n\r\n")) == std::string::npos) {
    if (!ReceiveMore(socket, buffer)) return std::nullopt;
  }
  SeenRequest request = ParseHead(buffer.substr(0, end));
  buffer.erase(0, end + 4);
  const auto length = static_cast<std::size_t>(
      std::atoll(request.Header("content-length").c_str()));
  while (buffer.size() < length) {
    if (!ReceiveMore(socket, buffer)) return std::nullopt;
  }
  request.body = buffer.substr(0, length);
  buffer.erase(0, length);
  return request;
}

std::string Head(const ScriptedReply& reply) {
  const bool old = reply.framing == Framing::kUntilClose;
  std::string head = std::string(old ? "HTTP/1.0 " : "HTTP/1.1 ") +
                     std::to_string(reply.status) + " Scripted\r\n";
  if (!reply.content_type.empty()) {
    head += "content-type: " + reply.content_type + "\r\n";
  }
  if (reply.framing == Framing::kLength) {
    head += "content-length: " + std::to_string(reply.body.size()) + "\r\n";
  } else if (reply.framing == Framing::kChunked) {
    head += "transfer-encoding: chunked\r\n";
  }
  for (const auto& [name, value] : reply.headers) {
    head += name + ": " + value + "\r\n";
  }
  return head + "\r\n";
}

/// The first bytes of the body as they go over the wire; chunks of 16 bytes,
/// the last one missing where the body is cut.
std::string Framed(const ScriptedReply& reply, std::size_t bytes) {
  if (reply.framing != Framing::kChunked) return reply.body.substr(0, bytes);
  constexpr std::size_t kChunk = 16;
  std::string framed;
  for (std::size_t at = 0; at < bytes; at += kChunk) {
    const std::string chunk =
        reply.body.substr(at, std::min(kChunk, bytes - at));
    std::array<char, 24> size{};
    std::snprintf(size.data(), size.size(), "%zx;x=y\r\n", chunk.size());
    framed += size.data() + chunk + "\r\n";
  }
  return bytes < reply.body.size() ? framed : framed + "0\r\nx-end: 1\r\n\r\n";
}

}  // namespace

std::string SeenRequest::Header(const std::string& name) const {
  for (const auto& [key, value] : headers) {
    if (key == name) return value;
  }
  return "";
}

ScriptedLlmServer::ScriptedLlmServer(std::vector<ScriptedReply> script)
    : ScriptedLlmServer([script = std::move(script),
                         next = std::make_shared<std::atomic<std::size_t>>(0)](
                            const SeenRequest&) {
        return script.at(std::min(next->fetch_add(1), script.size() - 1));
      }) {}

ScriptedLlmServer::ScriptedLlmServer(Handler handler, int port)
    : handler_(std::move(handler)) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_, generic, size) != 0 || listen(listener_, 64) != 0 ||
      getsockname(listener_, generic, &size) != 0) {
    close(listener_);
    throw std::runtime_error("cannot listen on 127.0.0.1");
  }
  port_ = ntohs(address.sin_port);
  accepting_ = std::thread([this] {
    Accept();
  });
}

ScriptedLlmServer::~ScriptedLlmServer() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
    for (const int socket : open_) shutdown(socket, SHUT_RDWR);
  }
  changed_.notify_all();
  shutdown(listener_, SHUT_RDWR);
  accepting_.join();
  close(listener_);
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] {
    return serving_ == 0;
  });
}

std::string ScriptedLlmServer::url() const {
  return "http://127.0.0.1:" + std::to_string(port_);
}

std::vector<SeenRequest> ScriptedLlmServer::requests() const {
  const std::scoped_lock lock(mutex_);
  return {seen_.begin(), seen_.end()};
}

bool ScriptedLlmServer::WaitForRequests(std::int64_t count, double seconds) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
    return request_count_ >= count;
  });
}

void ScriptedLlmServer::Accept() {
  for (;;) {
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const std::scoped_lock lock(mutex_);
    if (socket < 0 || ending_) {
      if (socket >= 0) close(socket);
      return;
    }
    open_.push_back(socket);
    ++serving_;
    std::thread([this, socket] {
      Serve(socket);
    }).detach();
  }
}

void ScriptedLlmServer::Serve(int socket) {
  std::string buffer;
  while (auto request = TakeRequest(socket, buffer)) {
    // Before it counts: who waits for this request may send the next one, and
    // that must not get this one's reply.
    const ScriptedReply reply = handler_(*request);
    {
      const std::scoped_lock lock(mutex_);
      seen_.push_back(*request);
      if (seen_.size() > kRequestsKept) seen_.pop_front();
      ++request_count_;
    }
    changed_.notify_all();
    if (!Play(socket, reply)) break;
  }
  const std::scoped_lock lock(mutex_);
  std::erase(open_, socket);
  close(socket);
  --serving_;
  changed_.notify_all();  // Locked, so that the object outlives the call.
}

bool ScriptedLlmServer::Play(int socket, const ScriptedReply& reply) {
  if (reply.delay_s > 0 && !Pause(reply.delay_s)) return false;
  if (reply.silent) {
    Hold(socket);
    return false;
  }
  if (reply.reset) {
    const linger now{1, 0};
    setsockopt(socket, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    return false;
  }
  const auto part = static_cast<std::size_t>(
      static_cast<double>(reply.body.size()) * reply.body_share);
  if (!SendAll(socket, Head(reply) + Framed(reply, part))) return false;
  if (reply.stall) Hold(socket);
  return part == reply.body.size() && !reply.stall && !reply.close_after &&
         reply.framing != Framing::kUntilClose;
}

/// Waits until the other side closes or the server ends.
void ScriptedLlmServer::Hold(int socket) {
  std::string ignored;
  while (ReceiveMore(socket, ignored)) ignored.clear();
}

bool ScriptedLlmServer::Pause(double seconds) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                            [this] {
                              return ending_;
                            });
}

}  // namespace terra::testing
