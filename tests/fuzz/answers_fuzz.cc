// What comes from a model or from people as text: answers, routes, points,
// recordings, the providers' replies and batch results. The first byte chooses.

#include <array>

#include "advisor/answer_parser.h"
#include "advisor/batch_format.h"
#include "advisor/recording.h"
#include "advisor/wire_format.h"
#include "terrain/route_text.h"
#include "tests/fuzz/fuzz.h"

namespace {

void CheckAnswer(std::string_view text, terra::advisor::AnswerStyle style) {
  using namespace terra::advisor;
  const Answer answer = ParseAnswer(text, {.style = style,
                                           .max_candidates = 3,
                                           .max_bytes = 4'096,
                                           .max_waypoints = 64});
  const bool propose = answer.kind == AnswerKind::kPropose;
  terra::fuzz::Require(propose != answer.candidates.empty(),
                       "candidates exactly where routes are proposed");
  terra::fuzz::Require(answer.candidates.size() <= 3, "no more than asked for");
  for (const AnswerCandidate& candidate : answer.candidates) {
    terra::fuzz::Require(candidate.waypoints.size() <= 64, "waypoint limit");
    terra::fuzz::Require(
        candidate.fault == AnswerFault::kNone || candidate.waypoints.empty(),
        "nothing is taken from a faulty list");
  }
}

void CheckRoute(std::string_view text) {
  const auto route = terra::ParseRoute(text, 256);
  if (!route) return;
  const auto again = terra::ParseRoute(terra::FormatRoute(*route), 256);
  terra::fuzz::Require(again && *again == *route,
                       "a route is read back as it was written");
}

void CheckReply(std::string_view provider, std::string_view body) {
  const auto format = terra::advisor::MakeWireFormat(provider);
  const auto whole = format->Whole(std::string(body));
  const terra::advisor::WireReply reply = format->ReadReply(whole.value_or(""));
  terra::fuzz::Require(reply.status != terra::advisor::ReplyStatus::kNoAnswer ||
                           !reply.error.empty(),
                       "what is no answer says why");
  format->ReadError(body);
}

void CheckBatchResult(std::string_view line) {
  for (const std::string_view provider : {"openai", "anthropic", "gemini"}) {
    const auto format = terra::advisor::MakeWireFormat(provider);
    terra::fuzz::RequireReason(terra::advisor::ReadBatchResult(*format, line));
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = terra::fuzz::Text(data + 1, size - 1);
  constexpr std::array<std::string_view, 4> kProviders = {"openai", "gemini",
                                                          "anthropic", "chat"};
  switch (data[0] % 10) {
    case 0:
      CheckAnswer(text, terra::advisor::AnswerStyle::kAdvice);
      break;
    case 1:
      CheckAnswer(text, terra::advisor::AnswerStyle::kRoute);
      break;
    case 2:
      CheckRoute(text);
      break;
    case 3:
      terra::fuzz::RequireReason(terra::ParsePoint(text));
      break;
    case 4:
      terra::fuzz::RequireReason(terra::advisor::ParseRecord(text));
      break;
    case 9:
      CheckBatchResult(text);
      break;
    default:
      CheckReply(kProviders[data[0] % 10 - 5], text);
  }
  return 0;
}
