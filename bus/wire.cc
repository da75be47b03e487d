#include "bus/wire.h"

#include <algorithm>
#include <cctype>
#include <limits>

#include "terrain/utf8.h"

namespace terra::bus {
namespace {

Error Malformed(const std::string& what) {
  return Error{ErrorCode::kInvalid, "malformed message: " + what};
}

// Walks over big-endian bytes without ever leaving them.
class Walker {
 public:
  explicit Walker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }

  bool Skip(std::size_t count, std::size_t size) {
    if (count > left() / size) return false;
    at_ += count * size;
    return true;
  }

  // Pre: size bytes are left.
  std::uint64_t Unsigned(std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes_[at_++];
    return value;
  }

  bool SkipString(std::int32_t limit) {
    if (left() < 4) return false;
    const auto length =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(Unsigned(4)));
    if (length < 1 || static_cast<std::size_t>(length) > left() ||
        length - 1 > limit) {
      return false;
    }
    // The length counts the zero at the end, which must be the only one.
    const auto text = bytes_.subspan(at_, static_cast<std::size_t>(length) - 1);
    at_ += static_cast<std::size_t>(length);
    return std::find(text.begin(), text.end(), 0) == text.end() &&
           bytes_[at_ - 1] == 0;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

constexpr std::int32_t kNoLimit = std::numeric_limits<std::int32_t>::max();

// One field of a layout.
struct Field {
  char kind = ' ';
  std::int32_t limit = kNoLimit;
  bool repeated = false;
};

// Reads the field at a place in the layout and moves past it.
Field NextField(std::string_view layout, std::size_t& at) {
  Field field;
  field.kind = layout[at++];
  if (at < layout.size() && std::isdigit(layout[at]) != 0) field.limit = 0;
  while (at < layout.size() && std::isdigit(layout[at]) != 0) {
    field.limit = field.limit * 10 + (layout[at++] - '0');
  }
  field.repeated = at < layout.size() && layout[at] == '*';
  if (field.repeated) ++at;
  return field;
}

std::size_t FieldSize(char kind) {
  switch (kind) {
    case 'l':
    case 'd':
      return 8;
    case 'i':
      return 4;
    case 'h':
      return 2;
    case 'b':
      return 1;
    default:
      FailRequirement("known field kind", __FILE__, __LINE__);
  }
}

bool IsLineLayout(char32_t code) {
  return code == '\t' || code == '\n' || code == '\r';
}

bool SkipField(Walker& walker, const Field& field, std::size_t count) {
  if (field.kind != 's') return walker.Skip(count, FieldSize(field.kind));
  for (std::size_t i = 0; i < count; ++i) {
    if (!walker.SkipString(field.limit)) return false;
  }
  return true;
}

}  // namespace

Status CheckLayout(std::string_view layout, std::int64_t fingerprint,
                   std::span<const std::uint8_t> bytes) {
  Walker walker(bytes);
  if (bytes.size() < 8) return Malformed("shorter than its fingerprint");
  if (static_cast<std::int64_t>(walker.Unsigned(8)) != fingerprint) {
    return Malformed("another type or version (fingerprint)");
  }
  std::size_t count = 0;
  for (std::size_t at = 0; at < layout.size();) {
    const Field field = NextField(layout, at);
    if (field.kind == ' ') continue;
    if (field.kind == 'N') {
      if (walker.left() < 4) return Malformed("truncated");
      const auto value = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(walker.Unsigned(4)));
      // Whatever is counted takes a byte at least.
      const auto most = field.limit == kNoLimit
                            ? static_cast<std::int64_t>(walker.left())
                            : field.limit;
      if (value < 0 || value > most) {
        return Malformed("count " + std::to_string(value) + ", at most " +
                         std::to_string(most));
      }
      count = static_cast<std::size_t>(value);
    } else if (!SkipField(walker, field, field.repeated ? count : 1)) {
      return Malformed("truncated, or a bad or too long string");
    }
  }
  if (walker.left() != 0) {
    return Malformed(std::to_string(walker.left()) + " bytes too many");
  }
  return Done{};
}

std::string CleanText(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view kReplacement = "\uFFFD";
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = ReadUtf8(text, at);
    const std::string_view kept =
        !character.valid ||
                (IsControl(character.code) && !IsLineLayout(character.code))
            ? kReplacement
            : text.substr(at, character.bytes);
    if (clean.size() + kept.size() > max_bytes) break;
    clean += kept;
    at += character.bytes;
  }
  return clean;
}

std::string CleanLine(std::string_view text, std::size_t max_bytes) {
  std::string line = CleanText(text, max_bytes);
  std::replace_if(line.begin(), line.end(), IsLineLayout, ' ');
  return line;
}

}  // namespace terra::bus
