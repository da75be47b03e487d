#pragma once

#include <string>
#include <string_view>

namespace terra::advisor {

/// Returns an answer without what the model thought before it, which some
/// servers leave in the text between marks such as `<think>` and `</think>`.
///
/// Whatever stands before the last closing mark is no answer; its opening mark
/// may be missing, because some prompt templates end with it. An answer that
/// begins with an opening mark and has no closing one never began: empty.
std::string WithoutThinking(std::string_view text);

}  // namespace terra::advisor
