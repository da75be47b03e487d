#pragma once

#include <array>

namespace terra {

/// The environment variables in which providers' API keys come.
inline constexpr std::array<const char*, 4> kApiKeyVariables = {
    "ANTHROPIC_API_KEY", "GEMINI_API_KEY", "OPENAI_API_KEY",
    "TERRA_CHAT_API_KEY"};

/// Overwrites the values of all of them where they lie, so that they can be
/// read neither from this process's memory nor from /proc/PID/environ. The
/// variables stay, empty. What wants a key must have copied it.
/// Threads: none may read or set these variables meanwhile.
void ForgetApiKeys();

/// This process writes no core file.
void LeaveNoCore();

/// Other processes of the same user may not look into this one's memory.
void ForbidTracing();

}  // namespace terra
