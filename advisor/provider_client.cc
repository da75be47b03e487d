#include "advisor/provider_client.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <random>
#include <utility>

#include "advisor/endpoint_url.h"
#include "advisor/interruptible_wait.h"
#include "advisor/wire_json.h"
#include "base/secrets.h"
#include "terrain/utf8.h"

namespace terra::advisor {
namespace {

using Clock = std::chrono::steady_clock;

/// Sent where a server on this machine wants the header, not a secret.
constexpr std::string_view kNoKey = "none";

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

NoAnswer ReasonOf(const TryOutcome& outcome) {
  switch (outcome.fault) {
    case TransportFault::kCancelled:
      return NoAnswer::kCancelled;
    case TransportFault::kTooLarge:
      return NoAnswer::kTooLarge;
    case TransportFault::kNone:
      return outcome.http_status >= 200 && outcome.http_status < 300
                 ? NoAnswer::kBadReply
                 : NoAnswer::kHttpStatus;
    default:
      return NoAnswer::kTransport;
  }
}

/// What the person who started this can do about it; often nothing.
std::string Remedy(const TryOutcome& outcome, const std::string& url,
                   const std::string& model, const std::string& key_advice) {
  if (outcome.fault == TransportFault::kConnect) {
    return " (" + url + "): does the server run, and is the address right?";
  }
  if (outcome.fault != TransportFault::kNone) return "";
  switch (outcome.http_status) {
    case 401:
    case 403:
      return "; " + key_advice;
    case 404:
    case 405:
      return "; check --base-url (" + url + ") and --model (" + model + ")";
    default:
      return outcome.wrong_form
                 ? "; does " + url + " speak this backend's form?"
                 : "";
  }
}

/// What comes from outside is printed on terminals and in logs: control
/// characters must not steer those.
std::string OnOneLine(std::string text) {
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = ReadUtf8(text, at);
    if (!character.valid || IsControl(character.code)) {
      text.replace(at, character.bytes, character.bytes, ' ');
    }
    at += character.bytes;
  }
  return text;
}

double Jitter() {
  thread_local std::minstd_rand random(std::random_device{}());
  return static_cast<double>(random() - std::minstd_rand::min()) /
         (static_cast<double>(std::minstd_rand::max()) + 1.0);
}

}  // namespace

Result<std::unique_ptr<LlmClient>> ProviderClient::Create(
    const std::string& provider, const ProviderOptions& options) {
  auto format = MakeWireFormat(provider);
  if (format == nullptr) {
    return Error{ErrorCode::kNotFound, "no provider '" + provider + "'"};
  }
  ProviderOptions full = options;
  if (full.settings.model.empty()) {
    full.settings.model = format->default_model();
  }
  const bool own_url = full.base_url.empty();
  if (own_url) full.base_url = format->default_base_url();
  const auto endpoint = CheckBaseUrl(full.base_url);
  if (!endpoint) return endpoint.error();

  const std::string variable(format->key_variable());
  const char* found = std::getenv(variable.c_str());
  std::string key = found == nullptr ? "" : found;
  if (key.find_first_of("\r\n") != std::string::npos) {
    return Error{ErrorCode::kInvalid, variable + " holds a line break"};
  }
  if (!key.empty()) {
    LeaveNoCore();
    ForbidTracing();
  } else if (!format->key_optional() && *endpoint != "loopback") {
    return Error{ErrorCode::kNotFound,
                 "no key: set the environment variable " + variable};
  } else if (!format->key_optional()) {
    key = kNoKey;
  }
  std::string endpoint_class = *endpoint;
  if (*endpoint != "loopback") {
    // Two servers may give two models one name: the address tells them apart.
    endpoint_class = own_url
                         ? "provider"
                         : "other " + EndpointUrl(full.base_url,
                                                  format->Path(full.settings));
  } else if (full.real_model) {
    endpoint_class = "loopback-model";
  }
  LlmIdentity identity{provider, full.settings.model,
                       SettingsText(*format, full.settings), endpoint_class};
  return std::unique_ptr<LlmClient>(std::make_unique<ProviderClient>(
      std::move(format), std::move(full), std::move(identity), std::move(key)));
}

ProviderClient::ProviderClient(std::unique_ptr<WireFormat> format,
                               ProviderOptions options, LlmIdentity identity,
                               std::string key,
                               std::unique_ptr<HttpSender> http)
    : format_(std::move(format)),
      options_(std::move(options)),
      identity_(std::move(identity)),
      key_(std::move(key)),
      http_(std::move(http)) {}

