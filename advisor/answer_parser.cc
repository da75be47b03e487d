#include "advisor/answer_parser.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "advisor/ascii.h"
#include "terrain/require.h"
#include "terrain/route_text.h"
#include "terrain/utf8.h"

namespace terra::advisor {
namespace {

/// Every space that Unicode knows besides ASCII's: White_Space, and those of no
/// width, byte order marks among them.
bool IsUnicodeSpace(char32_t code) {
  return code == 0x85 || code == 0xA0 || code == 0x1680 ||
         (code >= 0x2000 && code <= 0x200B) || code == 0x2028 ||
         code == 0x2029 || code == 0x202F || code == 0x205F || code == 0x2060 ||
         code == 0x3000 || code == 0xFEFF;
}

/// Writes blanks over each of them, as many as it has bytes, so that positions
/// stay.
std::string WithAsciiSpaces(std::string_view text) {
  std::string plain(text);
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = ReadUtf8(text, at);
    if (IsUnicodeSpace(character.code)) {
      plain.replace(at, character.bytes, character.bytes, ' ');
    }
    at += character.bytes;
  }
  return plain;
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

bool IsBlankAnswer(std::string_view text) {
  return Trimmed(WithAsciiSpaces(text)).empty();
}

Answer ParseAnswer(std::string_view answered, const AnswerRules& rules) {
  TERRA_REQUIRE(rules.max_candidates >= 1);
  if (answered.size() > rules.max_bytes) {
    return Malformed(AnswerFault::kTooLong, rules.max_bytes);
  }
  const std::string text = WithAsciiSpaces(answered);
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
