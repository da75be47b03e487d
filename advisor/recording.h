#pragma once

#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_set>

#include "advisor/llm_client.h"
#include "terrain/result.h"

namespace terra::advisor {

/// One call as a recording keeps it: JSON lines, version 1.
///
/// Fields: schema, request_hash, repeat, case_id, method, prompt_id, provider,
/// endpoint_class, model_requested, model_returned, response_id, utc, settings,
/// prompt_text, images (SHA-256 of each PNG), status, answer_text, error,
/// reply_body, tokens_in, tokens_out, tokens_thinking, spend_usd (or null),
/// tries, t_llm_s (null for files and batches). Never a key, nor a header that
/// carries one.
struct RecordedCall {
  std::string request_hash;
  int repeat = 0;
  LlmIdentity identity;
  LlmReply reply;  ///< reply.recorded_at is the time of the call.
};

/// Writes a line, with its line end.
std::string FormatRecord(const LlmIdentity& identity, const LlmRequest& request,
                         const LlmReply& reply, const std::string& utc);

/// Puts a reply into the line of a call that has none yet: FormatRecord of an
/// empty reply, as a batch keeps its open requests. Errors: no such line.
Result<std::string> AnswerRecord(std::string_view open_line,
                                 const LlmReply& reply, const std::string& utc);

/// Reads a line. Errors say what is missing.
Result<RecordedCall> ParseRecord(std::string_view line);

/// What a recording files a call under: hash and repeat.
std::string RecordKey(const std::string& request_hash, int repeat);

/// Takes a call and where it stands ("FILE:LINE: ").
using TakeCall = std::function<Status(RecordedCall, const std::string&)>;

/// Calls `take` with each call of a recording. A damaged last line (a run that
/// was killed) is left out. Errors: no such file; a damaged line, with file and
/// number; those of `take`.
Status ForEachRecordedCall(const std::string& path, const TakeCall& take);

/// The keys of all calls that a recording holds; none without the file.
/// Errors: as ForEachRecordedCall.
Result<std::unordered_set<std::string>> ReadRecordKeys(const std::string& path);

/// Opens a recording to be added to. What a writer that was killed left of a
/// last line is cut off. Errors: cannot be written.
Result<std::ofstream> OpenRecording(const std::string& path);

/// Writes the pictures of a request into a folder, under their hash.
/// Errors: one cannot be written.
Status KeepImages(const LlmRequest& request, const std::string& folder);

}  // namespace terra::advisor
