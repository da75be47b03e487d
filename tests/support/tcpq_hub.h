#pragma once

#include <cstdint>
#include <string>
#include <thread>

namespace terra::testing {

/// A hub of a tcpq:// bus, as LCM's own is: greets whoever connects, and passes
/// each message on to those who subscribed to its channel. To destroy it is to
/// kill it.
class TcpqHub {
 public:
  /// On 127.0.0.1; port 0 = any that is free.
  explicit TcpqHub(int port = 0);
  ~TcpqHub();
  TcpqHub(const TcpqHub&) = delete;
  TcpqHub& operator=(const TcpqHub&) = delete;

  int port() const { return port_; }
  std::string url() const {
    return "tcpq://127.0.0.1:" + std::to_string(port_);
  }

 private:
  void Serve() const;

  int listening_fd_ = -1;
  int stop_fd_ = -1;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace terra::testing
