#include "advisor/http_transport.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>

#include <arpa/inet.h>
#include <curl/curl.h>

#include "advisor/ascii.h"
#include "terrain/require.h"

namespace terra::advisor {
namespace {

constexpr std::size_t kMaxHeaderBytes = 65'536;
constexpr int kPollMs = 1'000;

struct CloseUrl {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};
struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using List = std::unique_ptr<curl_slist, FreeList>;

void InitialiseLibrary() {
  static const CURLcode code = curl_global_init(CURL_GLOBAL_DEFAULT);
  TERRA_REQUIRE(code == CURLE_OK);
}

std::string UrlPart(CURLU* url, CURLUPart part) {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, 0) != CURLUE_OK) {
    return "";
  }
  const std::string copy(text);
  curl_free(text);
  return copy;
}

/// Pre: the host is in lower case.
bool IsLoopback(const std::string& host) {
  in_addr address{};
  const bool ipv4 = inet_pton(AF_INET, host.c_str(), &address) == 1;
  return host == "localhost" || host == "[::1]" ||
         (ipv4 && ntohl(address.s_addr) >> 24 == 127);
}

/// What the callbacks write to.
struct Sink {
  HttpReply& reply;
  std::size_t max_bytes;
  std::size_t header_bytes = 0;
};

std::size_t TakeBody(char* data, std::size_t, std::size_t size, void* user) {
  auto& sink = *static_cast<Sink*>(user);
  if (sink.reply.body.size() + size > sink.max_bytes) {
    sink.reply.fault = TransportFault::kTooLarge;
    return 0;
  }
  sink.reply.body.append(data, size);
  return size;
}

std::size_t TakeHeader(char* data, std::size_t, std::size_t size, void* user) {
  auto& sink = *static_cast<Sink*>(user);
  sink.header_bytes += size;
  if (sink.header_bytes > kMaxHeaderBytes) {
    sink.reply.fault = TransportFault::kTooLarge;
    return 0;
  }
  const std::string_view line(data, size);
  const std::size_t colon = line.find(':');
  if (colon != std::string_view::npos) {
    std::string name = Lowered(line.substr(0, colon));
    std::string_view value = line.substr(colon + 1);
    while (!value.empty() &&
           std::isspace(static_cast<unsigned char>(value.front())) != 0) {
      value.remove_prefix(1);
    }
    while (!value.empty() &&
           std::isspace(static_cast<unsigned char>(value.back())) != 0) {
      value.remove_suffix(1);
    }
    sink.reply.headers[name] = value;
  }
  return size;
}

TransportFault FaultOf(CURLcode code) {
  switch (code) {
    case CURLE_OK:
      return TransportFault::kNone;
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_COULDNT_CONNECT:
    case CURLE_SSL_CONNECT_ERROR:
      return TransportFault::kConnect;
    case CURLE_OPERATION_TIMEDOUT:
      return TransportFault::kTimeout;
    case CURLE_PARTIAL_FILE:
    case CURLE_GOT_NOTHING:
    case CURLE_SEND_ERROR:
    case CURLE_RECV_ERROR:
    case CURLE_HTTP2:
    case CURLE_HTTP2_STREAM:
      return TransportFault::kBroken;
    default:
      return TransportFault::kRefused;
  }
}

/// A line break in a value would begin a header of its own.
bool HasControlCharacter(const HeaderList& headers) {
  const auto bad = [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  };
  return std::any_of(headers.begin(), headers.end(), [&](const auto& header) {
    return std::any_of(header.second.begin(), header.second.end(), bad);
  });
}

List HeadersOf(const HttpRequest& request) {
  curl_slist* list =
      curl_slist_append(nullptr, "content-type: application/json");
  // Without this, larger bodies wait a second for a "100 Continue".
  list = curl_slist_append(list, "Expect:");
  for (const auto& [name, value] : request.headers) {
    list = curl_slist_append(list, (name + ": " + value).c_str());
  }
  return List(list);
}

void Configure(CURL* easy, const HttpRequest& request, curl_slist* headers,
               bool stays_here, Sink& sink) {
  // Rounded up: a call that ends with its time is never seen to end before it.
  const auto milliseconds = [](double seconds) {
    return static_cast<long>(std::ceil(std::max(1.0, seconds * 1000)));
  };
  curl_easy_setopt(easy, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(easy, CURLOPT_SSL_VERIFYPEER, 1L);
  curl_easy_setopt(easy, CURLOPT_SSL_VERIFYHOST, 2L);
  curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(easy, CURLOPT_TCP_KEEPALIVE, 1L);
  curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS,
                   milliseconds(request.connect_timeout_s));
  curl_easy_setopt(easy, CURLOPT_TIMEOUT_MS, milliseconds(request.timeout_s));
  curl_easy_setopt(easy, CURLOPT_POST, 1L);
  curl_easy_setopt(easy, CURLOPT_POSTFIELDS, request.body.data());
  curl_easy_setopt(easy, CURLOPT_POSTFIELDSIZE_LARGE,
                   static_cast<curl_off_t>(request.body.size()));
  curl_easy_setopt(easy, CURLOPT_HTTPHEADER, headers);
  curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, TakeBody);
  curl_easy_setopt(easy, CURLOPT_WRITEDATA, &sink);
  curl_easy_setopt(easy, CURLOPT_HEADERFUNCTION, TakeHeader);
  curl_easy_setopt(easy, CURLOPT_HEADERDATA, &sink);
  if (stays_here) {
    // Plain text goes to this machine only: never by way of a proxy.
    curl_easy_setopt(easy, CURLOPT_NOPROXY, "*");
  }
}

}  // namespace

