#include "advisor/thinking.h"

#include <algorithm>
#include <array>

#include "advisor/ascii.h"

namespace terra::advisor {
namespace {

struct Marks {
  std::string_view open;
  std::string_view close;
};

// As models' chat templates have them; in lower case.
constexpr std::array<Marks, 9> kMarks = {{
    {"<think>", "</think>"},
    {"<thinking>", "</thinking>"},
    {"<thought>", "</thought>"},
    {"<reasoning>", "</reasoning>"},
    {"[think]", "[/think]"},
    {"<seed:think>", "</seed:think>"},
    {"\u25c1think\u25b7", "\u25c1/think\u25b7"},
    {"<|start_thinking|>", "<|end_thinking|>"},
    {"<|channel|>analysis<|message|>", "<|channel|>final<|message|>"},
}};

}  // namespace

std::string WithoutThinking(std::string_view text) {
  const std::string lowered = Lowered(text);  // As long as the text.
  std::size_t begin = 0;
  for (const Marks& marks : kMarks) {
    const std::size_t close = lowered.rfind(marks.close);
    if (close != std::string::npos) {
      begin = std::max(begin, close + marks.close.size());
    }
  }
  const auto first =
      std::find_if_not(lowered.begin() + static_cast<std::ptrdiff_t>(begin),
                       lowered.end(), IsSpace);
  const std::string_view rest(first, lowered.end());
  const bool only_thinking =
      std::any_of(kMarks.begin(), kMarks.end(), [rest](const Marks& marks) {
        return rest.starts_with(marks.open);
      });
  return only_thinking ? "" : std::string(text.substr(begin));
}

}  // namespace terra::advisor
