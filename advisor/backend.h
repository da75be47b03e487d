#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "advisor/answer_kind.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// What an advisor is asked about. Values and a map that stays alive.
struct AdviceTask {
  const TerrainMap& map;
  std::int64_t map_id = 0;
  std::int64_t request_id = 0;
  Cell start;
  Cell goal;
  Route baseline;  ///< Feasible on the map; from start to goal.
  double baseline_cost = 0;
};

/// One candidate of an answer.
struct Candidate {
  Route route;
  bool polished = false;
};

/// What came of it. Evidence fields stay empty where they have no meaning.
struct AdviceAnswer {
  AnswerKind kind = AnswerKind::kFailed;
  AnswerForm form = AnswerForm::kNone;
  std::vector<Candidate> candidates;  ///< In the answer's order; kPropose only.
  std::string model;
  /// A program on this machine stood in for the model: see ProviderOptions.
  bool simulated = false;
  std::string request_hash;
  std::string answer_text;
  std::string error;
  std::int64_t tokens_in = 0;
  std::int64_t tokens_out = 0;
  double spend_usd = 0;
  std::int64_t t_prep_us = 0;
  std::int64_t t_llm_us = 0;
};

/// What a backend tells of itself in its process's heartbeat.
struct BackendFigures {
  std::string state;  ///< Empty = nothing out of the ordinary.
  std::vector<std::pair<std::string, std::int64_t>> counters;
};

/// A way of finding better routes. May take long and may fail.
/// Threads: Advise is called from one worker thread; it returns early, with any
///          answer, when `stop` is requested. figures may be called from
///          another thread at any time, the names always.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string name() const = 0;    ///< "search", "openai", ...
  virtual std::string method() const = 0;  ///< "refiner", "advisor", ...
  virtual AdviceAnswer Advise(const AdviceTask& task, std::stop_token stop) = 0;
  virtual BackendFigures figures() const { return {}; }
  /// What has to be said once, at the start; empty = nothing.
  virtual std::string notice() const { return ""; }
  /// How long an answer takes, before the first one has come: a moving robot is
  /// given a proposal from so far ahead.
  virtual double usual_seconds() const { return 0.5; }
};

}  // namespace terra::advisor
