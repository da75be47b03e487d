#include "tests/support/tcpq_hub.h"

#include <poll.h>
#include <regex.h>
#include <unistd.h>

#include <array>
#include <list>
#include <stdexcept>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

namespace terra::testing {
namespace {

constexpr std::uint32_t kMagicServer = 0x287617fa;
constexpr std::uint32_t kMagicClient = 0x287617fb;
constexpr std::uint32_t kVersion = 0x0100;
constexpr std::uint32_t kPublish = 1;
constexpr std::uint32_t kSubscribe = 2;

struct Client {
  int fd = -1;
  std::string bytes;                  // Read and not yet understood.
  std::vector<std::string> channels;  // Regular expressions.
  bool gone = false;
};

std::string BigEndian(std::uint32_t value) {
  const std::uint32_t bytes = htonl(value);
  return {reinterpret_cast<const char*>(&bytes), sizeof bytes};
}

std::uint32_t NumberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  bytes.copy(reinterpret_cast<char*>(&value), sizeof value, at);
  return ntohl(value);
}

void Send(Client& to, const std::string& bytes) {
  const ssize_t sent = send(to.fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(bytes.size())) to.gone = true;
}

// Takes one text with its length in front from a place on; false where it is
// not all there yet.
bool TakeText(const std::string& bytes, std::size_t& at, std::string& text) {
  if (bytes.size() < at + 4) return false;
  const std::size_t length = NumberAt(bytes, at);
  if (bytes.size() < at + 4 + length) return false;
  text = bytes.substr(at + 4, length);
  at += 4 + length;
  return true;
}

// (std::regex makes gcc 12 warn of itself under sanitizers.)
bool Matches(const std::string& channel, const std::string& wanted) {
  regex_t expression;
  if (regcomp(&expression, ("^(" + wanted + ")$").c_str(),
              REG_EXTENDED | REG_NOSUB) != 0) {
    return false;
  }
  const bool matches =
      regexec(&expression, channel.c_str(), 0, nullptr, 0) == 0;
  regfree(&expression);
  return matches;
}

// Does what one whole frame of a client says; false where there is none.
bool TakeFrame(Client& from, std::list<Client>& clients) {
  if (from.bytes.size() < 4) return false;
  const std::uint32_t kind = NumberAt(from.bytes, 0);
  std::size_t at = 4;
  if (kind == kMagicClient) {  // and the version
    if (from.bytes.size() < 8) return false;
    from.bytes.erase(0, 8);
    return true;
  }
  std::string channel;
  if (!TakeText(from.bytes, at, channel)) return false;
  if (kind == kSubscribe) from.channels.emplace_back(channel);
  if (kind == kPublish) {
    std::string data;
    if (!TakeText(from.bytes, at, data)) return false;
    for (Client& each : clients) {
      for (const std::string& wanted : each.channels) {
        if (!Matches(channel, wanted)) continue;
        Send(each, from.bytes.substr(0, at));
        break;
      }
    }
  }
  from.bytes.erase(0, at);
  return true;
}

void Read(Client& client, std::list<Client>& clients) {
  std::array<char, 65536> buffer;
  const ssize_t got = recv(client.fd, buffer.data(), buffer.size(), 0);
  if (got <= 0) {
    client.gone = true;
    return;
  }
  client.bytes.append(buffer.data(), static_cast<std::size_t>(got));
  while (TakeFrame(client, clients)) {
  }
}

}  // namespace

TcpqHub::TcpqHub(int port)
    : listening_fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      stop_fd_(eventfd(0, EFD_CLOEXEC)) {
  const int on = 1;
  setsockopt(listening_fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  if (bind(listening_fd_, generic, size) != 0 ||
      listen(listening_fd_, 64) != 0 ||
      getsockname(listening_fd_, generic, &size) != 0) {
    throw std::runtime_error("the hub cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] {
    Serve();
  });
}

TcpqHub::~TcpqHub() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t n = write(stop_fd_, &one, sizeof one);
  thread_.join();
  close(listening_fd_);
  close(stop_fd_);
}

// THREADING: the hub's one thread; its clients are its own.
void TcpqHub::Serve() const {
  std::list<Client> clients;
  while (true) {
    std::vector<pollfd> waited = {{stop_fd_, POLLIN, 0},
                                  {listening_fd_, POLLIN, 0}};
    for (const Client& client : clients) {
      waited.push_back({client.fd, POLLIN, 0});
    }
    if (poll(waited.data(), waited.size(), -1) < 0) continue;
    if (waited[0].revents != 0) break;
    std::size_t at = 2;
    for (Client& client : clients) {
      if (waited[at++].revents != 0) Read(client, clients);
    }
    if (waited[1].revents != 0) {
      clients.push_back({accept(listening_fd_, nullptr, nullptr), "", {}});
      Send(clients.back(), BigEndian(kMagicServer) + BigEndian(kVersion));
    }
    for (auto client = clients.begin(); client != clients.end();) {
      if (client->gone) close(client->fd);
      client = client->gone ? clients.erase(client) : std::next(client);
    }
  }
  for (const Client& client : clients) close(client.fd);
}

}  // namespace terra::testing
