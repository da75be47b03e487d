#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bus/channels.h"
#include "bus/messages.h"
#include "terrain/legend.h"

/// Which texts each message carries, and how long this project writes them.
/// Others may write longer ones where the layout allows it.
namespace terra::bus {

/// Returns how many texts, or lists of texts, a layout has.
constexpr std::size_t CountTexts(std::string_view layout) {
  std::size_t count = 0;
  for (const char kind : layout) count += kind == 's' ? 1 : 0;
  return count;
}

/// Names and errors: one line of at most so many bytes.
struct NameLine {
  std::string& text;
  std::size_t max_bytes = kMaxNameBytes;

  void Clean() const { text = CleanLine(text, max_bytes); }
};

/// A list of names.
struct NameList {
  std::vector<std::string>& texts;
  std::size_t max_bytes = kMaxNameBytes;

  void Clean() const {
    for (std::string& text : texts) text = CleanLine(text, max_bytes);
  }
};

/// Answers and configurations, which may have many lines.
struct TextBlock {
  std::string& text;
  std::size_t max_bytes;

  void Clean() const { text = CleanText(text, max_bytes); }
};

/// Cleans the texts of a message, which must be all that its layout has.
template <typename Message, typename... Texts>
void CleanAll(const Texts&... texts) {
  static_assert(sizeof...(Texts) == CountTexts(MessageTraits<Message>::kLayout),
                "every text of a message is cleaned");
  (texts.Clean(), ...);
}

/// Makes every text of a message one that may stand in it, wherever it came
/// from: a model, a file name, another process. What sends or writes a message
/// calls this before it encodes.
template <typename Message>
void CleanTexts(Message& message) {
  CleanAll<Message>();
  static_cast<void>(message);
}
inline void CleanTexts(terra_msg::map_header_t& message) {
  CleanAll<terra_msg::map_header_t>(
      NameList{message.terrain_name, Legend::kMaxNameBytes});
}
inline void CleanTexts(terra_msg::baseline_t& message) {
  CleanAll<terra_msg::baseline_t>(NameLine{message.planner});
}
inline void CleanTexts(terra_msg::advice_t& message) {
  CleanAll<terra_msg::advice_t>(
      NameLine{message.advisor}, NameLine{message.method},
      NameLine{message.backend}, NameLine{message.model},
      NameLine{message.request_hash},
      TextBlock{message.answer_text, kMaxAnswerBytes},
      NameLine{message.advice_error, kMaxErrorBytes});
}
inline void CleanTexts(terra_msg::verdict_t& message) {
  CleanAll<terra_msg::verdict_t>(NameLine{message.advisor});
}
inline void CleanTexts(terra_msg::deployed_t& message) {
  CleanAll<terra_msg::deployed_t>(NameLine{message.source});
}
inline void CleanTexts(terra_msg::status_t& message) {
  CleanAll<terra_msg::status_t>(
      NameLine{message.status_name}, NameLine{message.host},
      NameLine{message.state, kMaxErrorBytes}, NameLine{message.build_id},
      NameList{message.counter_name},
      NameLine{message.last_error, kMaxErrorBytes});
}
inline void CleanTexts(terra_msg::config_t& message) {
  CleanAll<terra_msg::config_t>(
      NameLine{message.config_name}, NameLine{message.build_id},
      TextBlock{message.config_text, kMaxConfigBytes});
}
inline void CleanTexts(terra_msg::log_mark_t& message) {
  CleanAll<terra_msg::log_mark_t>(
      TextBlock{message.mark_text, kMaxConfigBytes});
}

}  // namespace terra::bus
