#pragma once

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace terra::testing {

inline std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes += static_cast<char>(value >> shift & 0xFF);
  }
  return bytes;
}

inline std::string Chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                          static_cast<uInt>(body.size()));
  return BigEndian(static_cast<std::uint32_t>(data.size())) + body +
         BigEndian(static_cast<std::uint32_t>(sum));
}

inline std::string Deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(out.data()), &size,
               reinterpret_cast<const Bytef*>(bytes.data()),
               bytes.size()) != Z_OK) {
    throw std::runtime_error("zlib does not compress");
  }
  out.resize(size);
  return out;
}

// A PNG as its format's text says, from what its rows hold.
struct HandMade {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  char depth = 8;
  char color_type = 0;
  char interlace = 0;
  std::string chunks = "";            // Between IHDR and IDAT.
  std::string rows = {'\0', '\x07'};  // Each begins with its filter, 0.

  std::string Bytes() const {
    return "\x89PNG\r\n\x1a\n" +
           Chunk("IHDR", BigEndian(width) + BigEndian(height) + depth +
                             color_type + '\0' + '\0' + interlace) +
           chunks + Chunk("IDAT", Deflated(rows)) + Chunk("IEND", "");
  }
};

}  // namespace terra::testing
