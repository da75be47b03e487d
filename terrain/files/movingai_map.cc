// Source: Sturtevant 2012, "Benchmarks for Grid-Based Pathfinding" (IEEE TCIAIG
// 4:2). Header lines `type octile`, `height H`, `width W`, `map`, then H rows
// of W characters.
#include <optional>

#include "terrain/builtin_legends.h"
#include "terrain/files/csv.h"
#include "terrain/files/image.h"
#include "terrain/files/map_formats.h"

namespace terra {
namespace {

// Takes lines off a text, without LF and CR, and counts them.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name)
      : rest_(text), name_(name) {}

  std::optional<std::string_view> Next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return line;
  }

  Error Bad(const std::string& what) const {
    return Error{ErrorCode::kInvalid,
                 name_ + ":" + std::to_string(number_) + ": " + what};
  }

 private:
  std::string_view rest_;
  const std::string& name_;
  int number_ = 0;
};

std::string_view Trim(std::string_view text) {
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  return text;
}

// What stands behind the first word of a line.
std::string_view FieldOf(std::string_view line) {
  line.remove_prefix(line.find(' '));
  while (line.starts_with(' ')) line.remove_prefix(1);
  return line;
}

struct Header {
  int width = 0;
  int height = 0;
};

// Reads up to the line `map`; height and width in any order.
Result<Header> ReadHeader(Lines& lines) {
  Header header;
  while (const std::optional<std::string_view> raw = lines.Next()) {
    const std::string_view line = Trim(*raw);
    if (line == "map") {
      if (header.width > 0 && header.height > 0) return header;
      return lines.Bad("'height H' and 'width W' must stand before 'map'");
    }
    if (line.empty()) continue;
    if (line.starts_with("type ")) {
      if (FieldOf(line) == "octile") continue;
      return lines.Bad("only maps of type octile are read");
    }
    int* side = line.starts_with("height ")  ? &header.height
                : line.starts_with("width ") ? &header.width
                                             : nullptr;
    if (side == nullptr) {
      return lines.Bad(
          "expected 'type', 'height H', 'width W' or 'map' of a MovingAI map");
    }
    const Result<int> value = ParseInteger(FieldOf(line));
    if (!value.ok() || *value < 1) {
      return lines.Bad("not a size: " + std::string(line.substr(0, 40)));
    }
    if (*side != 0) return lines.Bad("this size comes twice");
    *side = *value;
  }
  return lines.Bad("the file ends before the line 'map'");
}

// Returns the id of a map character, or -1.
int IdOf(char c) {
  switch (c) {
    case '.':
    case 'G':
      return kMovingAiGround;
    case 'S':
      return kMovingAiSwamp;
    case 'W':
      return kMovingAiWater;
    case 'T':
      return kMovingAiTrees;
    case '@':
    case 'O':
      return kMovingAiOut;
    default:
      return -1;
  }
}

Status ReadRow(const Lines& lines, std::string_view line, int y,
               ByteRaster& ids) {
  const auto width = static_cast<std::size_t>(ids.cols());
  if (line.size() != width) {
    return lines.Bad("map row " + std::to_string(y) + " has " +
                     std::to_string(line.size()) + " characters, width is " +
                     std::to_string(width));
  }
  for (int x = 0; x < ids.cols(); ++x) {
    const int id = IdOf(line[static_cast<std::size_t>(x)]);
    if (id < 0) {
      return lines.Bad("column " + std::to_string(x + 1) +
                       ": not a MovingAI terrain; known are . G S W T @ O");
    }
    ids(y, x) = static_cast<std::uint8_t>(id);
  }
  return Done{};
}

}  // namespace

Result<ByteRaster> ParseMovingAiMap(std::string_view text,
                                    const std::string& name) {
  Lines lines(text, name);
  const Result<Header> header = ReadHeader(lines);
  if (!header.ok()) return header.error();
  const Status size = CheckMapSize(header->width, header->height, name);
  if (!size.ok()) return size.error();
  if (text.size() < static_cast<std::size_t>(header->width) *
                        static_cast<std::size_t>(header->height)) {
    return Error{ErrorCode::kInvalid,
                 name + ": truncated: " + std::to_string(header->width) +
                     " x " + std::to_string(header->height) +
                     " cells do not fit into the file"};
  }
  ByteRaster ids(header->height, header->width);
  for (int y = 0; y < header->height; ++y) {
    const std::optional<std::string_view> line = lines.Next();
    if (!line) {
      return lines.Bad("the file ends after " + std::to_string(y) + " of " +
                       std::to_string(header->height) + " map rows");
    }
    const Status row = ReadRow(lines, *line, y, ids);
    if (!row.ok()) return row.error();
  }
  while (const std::optional<std::string_view> line = lines.Next()) {
    if (!Trim(*line).empty()) {
      return lines.Bad("text after the last map row");
    }
  }
  return ids;
}

}  // namespace terra
