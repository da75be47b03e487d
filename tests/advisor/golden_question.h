#pragma once

#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "advisor/llm_client.h"
#include "terrain/files/whole_file.h"

namespace terra::advisor {

/// A file of tests/data/providers.
inline std::string ProviderSample(const std::string& name) {
  return ReadWholeFile(TERRA_TEST_DATA "/providers/" + name, 1u << 20).value();
}

/// The question that the golden requests ask, with a text of choice.
inline LlmRequest GoldenQuestion(const std::string& text) {
  LlmRequest request;
  request.text = text;
  for (const char* name : {"map.png", "map_baseline.png", "rea_pair.png"}) {
    auto picture = std::make_shared<EncodedPicture>();
    picture->png = ProviderSample(name);
    request.pictures.push_back(std::move(picture));
  }
  return request;
}

/// The longest text in a request's body: the question.
inline std::string QuestionIn(const nlohmann::json& body) {
  std::string longest;
  const nlohmann::json flat = body.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (!value.is_string() || !(path.ends_with("/text"))) continue;
    const auto& text = value.get_ref<const std::string&>();
    if (text.size() > longest.size()) longest = text;
  }
  return longest;
}

}  // namespace terra::advisor
