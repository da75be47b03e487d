#include "advisor/coordinate_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "advisor/ascii.h"

namespace terra::advisor {
namespace {

constexpr std::size_t kMaxDigits = 9;

/// Returns the closing bracket of an opening one, 0 for any other character.
char CloserOf(char c) {
  switch (c) {
    case '(':
      return ')';
    case '[':
      return ']';
    case '{':
      return '}';
    default:
      return 0;
  }
}

/// A cursor over the answer that remembers its first fault.
class Reader {
 public:
  Reader(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  std::size_t at() const { return at_; }
  AnswerFault fault() const { return fault_; }

  char Peek() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool AtEnd() { return Peek() == '\0' && at_ >= text_.size(); }
  bool Take(char wanted) {
    const bool taken = !AtEnd() && Peek() == wanted;
    if (taken) ++at_;
    return taken;
  }
  bool Fail(AnswerFault fault) {
    fault_ = AtEnd() ? AnswerFault::kUnclosedList : fault;
    return false;
  }

  bool Integer(int& value) {
    Peek();
    std::size_t end = at_;
    if (end < text_.size() && text_[end] == '-') ++end;
    const std::size_t first_digit = end;
    while (end < text_.size() && IsDigit(text_[end])) ++end;
    if (end == first_digit) return Fail(AnswerFault::kNotAnInteger);
    if (end - first_digit > kMaxDigits) {
      return Fail(AnswerFault::kNumberTooLong);
    }
    const std::size_t begin = std::exchange(at_, end);
    if (end < text_.size() &&
        (text_[end] == '.' || text_[end] == '_' || IsLetter(text_[end]))) {
      return Fail(AnswerFault::kNotAnInteger);
    }
    std::from_chars(text_.data() + begin, text_.data() + end, value);
    return true;
  }

  /// Reads `(x, y)` in any brackets.
  bool Point(Cell& cell) {
    const char closer = CloserOf(Peek());
    if (closer == 0) return Fail(AnswerFault::kUnexpectedText);
    ++at_;
    if (!Integer(cell.x)) return false;
    if (!Take(',')) return Fail(AnswerFault::kNotAPair);
    if (!Integer(cell.y)) return false;
    return Take(closer) || Fail(AnswerFault::kNotAPair);
  }

 private:
  std::string_view text_;
  std::size_t at_;
  AnswerFault fault_ = AnswerFault::kNone;
};

/// Reads the row of points that begins at `at`, without outer brackets; `at`
/// moves past what was read.
AnswerCandidate ReadRow(std::string_view text, std::size_t max_waypoints,
                        std::size_t& at) {
  AnswerCandidate row;
  Reader reader(text, at);
  while (CloserOf(reader.Peek()) != 0 && reader.fault() == AnswerFault::kNone) {
    Cell cell;
    if (row.waypoints.size() == max_waypoints) {
      reader.Fail(AnswerFault::kTooManyWaypoints);
    } else if (reader.Point(cell)) {
      row.waypoints.push_back(cell);
      reader.Take(',');
    }
  }
  row.fault = reader.fault();
  row.position = at = reader.at();
  return row;
}

}  // namespace

std::string_view FaultName(AnswerFault fault) {
  constexpr std::array<std::string_view, 12> kNames = {
      "none",       "empty",           "too_long",       "yes_not_alone",
      "no_list",    "empty_list",      "not_an_integer", "number_too_long",
      "not_a_pair", "unexpected_text", "unclosed_list",  "too_many_waypoints"};
  return kNames.at(static_cast<std::size_t>(fault));
}

bool ListBegins(std::string_view text, std::size_t at) {
  const char opener = text[at];
  if (CloserOf(opener) == 0) {
    return false;
  }
  Reader reader(text, at + 1);
  const char next = reader.Peek();
  if (opener == '[') {
    return next == '(' || next == '[' || next == '{' || next == ']';
  }
  if (CloserOf(next) == 0) {
    return false;
  }
  Reader inner(text, reader.at() + 1);
  return IsDigit(inner.Peek()) || inner.Peek() == '-';
}

AnswerCandidate ReadList(std::string_view text, std::size_t max_waypoints,
                         std::size_t& at) {
  AnswerCandidate list;
  const char closer = CloserOf(text[at]);
  Reader reader(text, at + 1);
  while (reader.fault() == AnswerFault::kNone && !reader.Take(closer)) {
    Cell cell;
    if (list.waypoints.size() == max_waypoints) {
      reader.Fail(AnswerFault::kTooManyWaypoints);
    } else if (reader.Point(cell)) {
      list.waypoints.push_back(cell);
      reader.Take(',');
    }
  }
  list.fault = reader.fault();
  if (list.fault == AnswerFault::kNone && list.waypoints.empty()) {
    list.fault = AnswerFault::kEmptyList;
  }
  if (list.fault != AnswerFault::kNone) {
    list.waypoints.clear();
  }
  list.position = list.fault == AnswerFault::kEmptyList ? at : reader.at();
  at = reader.at();
  return list;
}

std::optional<AnswerCandidate> ReadBareRow(std::string_view text,
                                           std::size_t max_waypoints) {
  std::size_t at = 0;
  while ((at = text.find_first_of("([", at)) != std::string_view::npos) {
    std::size_t end = at;
    AnswerCandidate row = ReadRow(text, max_waypoints, end);
    if (row.waypoints.size() >= 2) {
      if (row.fault != AnswerFault::kNone) {
        row.waypoints.clear();
      }
      return row;
    }
    at = std::max(at + 1, end);
  }
  return std::nullopt;
}

}  // namespace terra::advisor
