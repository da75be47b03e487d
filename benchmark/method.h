#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmark/case_result.h"
#include "benchmark/metrics.h"
#include "planner/coarse_lattice.h"
#include "terrain/cell.h"
#include "terrain/files/dataset.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// What a method works on.
struct MethodInput {
  const DatasetCase& dataset_case;
  const TerrainMap& map;
  std::int64_t map_id = 0;
  const planner::LatticePlan& baseline;  ///< Found.
  int repeat = 0;
};

/// What a method came up with; it is scored by the common verifier.
struct Attempt {
  AttemptKind kind = AttemptKind::kNoAnswer;
  AnswerStyle form = AnswerStyle::kNone;
  std::vector<Route> candidates;  ///< kPropose only; in the answer's order.
  std::string cause;              ///< Why no answer or malformed, for people.
  double t_prep = 0;              ///< Seconds, beyond the map's decoding.
  double t_llm = 0;
  double t_det = 0;  ///< Seconds, beyond baseline planning and verification.
  int tries = 0;
  std::int64_t tokens_in = 0;
  std::int64_t tokens_out = 0;
  double spend = 0;
  std::string request_hash;
  std::string model;        ///< As the reply named it.
  std::string recorded_at;  ///< UTC of a replayed call.
};

/// One way of planning. Threads: one call at a time per object.
class Method {
 public:
  virtual ~Method() = default;
  virtual Attempt Try(const MethodInput& input) = 0;
};

/// What a row of a table is: which method, and how it is counted.
struct MethodInfo {
  std::string method;   ///< "advisor", "direct", "coarse", ...
  std::string backend;  ///< "search", "openai", ...; empty where it has none.
  std::string title;    ///< As tables begin a row, without "+ gate".
  CountingRule rule;
  /// Baseline planning is part of its time.
  bool uses_baseline = true;
  /// A model answers (or somebody in its place): times of the model count.
  bool asks_model = false;
  /// An answer may have several candidates, which are counted apart.
  bool several_candidates = false;
  /// No real model answers: a simulation or scripted server.
  bool simulated = false;
};

/// Does a method deploy the baseline where its own route is no better, without
/// being given a gate? Nothing for a method that there is not.
std::optional<bool> FallsBack(std::string_view method);

/// Its title; "+ gate" where it was given one.
std::string TitleWithGate(const MethodInfo& info);

/// A method that can be made once per thread.
struct MethodChoice {
  MethodInfo info;
  std::function<Result<std::unique_ptr<Method>>()> make;
};

/// Returns the deterministic method, without a model: `advisor` with a refiner
/// as its backend, the references and the controls. `gate` gives a method
/// without fallback one ("+ gate", a row of its own).
/// Errors: no such method or backend; the message names those there are.
Result<MethodChoice> FindDeterministicMethod(std::string_view method,
                                             std::string_view backend,
                                             bool gate);

/// The backends of `advisor` that need no model, and the methods that take no
/// backend at all.
std::vector<std::string> RefinerNames();
std::vector<std::string> PlainMethodNames();

/// Verifies an attempt, decides the final route and fills the row but for the
/// baseline's and oracle's costs, which are given, and the times of others.
CaseResult ScoreAttempt(const MethodInput& input, const MethodInfo& info,
                        double oracle_cost, const Attempt& attempt);

}  // namespace terra::benchmark
