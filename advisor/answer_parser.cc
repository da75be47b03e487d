#include "advisor/answer_parser.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <string>
#include <utility>

#include "terrain/require.h"
#include "terrain/route_text.h"

namespace terra::advisor {
namespace {

constexpr std::size_t kMaxDigits = 9;

bool IsSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}
bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}
bool IsLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
char Lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

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

std::string WithoutSpace(std::string_view text) {
  std::string kept;
  std::copy_if(text.begin(), text.end(), std::back_inserter(kept), [](char c) {
    return !IsSpace(c);
  });
  return kept;
}

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && IsSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsSpace(text.back())) text.remove_suffix(1);
  return text;
}

/// Removes a code fence around the whole text, its language word included.
std::string_view WithoutFence(std::string_view text) {
  constexpr std::string_view kFence = "```";
  text = Trimmed(text);
  if (!text.starts_with(kFence)) {
    return text;
  }
  text.remove_prefix(kFence.size());
  const std::size_t line_end = text.find('\n');
  if (line_end != std::string_view::npos &&
      std::all_of(text.begin(), text.begin() + static_cast<long>(line_end),
                  [](char c) {
                    return IsLetter(c) || IsSpace(c);
                  })) {
    text.remove_prefix(line_end);
  }
  if (text.ends_with(kFence)) {
    text.remove_suffix(kFence.size());
  }
  return text;
}

/// Removes `*` and quotes, straight and typographic.
std::string WithoutMarks(std::string_view text) {
  constexpr std::array<std::string_view, 8> kMarks = {
      "*", "'", "\"", "`", "\u2018", "\u2019", "\u201c", "\u201d"};
  std::string kept;
  while (!text.empty()) {
    const auto mark =
        std::find_if(kMarks.begin(), kMarks.end(), [text](std::string_view m) {
          return text.starts_with(m);
        });
    if (mark == kMarks.end()) {
      kept += text.front();
    }
    text.remove_prefix(mark == kMarks.end() ? 1 : mark->size());
  }
  return kept;
}

bool IsCanonicalYes(std::string_view text) {
  std::string kept = WithoutMarks(WithoutSpace(WithoutFence(text)));
  if (kept.ends_with('.')) {
    kept.pop_back();
  }
  std::transform(kept.begin(), kept.end(), kept.begin(), Lower);
  return kept == "yes";
}

/// Returns where `word` (lower case) next stands alone, from `from` on.
std::size_t FindWord(std::string_view text, std::string_view word,
                     std::size_t from) {
  const auto same = [](char a, char b) {
    return Lower(a) == b;
  };
  for (;;) {
    const auto hit = std::search(text.begin() + static_cast<long>(from),
                                 text.end(), word.begin(), word.end(), same);
    if (hit == text.end()) {
      return std::string_view::npos;
    }
    const auto at = static_cast<std::size_t>(hit - text.begin());
    const std::size_t end = at + word.size();
    if ((at == 0 || !IsLetter(text[at - 1])) &&
        (end == text.size() || !IsLetter(text[end]))) {
      return at;
    }
    from = end;
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

/// Does a list begin here? `[` before a point's bracket or its own end; other
/// brackets only when a number follows too, because words use them as well.
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

/// Reads the list that begins at `at`; `at` moves past it.
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

/// Where lists are looked for: right after the first `No` that has one behind
/// it, else from the start.
std::size_t SearchFrom(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r\n.:,;*`\"'-";
  for (std::size_t no = FindWord(text, "no", 0); no != std::string_view::npos;
       no = FindWord(text, "no", no + 2)) {
    const std::size_t next = text.find_first_not_of(kBetween, no + 2);
    if (next != std::string_view::npos && ListBegins(text, next)) {
      return next;
    }
  }
  return 0;
}

std::vector<AnswerCandidate> ReadLists(std::string_view text,
                                       const AnswerRules& rules,
                                       bool& more_than_asked_for) {
  std::vector<AnswerCandidate> lists;
  for (std::size_t at = SearchFrom(text); at < text.size();) {
    if (!ListBegins(text, at)) {
      ++at;
    } else if (lists.size() == static_cast<std::size_t>(rules.max_candidates)) {
      more_than_asked_for = true;
      break;
    } else {
      lists.push_back(ReadList(text, rules.max_waypoints, at));
    }
  }
  return lists;
}

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

/// Reads the first row of at least two points that has no outer brackets. A
/// point that is cut or no pair of integers spoils its row.
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

/// Is the text, white space aside, what was asked for and nothing else?
bool HasExactForm(std::string_view text, AnswerStyle style,
                  const std::vector<AnswerCandidate>& lists) {
  const std::string start = style == AnswerStyle::kAdvice ? "No." : "";
  std::string with_semicolons = start;
  std::string with_lines = start;
  for (const AnswerCandidate& list : lists) {
    const std::string route = WithoutSpace(FormatRoute(list.waypoints));
    if (with_lines.size() > start.size()) with_semicolons += ';';
    with_semicolons += route;
    with_lines += route;
  }
  const std::string found = WithoutSpace(text);
  return found == with_semicolons || found == with_lines;
}

Answer Malformed(AnswerFault fault, std::size_t position) {
  Answer answer;
  answer.fault = fault;
  answer.position = position;
  return answer;
}

}  // namespace

std::string_view FaultName(AnswerFault fault) {
  constexpr std::array<std::string_view, 12> kNames = {
      "none",       "empty",           "too_long",       "yes_not_alone",
      "no_list",    "empty_list",      "not_an_integer", "number_too_long",
      "not_a_pair", "unexpected_text", "unclosed_list",  "too_many_waypoints"};
  return kNames.at(static_cast<std::size_t>(fault));
}

Answer ParseAnswer(std::string_view text, const AnswerRules& rules) {
  TERRA_REQUIRE(rules.max_candidates >= 1);
  if (text.size() > rules.max_bytes) {
    return Malformed(AnswerFault::kTooLong, rules.max_bytes);
  }
  if (Trimmed(text).empty()) {
    return Malformed(AnswerFault::kEmpty, 0);
  }
  Answer answer;
  if (rules.style == AnswerStyle::kAdvice && IsCanonicalYes(text)) {
    answer.kind = AnswerKind::kRetain;
    answer.fault = AnswerFault::kNone;
    answer.form =
        Trimmed(text) == "Yes" ? AnswerForm::kExact : AnswerForm::kTolerated;
    return answer;
  }
  const std::size_t yes = FindWord(text, "yes", 0);
  if (yes != std::string_view::npos) {
    return Malformed(AnswerFault::kYesNotAlone, yes);
  }
  bool more_than_asked_for = false;
  answer.candidates = ReadLists(text, rules, more_than_asked_for);
  if (answer.candidates.empty()) {
    if (auto row = ReadBareRow(text, rules.max_waypoints)) {
      answer.candidates.push_back(*std::move(row));
    } else {
      return Malformed(AnswerFault::kNoList, text.size());
    }
  }
  const AnswerCandidate& first = answer.candidates.front();
  if (first.fault != AnswerFault::kNone) {
    return Malformed(first.fault, first.position);
  }
  answer.kind = AnswerKind::kPropose;
  answer.fault = AnswerFault::kNone;
  answer.form =
      !more_than_asked_for && HasExactForm(text, rules.style, answer.candidates)
          ? AnswerForm::kExact
          : AnswerForm::kTolerated;
  return answer;
}

}  // namespace terra::advisor
