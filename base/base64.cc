#include "base/base64.h"

#include <openssl/evp.h>

namespace terra {
namespace {

const unsigned char* Bytes(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}
unsigned char* Bytes(std::string& text) {
  return reinterpret_cast<unsigned char*>(text.data());
}

}  // namespace

std::string Base64Encode(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  const int length = EVP_EncodeBlock(Bytes(text), Bytes(bytes),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::optional<std::string> Base64Decode(std::string_view text) {
  std::string bytes(text.size() / 4 * 3, '\0');
  if (text.size() % 4 != 0 ||
      EVP_DecodeBlock(Bytes(bytes), Bytes(text),
                      static_cast<int>(text.size())) < 0) {
    return std::nullopt;
  }
  // The decoder pads with zeros and forgives white space at the ends.
  for (std::size_t i = text.size(); i > 0 && text[i - 1] == '='; --i) {
    if (bytes.empty()) return std::nullopt;
    bytes.pop_back();
  }
  if (Base64Encode(bytes) != text) {
    return std::nullopt;
  }
  return bytes;
}

}  // namespace terra