struct HttpTransport::State {
  struct CloseEasy {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  };
  struct CloseMulti {
    void operator()(CURLM* handle) const { curl_multi_cleanup(handle); }
  };

  std::unique_ptr<CURLM, CloseMulti> multi{curl_multi_init()};
  std::unique_ptr<CURL, CloseEasy> easy{curl_easy_init()};
};

HttpTransport::HttpTransport() {
  InitialiseLibrary();
  state_ = std::make_unique<State>();
  if (state_->multi == nullptr || state_->easy == nullptr) {
    throw std::bad_alloc();
  }
}

HttpTransport::~HttpTransport() = default;

HttpReply HttpTransport::Post(const HttpRequest& request,
                              std::stop_token stop) {
  HttpReply reply;
  const auto checked = CheckBaseUrl(request.url);
  if (!checked) {
    reply.fault = TransportFault::kRefused;
    reply.fault_text = checked.error().message;
    return reply;
  }
  if (HasControlCharacter(request.headers)) {
    reply.fault = TransportFault::kRefused;
    reply.fault_text = "a header (key, version) holds a control character";
    return reply;
  }
  CURLM* multi = state_->multi.get();
  CURL* easy = state_->easy.get();
  Sink sink{reply, request.max_reply_bytes};
  const List headers = HeadersOf(request);
  curl_easy_reset(easy);
  Configure(easy, request, headers.get(), *checked == "loopback", sink);
  curl_multi_add_handle(multi, easy);
  const std::stop_callback wake(stop, [multi] {
    curl_multi_wakeup(multi);
  });

  int running = 1;
  CURLcode result = CURLE_FAILED_INIT;
  while (running > 0 && !stop.stop_requested()) {
    if (curl_multi_perform(multi, &running) != CURLM_OK) break;
    if (running > 0) curl_multi_poll(multi, nullptr, 0, kPollMs, nullptr);
  }
  for (int left = 0; CURLMsg* message = curl_multi_info_read(multi, &left);) {
    if (message->msg == CURLMSG_DONE) result = message->data.result;
  }
  long status = 0;
  curl_easy_getinfo(easy, CURLINFO_RESPONSE_CODE, &status);
  curl_multi_remove_handle(multi, easy);
  reply.status = static_cast<int>(status);
  if (running > 0) {
    reply.fault = TransportFault::kCancelled;
    reply.fault_text = "cancelled";
  } else if (reply.fault == TransportFault::kNone) {
    reply.fault = FaultOf(result);
    if (result != CURLE_OK) reply.fault_text = curl_easy_strerror(result);
  } else {
    reply.fault_text = "more than " + std::to_string(request.max_reply_bytes) +
                       " bytes of answer";
  }
  return reply;
}

Result<std::string> CheckBaseUrl(const std::string& url) {
  InitialiseLibrary();
  const std::unique_ptr<CURLU, CloseUrl> parsed(curl_url());
  if (parsed == nullptr ||
      curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK) {
    return Error{ErrorCode::kInvalid,
                 "'" + url +
                     "' is no address; write https://HOST[:PORT], or "
                     "http://127.0.0.1:PORT for a server on this machine"};
  }
  const std::string scheme = Lowered(UrlPart(parsed.get(), CURLUPART_SCHEME));
  const bool loopback =
      IsLoopback(Lowered(UrlPart(parsed.get(), CURLUPART_HOST)));
  if (!UrlPart(parsed.get(), CURLUPART_USER).empty() ||
      !UrlPart(parsed.get(), CURLUPART_PASSWORD).empty()) {
    return Error{ErrorCode::kInvalid,
                 "an address must not hold a name or password; keys come from "
                 "the environment"};
  }
  if (!UrlPart(parsed.get(), CURLUPART_QUERY).empty()) {
    return Error{ErrorCode::kInvalid,
                 "an address must not hold a query ('?'); keys come from the "
                 "environment"};
  }
  if (scheme != "https" && !(scheme == "http" && loopback)) {
    return Error{ErrorCode::kInvalid,
                 "'" + url +
                     "': only https, or http to this machine (127.0.0.1), is "
                     "allowed"};
  }
  return std::string(loopback ? "loopback" : "other");
}

}  // namespace terra::advisor
