#include "tests/logger/relevance.h"

#include <algorithm>
#include <optional>
#include <span>

#include "bus/map_exchange.h"
#include "logger/logged_maps.h"
#include "terrain/driven_route.h"
#include "terrain/map_tiles.h"
#include "verifier/verify.h"

namespace terra::logger {
namespace {

using bus::Channel;

// ---- What decides nothing by itself ----

// The invariant leaves out utime, session, seq and T_det. An input's session
// counts where the gate reads it, and stays here.
void Blank(terra_msg::verdict_t& message) {
  message.session = 0;
  message.t_det_us = 0;
}
void Blank(terra_msg::deployed_t& message) {
  message.session = 0;
}
// Who asked, and for which map he believes to ask, is the planner's business.
void Blank(terra_msg::plan_request_t& message) {
  message.session = 0;
  message.map_id = 0;
}
// What an advisor and a planner tell about their work.
void Blank(terra_msg::advice_t& message) {
  message.method.clear();
  message.backend.clear();
  message.model.clear();
  message.parent_attempt = 0;
  message.form = 0;
  message.polished = 0;
  message.request_hash.clear();
  message.answer_text.clear();
  message.tokens_in = 0;
  message.tokens_out = 0;
  message.spend_usd = 0;
  message.t_prep_us = 0;
  message.t_llm_us = 0;
  message.advice_error.clear();
}
void Blank(terra_msg::baseline_t& message) {
  message.baseline_cost = 0;
  message.nodes_expanded = 0;
  message.edges_costed = 0;
  message.search_us = 0;
}
void Blank(terra_msg::map_header_t& message) {
  message.session = 0;
  message.map_revision = 0;
  message.cell_size_m = 0;
  message.origin_x_m = 0;
  message.origin_y_m = 0;
  message.origin_yaw_rad = 0;
  std::ranges::fill(message.terrain_rgb, 0);
  std::ranges::fill(message.terrain_name, std::string());
}
void Blank(terra_msg::map_tile_t& message) {
  message.session = 0;
}
void Blank(terra_msg::pose_t& message) {
  message.session = 0;
  message.heading_rad = 0;
  message.speed_mps = 0;
}
void Blank(terra_msg::config_t&) {}

template <typename T>
bool SameButForBlanks(const bus::RawMessage& a, const bus::RawMessage& b) {
  auto one = bus::Decode<T>(a.bytes);
  auto other = bus::Decode<T>(b.bytes);
  if (!one || !other) return false;
  for (T* message : {&*one, &*other}) {
    message->utime = 0;
    message->seq = 0;
    Blank(*message);
  }
  return bus::Encode(*one) == bus::Encode(*other);
}

bool SaysTheSame(const bus::RawMessage& a, const bus::RawMessage& b) {
  switch (a.channel) {
    case Channel::kMapHeader:
      return SameButForBlanks<terra_msg::map_header_t>(a, b);
    case Channel::kMapTile:
      return SameButForBlanks<terra_msg::map_tile_t>(a, b);
    case Channel::kPlanRequest:
      return SameButForBlanks<terra_msg::plan_request_t>(a, b);
    case Channel::kBaseline:
      return SameButForBlanks<terra_msg::baseline_t>(a, b);
    case Channel::kAdvice:
      return SameButForBlanks<terra_msg::advice_t>(a, b);
    case Channel::kVerdict:
      return SameButForBlanks<terra_msg::verdict_t>(a, b);
    case Channel::kDeployed:
      return SameButForBlanks<terra_msg::deployed_t>(a, b);
    case Channel::kPose:
      return SameButForBlanks<terra_msg::pose_t>(a, b);
    case Channel::kConfig:
      return SameButForBlanks<terra_msg::config_t>(a, b);
    default:
      return false;
  }
}

// ---- Advice that was refused for what stands elsewhere in it ----

// The order of the codes is that of docs/gate.md.
bool IsBeforeTheAnswer(std::int16_t code) {
  using terra_msg::verdict_t;
  return code == verdict_t::CODE_STALE_REQUEST ||
         code == verdict_t::CODE_STALE_MAP ||
         code == verdict_t::CODE_STALE_BASELINE ||
         code == verdict_t::CODE_BASELINE_INVALID ||
         code == verdict_t::CODE_LATE;
}

bool IsWithoutLookAtRoute(std::int16_t code) {
  using terra_msg::verdict_t;
  return IsBeforeTheAnswer(code) || code == verdict_t::CODE_MALFORMED_MESSAGE ||
         code == verdict_t::CODE_RETAINED ||
         code == verdict_t::CODE_PARSE_ERROR;
}

std::optional<terra_msg::verdict_t> VerdictOf(const terra_msg::advice_t& advice,
                                              const Messages& messages) {
  for (const auto& verdict : Said<terra_msg::verdict_t>(messages)) {
    if (verdict.subject == terra_msg::verdict_t::SUBJECT_ADVICE &&
        verdict.advisor_session == advice.session &&
        verdict.attempt == advice.attempt &&
        verdict.candidate == advice.candidate) {
      return verdict;
    }
  }
  return std::nullopt;
}

bus::MapPtr MapOf(std::int64_t map_id, const Messages& messages) {
  LoggedMaps maps;
  for (const auto& said : Said<terra_msg::map_header_t>(messages)) {
    maps.Take(said);
  }
  for (const auto& said : Said<terra_msg::map_tile_t>(messages)) {
    maps.Take(said);
  }
  return maps.Find(map_id);
}

// Returns whether two routes from the same anchor fail at the same place, or
// cost the same.
bool RefusedAlike(const terra_msg::advice_t& a, const terra_msg::advice_t& b,
                  const Messages& messages) {
  const bus::MapPtr map = MapOf(a.map_id, messages);
  if (!map) return false;
  const auto check = [&](const terra_msg::advice_t& advice) {
    return verifier::CheckRoute(map->map, bus::WaypointsOf(advice),
                                {a.anchor_x, a.anchor_y}, RecordedRun::kGoal,
                                verifier::kBusLimits);
  };
  const verifier::RouteCheck one = check(a);
  const verifier::RouteCheck other = check(b);
  return one.code == other.code && one.segment == other.segment &&
         one.cell == other.cell && one.cost == other.cost;
}

// Answers are told apart only where no check before them has failed.
bool KindsCountAlike(const terra_msg::advice_t& a, const terra_msg::advice_t& b,
                     std::int16_t code) {
  using terra_msg::advice_t;
  const auto is_answer = [](const advice_t& advice) {
    return advice.kind == advice_t::KIND_RETAIN ||
           advice.kind == advice_t::KIND_PROPOSE ||
           advice.kind == advice_t::KIND_MALFORMED;
  };
  const auto is_nothing = [&](const advice_t& advice) {
    return !is_answer(advice) && advice.kind != advice_t::KIND_FAILED;
  };
  if (a.kind == b.kind) return true;
  if (code == terra_msg::verdict_t::CODE_MALFORMED_MESSAGE) {
    return is_nothing(a) && is_nothing(b);
  }
  return IsBeforeTheAnswer(code) && is_answer(a) && is_answer(b);
}

// Returns whether only waypoints or kind were changed, and the verdict is the
// same for both.
bool IsRefusedAlike(const terra_msg::advice_t& a, const terra_msg::advice_t& b,
                    const Messages& messages) {
  if (a.num_waypoints != b.num_waypoints) return false;
  terra_msg::advice_t mixed = b;
  mixed.waypoint_x = a.waypoint_x;
  mixed.waypoint_y = a.waypoint_y;
  mixed.kind = a.kind;
  if (bus::Encode(mixed) != bus::Encode(a)) return false;
  const auto verdict = VerdictOf(a, messages);
  if (!verdict || verdict->code == terra_msg::verdict_t::CODE_ACCEPTED) {
    return false;
  }
  const std::int16_t code = verdict->code;
  return KindsCountAlike(a, b, code) &&
         (IsWithoutLookAtRoute(code) || RefusedAlike(a, b, messages));
}

// ---- Others ----

// Returns whether both have passed the same anchors of those that a verdict
// names.
bool ShowsTheSame(const terra_msg::pose_t& a, const terra_msg::pose_t& b,
                  const Messages& messages) {
  if (a.deployed_session != b.deployed_session ||
      a.deployed_route_seq != b.deployed_route_seq) {
    return false;
  }
  for (const auto& deployed : Said<terra_msg::deployed_t>(messages)) {
    if (deployed.session != a.deployed_session ||
        deployed.route_seq != a.deployed_route_seq) {
      continue;
    }
    DrivenRoute one;
    one.Follow(bus::WaypointsOf(deployed));
    DrivenRoute other = one;
    one.OnPose({a.pose_x, a.pose_y});
    other.OnPose({b.pose_x, b.pose_y});
    return std::ranges::all_of(Said<terra_msg::verdict_t>(messages),
                               [&](const auto& verdict) {
                                 return one.Passed(verdict.anchor_index) ==
                                        other.Passed(verdict.anchor_index);
                               });
  }
  return false;
}

// Returns whether only the planner's name and session were changed, and no
// decision names them.
bool IsNamedByNobody(const terra_msg::baseline_t& a,
                     const terra_msg::baseline_t& b, const Messages& messages) {
  terra_msg::baseline_t renamed = b;
  renamed.session = a.session;
  renamed.planner = a.planner;
  if (bus::Encode(renamed) != bus::Encode(a)) return false;
  const auto deployed = Said<terra_msg::deployed_t>(messages);
  const auto verdicts = Said<terra_msg::verdict_t>(messages);
  return std::ranges::none_of(deployed,
                              [&](const auto& said) {
                                return said.baseline_digest ==
                                           a.baseline_digest &&
                                       said.source_session == a.session;
                              }) &&
         std::ranges::none_of(verdicts, [&](const auto& said) {
           return said.subject == terra_msg::verdict_t::SUBJECT_BASELINE &&
                  said.baseline_digest == a.baseline_digest;
         });
}

// Returns whether the same tiles are packed otherwise: a zstd frame has bits
// that do not show in what it unpacks to.
bool AreTheSameTiles(const terra_msg::map_tile_t& a,
                     const terra_msg::map_tile_t& b) {
  if (a.tile_index != b.tile_index || a.tile_digest != b.tile_digest ||
      a.tile_size != b.tile_size) {
    return false;
  }
  const TerrainMap map = RecordedRun::BarMap(1);
  const TileGrid grid{map.width(), map.height()};
  std::size_t at = 0;
  for (std::size_t i = 0; i < a.tile_index.size(); ++i) {
    const std::size_t cells = grid.rect(a.tile_index[i]).cells();
    const auto size = static_cast<std::size_t>(a.tile_size[i]);
    const auto one =
        bus::UnpackTile(std::span(a.tile_data).subspan(at, size), cells);
    const auto other =
        bus::UnpackTile(std::span(b.tile_data).subspan(at, size), cells);
    if (!one || !other || *one != *other) return false;
    at += size;
  }
  return true;
}

}  // namespace

bool DecidesTheSame(const bus::RawMessage& honest,
                    const bus::RawMessage& changed, const Messages& messages) {
  if (SaysTheSame(honest, changed)) return true;
  const auto both = [&]<typename T>(auto same) {
    const auto a = bus::Decode<T>(honest.bytes);
    const auto b = bus::Decode<T>(changed.bytes);
    return a && b && same(*a, *b);
  };
  switch (honest.channel) {
    case Channel::kAdvice:
      return both.operator()<terra_msg::advice_t>(
          [&](const auto& a, const auto& b) {
            return IsRefusedAlike(a, b, messages);
          });
    case Channel::kPose:
      return both.operator()<terra_msg::pose_t>(
          [&](const auto& a, const auto& b) {
            return ShowsTheSame(a, b, messages);
          });
    case Channel::kBaseline:
      return both.operator()<terra_msg::baseline_t>(
          [&](const auto& a, const auto& b) {
            return IsNamedByNobody(a, b, messages);
          });
    case Channel::kMapTile:
      return both.operator()<terra_msg::map_tile_t>(AreTheSameTiles);
    default:
      return false;
  }
}

}  // namespace terra::logger
