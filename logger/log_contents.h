#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "bus/messages.h"
#include "logger/log_reader.h"
#include "logger/log_seal.h"
#include "logger/logged_maps.h"

namespace terra::logger {

/// A message and its place in the log.
template <typename T>
struct Logged {
  std::int64_t index = 0;    ///< Of the event, from 0.
  std::int64_t time_us = 0;  ///< Of the event.
  T message;
};

/// What names an advice in its verdict. Several may bear one name: advice is
/// open to everybody, and the gate judges each content once.
struct AdviceName {
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  std::int64_t session = 0;
  std::int64_t attempt = 0;
  std::int32_t candidate = 0;

  friend auto operator<=>(const AdviceName&, const AdviceName&) = default;
};

/// What names a baseline: two planners may find the same route.
struct BaselineName {
  std::int64_t digest = 0;
  std::int64_t session = 0;

  friend auto operator<=>(const BaselineName&, const BaselineName&) = default;
};

/// Two messages under one name that say different things, a message that is not
/// what its own digest says, or a decision that cannot be read.
struct Conflict {
  std::int64_t index = 0;
  std::string what;
  bool of_gate = false;  ///< Else another process may have said so.
};

/// What a log says, by name: repetitions are one thing said often.
///
/// Bounds: memory of the log's distinct messages. Malformed messages are left
/// out, and counted.
class LogContents {
 public:
  using Decided = std::variant<terra_msg::verdict_t, terra_msg::deployed_t>;

  /// Reads a log of one robot to its end.
  static LogContents Load(LogReader& reader, SealChecker& seals);

  /// Returns the baseline of a planner's session; of any when that is 0 or is
  /// not in the log. Null when there is none of this digest.
  const Logged<terra_msg::baseline_t>* FindBaseline(std::int64_t digest,
                                                    std::int64_t session) const;

  /// Returns the DEPLOYED that a gate's session had under this route_seq; null
  /// when it is not in the log.
  const terra_msg::deployed_t* FindRoute(std::int64_t session,
                                         std::int64_t route_seq) const;
  /// Returns a decision by its number; null when it is not in the log.
  const Logged<Decided>* FindDecision(std::int64_t session,
                                      std::int64_t number) const;
  /// Returns an advice of the content of the message with this digest (XXH3-64
  /// of its bytes); null when it was not heard, or has more than kMaxVariants
  /// of its name before it.
  const terra_msg::advice_t* FindAdvice(std::int64_t digest) const;

  /// The journal of one gate by number of the step; empty when there is none.
  using Steps = std::map<std::int64_t, Logged<terra_msg::gate_step_t>>;
  const Steps& StepsOf(std::int64_t session) const;
  /// Returns whether another session of the gate was heard before this one.
  bool HasGateBefore(std::int64_t session) const;
  /// All sessions of the gate.
  std::vector<std::int64_t> GateSessions() const;

  /// Events before this one are the state from before the log: the snapshot
  /// that a part begins with.
  std::int64_t state_end = 0;
  LoggedMaps maps;
  /// By request_id; a cancelled request is in both.
  std::map<std::int64_t, Logged<terra_msg::plan_request_t>> requests;
  std::map<std::int64_t, Logged<terra_msg::plan_request_t>> cancels;
  /// Those that have a route by name, and the others in order.
  std::map<BaselineName, Logged<terra_msg::baseline_t>> baselines;
  std::vector<Logged<terra_msg::baseline_t>> other_baselines;
  /// The first kMaxVariants contents under each name; an honest advisor has
  /// only one.
  static constexpr std::size_t kMaxVariants = 4;
  std::map<AdviceName, std::vector<Logged<terra_msg::advice_t>>> advice;
  /// By session of the gate, then by number of the decision.
  std::map<std::int64_t, std::map<std::int64_t, Logged<Decided>>> decisions;
  /// By session of the gate.
  std::map<std::int64_t, Steps> steps;
  /// By session of the sender.
  std::map<std::int64_t, Logged<terra_msg::config_t>> configs;
  std::vector<Logged<terra_msg::status_t>> statuses;

  /// The decisions of all gates in the order of the log. The maps above are in
  /// that of the sessions, which are random numbers.
  std::vector<const Logged<Decided>*> DecisionsInOrder() const;

  std::vector<Conflict> conflicts;
  std::int64_t malformed = 0;
  std::int64_t events = 0;
  std::int64_t first_us = 0;
  std::int64_t last_us = 0;

 private:
  void Take(const LogEvent& event, std::int64_t index);
  std::int64_t FirstIndexOf(std::int64_t session) const;
  void CheckNumber(std::int64_t decision, std::int64_t index);
  void Compare();
  void CompareWithRequest(const Logged<terra_msg::baseline_t>& said);
  void CompareWithJournal(const terra_msg::gate_step_t& step);
  void TakeBaselineOf(const Logged<terra_msg::gate_step_t>& said);
  template <typename T>
  void TakeAs(const LogEvent& event, std::int64_t index);
  template <typename Key, typename T, typename Other>
  void Keep(std::map<Key, Logged<T>>& kept, const Key& key,
            const Logged<Other>& said, const char* what);

  void Place(const Logged<terra_msg::map_header_t>& said);
  void Place(const Logged<terra_msg::map_tile_t>& said);
  void Place(const Logged<terra_msg::plan_request_t>& said);
  void Place(const Logged<terra_msg::baseline_t>& said);
  void Place(const Logged<terra_msg::advice_t>& said, std::int64_t digest);
  void Place(const Logged<terra_msg::pose_t>&) {}  // Only heard_ has it.
  void Place(const Logged<terra_msg::verdict_t>& said);
  void Place(const Logged<terra_msg::deployed_t>& said);
  void Place(const Logged<terra_msg::gate_step_t>& said);
  void Place(const Logged<terra_msg::config_t>& said);
  void Place(const Logged<terra_msg::status_t>& said);

  // Who sent a message, and its place among his of that channel.
  struct MessageName {
    bus::Channel channel;
    std::int64_t session = 0;
    std::int64_t seq = 0;

    friend auto operator<=>(const MessageName&, const MessageName&) = default;
  };
  struct AdvicePlace {
    AdviceName name;
    std::size_t variant = 0;
  };

  // What the gate takes off the deployed bus: the digests of the first
  // kMaxVariants messages of each name.
  std::map<MessageName, std::vector<std::int64_t>> heard_;
  std::map<std::int64_t, AdvicePlace> advice_by_digest_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t>
      decision_of_route_;  // (session, route_seq)
};

/// Returns the bytes of a message without what each sending of it changes:
/// utime, session, seq, and of a verdict the time it took.
std::vector<std::uint8_t> Essence(terra_msg::baseline_t message);
std::vector<std::uint8_t> Essence(terra_msg::advice_t message);
std::vector<std::uint8_t> Essence(terra_msg::plan_request_t message);
std::vector<std::uint8_t> Essence(terra_msg::config_t message);
std::vector<std::uint8_t> Essence(terra_msg::deployed_t message);
std::vector<std::uint8_t> Essence(terra_msg::verdict_t message);
std::vector<std::uint8_t> Essence(terra_msg::gate_step_t message);
std::vector<std::uint8_t> Essence(const LogContents::Decided& message);

/// Says a decision in a few words, for a finding.
std::string InWords(const LogContents::Decided& decided);

}  // namespace terra::logger
