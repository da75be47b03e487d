#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "advisor/advice_codec.h"
#include "advisor/llm_backend.h"
#include "bus/envelope.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/route_cost.h"
#include "terrain/utf8.h"
#include "tests/fuzz/fuzz.h"

/// The whole way from who answers to the bytes of ADVICE, without a network, a
/// thread or a clock.
namespace terra::fuzz {

/// A transport that checks what is sent as a stranger would.
class AdviceReader : public bus::Transport {
 public:
  bool Publish(bus::Channel channel,
               std::span<const std::uint8_t> bytes) override {
    Require(channel == bus::Channel::kAdvice, "advice alone is sent");
    Require(bytes.size() <= bus::kMaxMessageBytes, "advice fits a datagram");
    const auto message = bus::Decode<terra_msg::advice_t>(bytes);
    Require(message.ok(), "advice decodes");
    Check(*message);
    ++read_;
    return true;
  }

  int read() const { return read_; }

 private:
  static void Check(const terra_msg::advice_t& message) {
    for (const std::string* text :
         {&message.advisor, &message.method, &message.backend, &message.model,
          &message.request_hash, &message.answer_text, &message.advice_error}) {
      Require(IsUtf8(*text), "texts are UTF-8");
      for (const char c : *text) {
        const bool layout = c == '\n' || c == '\t' || c == '\r';
        Require(layout || static_cast<unsigned char>(c) >= 0x20,
                "texts hold no control characters");
      }
    }
    Require(message.advice_error.find("json.exception") == std::string::npos,
            "errors are written for people");
    const bool proposes = message.kind == terra_msg::advice_t::KIND_PROPOSE;
    Require(proposes == (message.num_waypoints > 0),
            "waypoints exactly where a route is proposed");
    Require(proposes || message.kind == terra_msg::advice_t::KIND_RETAIN ||
                !message.advice_error.empty(),
            "what is no advice says why");
  }

  int read_ = 0;
};

/// Asks a client about a small map, and sends what comes of it.
class AdviceProblem {
 public:
  /// Checks every message that a client's answer leads to.
  void Ask(std::unique_ptr<advisor::LlmClient> client,
           const advisor::MethodOptions& method) {
    advisor::LlmBackendOptions options;
    options.method = method;
    advisor::LlmBackend backend(
        "fuzz", {std::move(client), std::make_shared<advisor::CallMonitor>()},
        options, nullptr);
    const advisor::AdviceAnswer answer = backend.Advise(
        {*map_, 7, 1, route_.front(), route_.back(), route_, cost_}, {});
    const advisor::AdviceWorker::Job job{1,  map_,          7,      1,    5,
                                         {}, route_.back(), route_, cost_};
    AdviceReader reader;
    bus::Outbox out(reader, 4711);
    auto messages = advisor::ToMessages(
        {"fuzz", backend.method(), backend.name()}, job, answer);
    for (terra_msg::advice_t& message : messages) out.Send(message);
    Require(reader.read() > 0, "every answer is told");
  }

 private:
  std::shared_ptr<const TerrainMap> map_ = [] {
    ByteRaster ids = ByteRaster::Constant(12, 16, 1);
    ids.block(3, 5, 3, 2).setConstant(9);
    return std::make_shared<const TerrainMap>(
        TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value());
  }();
  Route route_ = {{1, 1}, {14, 9}};
  double cost_ = WalkRoute(*map_, route_).cost;
};

}  // namespace terra::fuzz