LlmReply ProviderClient::Ask(const LlmRequest& request, std::stop_token stop) {
  HttpRequest http;
  http.url = EndpointUrl(options_.base_url, format_->Path(options_.settings));
  http.headers = format_->Headers(options_.settings, key_);
  http.body =
      format_->Body(request, options_.settings)
          .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);

  LlmReply reply;
  const auto begin = Clock::now();
  for (;;) {
    const double left = options_.deadline_s - SecondsSince(begin);
    http.timeout_s = std::min(options_.try_timeout_s, left);
    const TryOutcome outcome = Try(http, reply, stop);
    ++reply.tries;
    reply.t_llm_s = SecondsSince(begin);
    if (reply.came()) {
      return reply;
    }
    reply.reason = ReasonOf(outcome);
    if (reply.reason == NoAnswer::kCancelled) {
      return reply;
    }
    const RetryDecision decision = DecideRetry(
        outcome, reply.tries - 1, Jitter(), std::time(nullptr), options_.retry);
    const bool late = reply.t_llm_s + decision.wait_s >= options_.deadline_s;
    if (late || !decision.retry) {
      const bool timed_out = outcome.fault == TransportFault::kTimeout;
      if (late && (decision.retry || timed_out)) {
        reply.reason = NoAnswer::kDeadline;
      }
      reply.error += Remedy(outcome, http.url, identity_.model, KeyAdvice());
      if (reply.tries > 1) {
        reply.error += " (asked " + std::to_string(reply.tries) + " times)";
      }
      return reply;
    }
    if (!WaitUnlessStopped(decision.wait_s, stop)) {
      reply.reason = NoAnswer::kCancelled;
      reply.t_llm_s = SecondsSince(begin);
      return reply;
    }
  }
}

TryOutcome ProviderClient::Try(const HttpRequest& request, LlmReply& reply,
                               std::stop_token stop) {
  HttpReply http = http_->Post(request, stop);
  TryOutcome outcome;
  outcome.fault = http.fault;
  outcome.http_status = reply.http_status = http.status;
  outcome.headers = std::move(http.headers);
  if (http.fault != TransportFault::kNone) {
    reply.error = http.fault_text;
    return outcome;
  }
  if (http.status < 200 || http.status >= 300) {
    outcome.error = format_->ReadError(http.body);
    reply.error = "HTTP " + std::to_string(http.status) +
                  (outcome.error.message.empty() ? "" : ": ") +
                  OnOneLine(WithoutKey(outcome.error.message));
    return outcome;
  }
  auto whole = format_->Whole(std::move(http.body));
  if (!whole) {
    reply.error = "the event stream ends before its answer";
    outcome.reply_failed = true;
    return outcome;
  }
  WireReply wire = format_->ReadReply(*whole);
  outcome.reply_failed = wire.transient;
  outcome.wrong_form = wire.wrong_form;
  outcome.error.retry_after_s = wire.retry_after_s;
  reply.status = wire.status;
  reply.text = WithoutKey(std::move(wire.text));
  reply.error = OnOneLine(WithoutKey(std::move(wire.error)));
  reply.model = OnOneLine(WithoutKey(std::move(wire.model)));
  reply.response_id = WithoutKey(std::move(wire.response_id));
  reply.usage = wire.usage;
  reply.body = BodyWithoutKey(*std::move(whole));
  if (reply.came()) {
    reply.reason = NoAnswer::kNone;
  }
  return outcome;
}

std::string ProviderClient::KeyAdvice() const {
  const std::string variable(format_->key_variable());
  return key_.empty() || key_ == kNoKey
             ? "no key was sent: set the environment variable " + variable
             : "check the key in the environment variable " + variable;
}

/// Some servers repeat the key in their texts.
std::string ProviderClient::WithoutKey(std::string text) const {
  constexpr std::size_t kShortestSecret = 8;
  if (key_.size() < kShortestSecret) {
    return text;
  }
  for (std::size_t at = 0; (at = text.find(key_, at)) != std::string::npos;) {
    text.replace(at, key_.size(), "[key]");
  }
  return text;
}

/// In a body the key may be written with escapes, as in "a\\/b". Then the body
/// is written anew, without needless ones; else it stays as it came.
std::string ProviderClient::BodyWithoutKey(std::string body) const {
  body = WithoutKey(std::move(body));
  if (body.find('\\') == std::string::npos) return body;
  const auto json = ParsedOutside(body);
  if (json.is_discarded()) return body;
  std::string plain =
      json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string redacted = WithoutKey(plain);
  return redacted == plain ? body : redacted;
}

}  // namespace terra::advisor
