#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "advisor/encoded_picture.h"
#include "advisor/encoding.h"

namespace terra::advisor {

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

inline std::string DataUri(const EncodedPicture& picture) {
  return "data:image/png;base64," + Base64Encode(picture.png);
}

}  // namespace terra::advisor
