#include "advisor/sim_wire.h"

#include <nlohmann/json.hpp>

#include "advisor/ascii.h"
#include "advisor/encoding.h"
#include "advisor/wire_json.h"
#include "base/base64.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

constexpr std::string_view kDataUrl = "data:image/png;base64,";

std::string ProviderOf(std::string_view path) {
  if (path.ends_with("/responses")) return "openai";
  if (path.ends_with("/messages")) return "anthropic";
  if (path.ends_with(":generateContent")) return "gemini";
  if (path.ends_with("/chat/completions")) return "chat";
  return "";
}

void AddPng(WireQuestion& question, std::string_view base64) {
  // Scheme and type of a data URL may be in any case.
  if (Lowered(base64.substr(0, kDataUrl.size())) == kDataUrl) {
    base64.remove_prefix(kDataUrl.size());
  }
  if (auto png = Base64Decode(base64)) {
    question.pngs.push_back(*std::move(png));
  }
}

/// One part of a message, whichever provider's.
void AddPart(WireQuestion& question, const json& part) {
  if (part.contains("text")) {
    question.text += part.at("text").get<std::string>() + "\n";
  } else if (part.contains("inlineData")) {
    AddPng(question, part.at("inlineData").at("data").get<std::string>());
  } else if (part.contains("source")) {
    AddPng(question, part.at("source").at("data").get<std::string>());
  } else if (part.contains("image_url")) {
    const json& url = part.at("image_url");
    AddPng(question,
           (url.is_object() ? url.at("url") : url).get<std::string>());
  }
}

}  // namespace

std::optional<WireQuestion> ReadWireQuestion(std::string_view path,
                                             std::string_view body) {
  WireQuestion question;
  question.provider = ProviderOf(path);
  if (question.provider.empty()) return std::nullopt;
  try {
    const json request = ParsedOutside(body);
    const bool gemini = question.provider == "gemini";
    const json& turns =
        request.at(gemini                          ? "contents"
                   : question.provider == "openai" ? "input"
                                                   : "messages");
    for (const json& turn : turns) {
      for (const json& part : turn.at(gemini ? "parts" : "content")) {
        AddPart(question, part);
      }
    }
  } catch (const json::exception&) {
    return std::nullopt;
  }
  return question;
}

std::string WriteWireReply(std::string_view provider, const std::string& model,
                           const std::string& text) {
  const json part = {{"type", provider == "openai" ? "output_text" : "text"},
                     {"text", text}};
  if (provider == "openai") {
    const json message = {{"type", "message"},
                          {"role", "assistant"},
                          {"status", "completed"},
                          {"content", json::array({part})}};
    return json{{"object", "response"},
                {"model", model},
                {"status", "completed"},
                {"output", json::array({message})}}
        .dump();
  }
  if (provider == "anthropic") {
    return json{{"type", "message"},
                {"role", "assistant"},
                {"model", model},
                {"content", json::array({part})},
                {"stop_reason", "end_turn"}}
        .dump();
  }
  if (provider == "gemini") {
    const json content = {{"role", "model"},
                          {"parts", json::array({json{{"text", text}}})}};
    const json candidate = {{"content", content}, {"finishReason", "STOP"}};
    return json{{"candidates", json::array({candidate})},
                {"modelVersion", model}}
        .dump();
  }
  const json message = {{"role", "assistant"}, {"content", text}};
  const json choice = {
      {"index", 0}, {"message", message}, {"finish_reason", "stop"}};
  return json{{"object", "chat.completion"},
              {"model", model},
              {"choices", json::array({choice})}}
      .dump();
}

}  // namespace terra::advisor
