#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bus/messages.h"

namespace terra::bus {

inline void CleanIn(std::string& text, TextForm form, std::size_t max_bytes) {
  text = form == TextForm::kLine ? CleanLine(text, max_bytes)
                                 : CleanText(text, max_bytes);
}

inline void CleanIn(std::vector<std::string>& texts, TextForm form,
                    std::size_t max_bytes) {
  for (std::string& text : texts) CleanIn(text, form, max_bytes);
}

/// Makes every text of a message one that may stand in it, wherever it came
/// from: a model, a file name, another process. Its .lcm file says how long
/// this project writes it (its text tag); others may write longer ones where
/// the layout allows it. Call it before a message is encoded.
template <typename Message>
void CleanTexts(Message& message) {
  MessageTraits<Message>::EachText(
      message, [](auto& texts, TextForm form, std::size_t max_bytes) {
        CleanIn(texts, form, max_bytes);
      });
}

}  // namespace terra::bus
