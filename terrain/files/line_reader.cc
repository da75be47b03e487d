#include "terrain/files/line_reader.h"

#include <ios>
#include <streambuf>

#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr int kEnd = std::char_traits<char>::eof();

}  // namespace

Result<LineReader> LineReader::Open(const std::string& path) {
  Result<std::ifstream> file = OpenToRead(path);
  if (!file.ok()) return file.error();
  return LineReader(path, *std::move(file));
}

Result<bool> LineReader::Next() {
  line_.clear();
  std::streambuf& bytes = *file_.rdbuf();
  try {
    for (int byte = bytes.sbumpc(); byte != kEnd; byte = bytes.sbumpc()) {
      if (line_.size() == kMaxLineBytes) {
        return Error{ErrorCode::kUnsupported,
                     path_ + ":" + std::to_string(place_.line) +
                         ": a line of more than " +
                         std::to_string(kMaxLineBytes) + " bytes"};
      }
      line_ += static_cast<char>(byte);
      if (byte == '\n') break;
    }
  } catch (const std::ios_base::failure&) {
    return Error{ErrorCode::kUnavailable, path_ + ": cannot be read"};
  }
  if (line_.empty()) return false;
  place_.offset += static_cast<std::int64_t>(line_.size());
  ++place_.line;
  return true;
}

void LineReader::GoTo(Place place) {
  place_ = place;
  file_.clear();
  file_.seekg(place.offset);
}

}  // namespace terra
