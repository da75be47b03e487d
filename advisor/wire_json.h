#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/encoded_picture.h"
#include "advisor/encoding.h"
#include "base/base64.h"

namespace terra::advisor {

/// Are brackets nested deeper than in any reply or request of the providers?
inline bool IsNestedTooDeeply(std::string_view text) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') in_string = !in_string;
    if (in_string) {
      i += c == '\\' ? 1 : 0;
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) return true;
  }
  return false;
}

/// Reads JSON from outside without throwing: discarded where it is none, or
/// nested so deeply that copying or writing it, which recurse, would exhaust
/// the stack.
inline nlohmann::json ParsedOutside(std::string_view text) {
  if (IsNestedTooDeeply(text)) {
    return nlohmann::json(nlohmann::json::value_t::discarded);
  }
  return nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
}

/// What is wrong with JSON, for people: without the library's own marks.
inline std::string JsonFault(const nlohmann::json::exception& fault) {
  constexpr int kWrongType = 302;
  constexpr int kShortArray = 401;
  constexpr int kNoSuchKey = 403;
  constexpr int kOwn = 501;  // Of IntegerAt.
  if (const auto* parse =
          dynamic_cast<const nlohmann::json::parse_error*>(&fault)) {
    return "no JSON, from byte " + std::to_string(parse->byte) + " on";
  }
  if (fault.id == kShortArray) return "an array has too few elements";
  if (fault.id != kWrongType && fault.id != kNoSuchKey && fault.id != kOwn) {
    return "a value has another type than expected";
  }
  const std::string_view what = fault.what();
  const std::size_t mark = what.find("] ");
  return std::string(mark == std::string_view::npos ? what
                                                    : what.substr(mark + 2));
}

/// Replies leave out fields, or set them to null: these read what is there.
inline std::string TextOr(const nlohmann::json& object, const char* key,
                          std::string otherwise = "") {
  if (!object.is_object()) return otherwise;
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>()
                                               : otherwise;
}

/// A count of tokens; 0 for anything that is no sensible one.
inline std::int64_t CountOr0(const nlohmann::json& object, const char* key) {
  constexpr std::int64_t kMost = 1'000'000'000;
  if (!object.is_object()) return 0;
  const auto at = object.find(key);
  if (at == object.end() || !at->is_number_integer()) return 0;
  const auto count = at->get<std::int64_t>();
  return count >= 0 && count <= kMost ? count : 0;
}

/// The member, or null where there is none.
inline const nlohmann::json& MemberOf(const nlohmann::json& object,
                                      const char* key) {
  static const nlohmann::json kNull;
  if (!object.is_object()) return kNull;
  const auto at = object.find(key);
  return at == object.end() ? kNull : *at;
}

/// Takes over the members that say something: a later event of a stream may
/// leave out, or set to null, what an earlier one said.
inline void TakeOver(nlohmann::json& object, const nlohmann::json& later) {
  if (!later.is_object()) return;
  for (const auto& [key, value] : later.items()) {
    if (!value.is_null()) object[key] = value;
  }
}

/// The member, which has to be a whole number that Int holds: `get<Int>()`
/// converts fractions and numbers beyond Int silently, the latter undefined.
/// Throws nlohmann::json::exception, as `at` does.
template <typename Int, typename Json>
Int IntegerAt(const Json& object, const char* key) {
  const Json& value = object.at(key);
  const bool fits =
      value.is_number_unsigned()
          ? std::in_range<Int>(value.template get<std::uint64_t>())
          : value.is_number_integer() &&
                std::in_range<Int>(value.template get<std::int64_t>());
  if (!fits) {
    throw nlohmann::json::other_error::create(
        501, std::string(key) + " is no whole number in range", &value);
  }
  return value.template get<Int>();
}

/// The text of a message: one string, or parts of which those of the given
/// types are joined. Compatible servers differ in which of the two they send.
/// Throws nlohmann::json::exception for anything else but null.
inline std::string ContentText(const nlohmann::json& content,
                               std::initializer_list<std::string_view> types) {
  if (content.is_string()) return content.get<std::string>();
  std::string text;
  for (const nlohmann::json& part : content) {
    const std::string type = part.at("type").get<std::string>();
    if (std::find(types.begin(), types.end(), type) != types.end()) {
      text += part.at("text").get<std::string>();
    }
  }
  return text;
}

inline std::string DataUri(const EncodedPicture& picture) {
  return "data:image/png;base64," + Base64Encode(picture.png);
}

}  // namespace terra::advisor
