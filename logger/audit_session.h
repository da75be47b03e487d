#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "logger/audit.h"
#include "logger/log_contents.h"
#include "verifier/gate.h"

namespace terra::logger {

/// Plays the inputs of one session of the gate to a gate of its own, in the
/// order that the decisions tell.
/// Threads: one.
class SessionAudit {
 public:
  SessionAudit(LogContents& contents, std::int64_t session, Audit& audit);

  void Run();

 private:
  using Decided = LogContents::Decided;

  void Check(const Logged<Decided>& logged);
  bool Anchor(const terra_msg::deployed_t& deployed);
  std::string PlayState(const terra_msg::deployed_t& deployed);
  void PlayReplaced(const terra_msg::deployed_t& deployed);
  void Compare(const Decided& logged);
  void Start();

  // Play what a decision was made from. Each returns why it cannot, or "".
  std::string Cause(const Logged<Decided>& logged);
  std::string CauseOf(const terra_msg::verdict_t& verdict, std::int64_t index);
  std::string CauseOf(const terra_msg::deployed_t& deployed);
  std::string PlayAdvice(const terra_msg::verdict_t& verdict);
  std::string PlayRequest(std::int64_t request_id);
  std::string PlayCancel(std::int64_t request_id);
  std::string PlayMap(std::int64_t map_id);
  std::string PlayBaseline(std::int64_t digest);
  std::string PlayNoRoute(std::int64_t request_id);
  std::string ReplaceMap(std::int64_t map_id);
  std::string ReplaceBaseline(std::int64_t digest);
  void PlayPoses(std::int64_t before_index);
  template <typename Event>
  void Play(const Event& event);

  void Fail(Finding::Kind kind, std::int64_t decision, std::string what);

  LogContents& contents_;
  const std::int64_t session_;
  Audit& audit_;
  verifier::GateOptions options_;

  std::unique_ptr<verifier::Gate> gate_;  // Null = the state is not known.
  std::deque<verifier::Decision> decided_;
  // The log's numbers are this far ahead of the gate's own.
  std::int64_t decision_offset_ = 0;
  std::int64_t route_seq_offset_ = 0;
  std::int64_t map_id_ = 0;
  std::int64_t baseline_digest_ = 0;
  std::size_t poses_played_ = 0;
};

}  // namespace terra::logger
