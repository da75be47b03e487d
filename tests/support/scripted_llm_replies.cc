#include <nlohmann/json.hpp>

#include "tests/support/scripted_llm_server.h"

namespace terra::testing {

using nlohmann::json;

std::string ReplyBody(const std::string& provider, const std::string& text) {
  if (provider == "openai") {
    return json{
        {"id", "resp_1"},
        {"object", "response"},
        {"model", "scripted"},
        {"status", "completed"},
        {"output",
         json::array(
             {json{{"type", "reasoning"}, {"summary", json::array()}},
              json{{"type", "message"},
                   {"role", "assistant"},
                   {"content", json::array({json{{"type", "output_text"},
                                                 {"text", text}}})}}})},
        {"usage", {{"input_tokens", 1000}, {"output_tokens", 20}}}}
        .dump();
  }
  if (provider == "anthropic") {
    return json{
        {"id", "msg_1"},
        {"type", "message"},
        {"model", "scripted"},
        {"content", json::array({json{{"type", "thinking"}, {"thinking", ""}},
                                 json{{"type", "text"}, {"text", text}}})},
        {"stop_reason", "end_turn"},
        {"usage", {{"input_tokens", 1000}, {"output_tokens", 20}}}}
        .dump();
  }
  if (provider == "gemini") {
    return json{
        {"candidates",
         json::array({json{
             {"content",
              {{"role", "model"},
               {"parts", json::array({json{{"text", "hm"}, {"thought", true}},
                                      json{{"text", text}}})}}},
             {"finishReason", "STOP"}}})},
        {"usageMetadata",
         {{"promptTokenCount", 1000}, {"candidatesTokenCount", 20}}},
        {"modelVersion", "scripted"}}
        .dump();
  }
  return json{
      {"id", "chat_1"},
      {"model", "scripted"},
      {"choices", json::array({json{
                      {"index", 0},
                      {"message", {{"role", "assistant"}, {"content", text}}},
                      {"finish_reason", "stop"}}})},
      {"usage", {{"prompt_tokens", 1000}, {"completion_tokens", 20}}}}
      .dump();
}

std::string ErrorBody(const std::string& provider, const std::string& message) {
  json error = {{"message", message}, {"type", "scripted_error"}};
  if (provider == "gemini") error["status"] = "UNAVAILABLE";
  return json{{"type", "error"}, {"error", error}}.dump();
}

}  // namespace terra::testing
