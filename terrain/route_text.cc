#include "terrain/route_text.h"

#include <cctype>
#include <charconv>
#include <optional>

namespace terra {
namespace {

constexpr std::size_t kMaxDigits = 9;

// A cursor over the text; every Take skips leading white space.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  bool Take(char wanted) {
    SkipSpace();
    if (at_ < text_.size() && text_[at_] == wanted) {
      ++at_;
      return true;
    }
    return false;
  }

  std::optional<int> TakeInteger() {
    SkipSpace();
    const std::size_t sign = at_ < text_.size() && text_[at_] == '-' ? 1 : 0;
    std::size_t end = at_ + sign;
    while (end < text_.size() && text_[end] >= '0' && text_[end] <= '9') ++end;
    const std::size_t digits = end - at_ - sign;
    if (digits == 0 || digits > kMaxDigits) {
      return std::nullopt;
    }
    int value = 0;
    std::from_chars(text_.data() + at_, text_.data() + end, value);
    at_ = end;
    return value;
  }

  bool AtEnd() {
    SkipSpace();
    return at_ == text_.size();
  }

  Error Expected(std::string what) {
    SkipSpace();
    std::string found =
        at_ < text_.size() ? "'" + std::string(1, text_[at_]) + "'" : "the end";
    return Error{ErrorCode::kInvalid,
                 "route: expected " + std::move(what) + " at position " +
                     std::to_string(at_ + 1) + ", found " + found};
  }

 private:
  void SkipSpace() {
    while (at_ < text_.size() &&
           std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
      ++at_;
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string FormatRoute(const Route& route) {
  std::string text = "[";
  for (const Cell& cell : route) {
    if (text.size() > 1) {
      text += ", ";
    }
    text += ToString(cell);
  }
  return text + "]";
}

Result<Route> ParseRoute(std::string_view text, std::size_t max_waypoints) {
  Scanner scan(text);
  Route route;
  if (!scan.Take('[')) return scan.Expected("'['");
  if (!scan.Take(']')) {
    do {
      if (route.size() == max_waypoints) {
        return Error{
            ErrorCode::kUnsupported,
            "route: more than " + std::to_string(max_waypoints) + " waypoints"};
      }
      if (!scan.Take('(')) return scan.Expected("'('");
      const auto x = scan.TakeInteger();
      if (!x) return scan.Expected("an integer of at most 9 digits");
      if (!scan.Take(',')) return scan.Expected("','");
      const auto y = scan.TakeInteger();
      if (!y) return scan.Expected("an integer of at most 9 digits");
      if (!scan.Take(')')) return scan.Expected("')'");
      route.push_back(Cell{*x, *y});
    } while (scan.Take(','));
    if (!scan.Take(']')) return scan.Expected("',' or ']'");
  }
  if (!scan.AtEnd()) return scan.Expected("nothing more");
  return route;
}

Result<Cell> ParsePoint(std::string_view text) {
  Scanner scan(text);
  const auto x = scan.TakeInteger();
  const bool comma = x && scan.Take(',');
  const auto y = comma ? scan.TakeInteger() : std::nullopt;
  if (!y || !scan.AtEnd()) {
    return Error{ErrorCode::kInvalid,
                 "'" + std::string(text) + "' is no point; write X,Y"};
  }
  return Cell{*x, *y};
}

}  // namespace terra
