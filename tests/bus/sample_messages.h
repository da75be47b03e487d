#pragma once

#include <string>
#include <vector>

#include "bus/messages.h"

namespace terra::testing {

/// One message of each type, no field at its default, for golden bytes and
/// hostile variants.
template <typename T>
T Sample();

template <>
inline terra_msg::map_header_t Sample() {
  terra_msg::map_header_t m{};
  m.map_id = 0x0102030405060708;
  m.map_revision = 3;
  m.width = 200;
  m.height = 130;
  m.cell_size_m = 0.05;
  m.origin_x_m = -1.5;
  m.origin_y_m = 2.25;
  m.origin_yaw_rad = 0.125;
  m.num_terrains = 2;
  m.terrain_id = {0, 7};
  m.terrain_cost = {1.0, 2.5};
  m.terrain_rgb = {0x102030, 0xA0B0C0};
  m.terrain_name = {"grass", "gravel"};
  m.corner_cutting = 1;
  m.clearance_cells = 2;
  m.tile_side = 128;
  m.num_tiles = 4;
  m.tile_digest = {11, -12, 13, -14};
  return m;
}
template <>
inline terra_msg::map_tile_t Sample() {
  terra_msg::map_tile_t m{};
  m.num_tiles = 2;
  m.tile_index = {0, 3};
  m.tile_digest = {11, -14};
  m.tile_size = {2, 3};
  m.num_bytes = 5;
  m.tile_data = {1, 2, 3, 4, 255};
  return m;
}
template <>
inline terra_msg::map_request_t Sample() {
  terra_msg::map_request_t m{};
  m.map_id = 0x0102030405060708;
  m.num_missing = 3;
  m.missing_tile = {1, 2, 3};
  return m;
}
template <>
inline terra_msg::plan_request_t Sample() {
  terra_msg::plan_request_t m{};
  m.request_id = 4242;
  m.action = terra_msg::plan_request_t::ACTION_GO;
  m.map_id = 0x0102030405060708;
  m.start_x = 1;
  m.start_y = 2;
  m.goal_x = 190;
  m.goal_y = 120;
  return m;
}
template <>
inline terra_msg::baseline_t Sample() {
  terra_msg::baseline_t m{};
  m.request_id = 4242;
  m.start_x = 1;
  m.start_y = 2;
  m.goal_x = 190;
  m.goal_y = 120;
  m.map_id = 0x0102030405060708;
  m.planner = "planner";
  m.status = terra_msg::baseline_t::STATUS_OK;
  m.baseline_digest = -77;
  m.num_waypoints = 3;
  m.waypoint_x = {1, 50, 190};
  m.waypoint_y = {2, 50, 120};
  m.baseline_cost = 321.5;
  m.nodes_expanded = 12;
  m.edges_costed = 34;
  m.search_us = 56;
  return m;
}
template <>
inline terra_msg::advice_t Sample() {
  terra_msg::advice_t m{};
  m.request_id = 4242;
  m.map_id = 0x0102030405060708;
  m.baseline_digest = -77;
  m.anchor_session = 1;
  m.anchor_route_seq = 2;
  m.anchor_index = 3;
  m.anchor_x = 4;
  m.anchor_y = 5;
  m.advisor = "search";
  m.method = "refine";
  m.backend = "search";
  m.model = "none";
  m.attempt = 6;
  m.candidate = 7;
  m.parent_attempt = 8;
  m.kind = terra_msg::advice_t::KIND_PROPOSE;
  m.form = terra_msg::advice_t::FORM_EXACT;
  m.polished = 1;
  m.num_waypoints = 2;
  m.waypoint_x = {1, 190};
  m.waypoint_y = {2, 120};
  m.request_hash = "00ff";
  m.answer_text = "No. [(1, 2), (190, 120)]";
  m.tokens_in = 9;
  m.tokens_out = 10;
  m.spend_usd = 0.25;
  m.t_prep_us = 11;
  m.t_llm_us = 12;
  m.advice_error = "none";
  return m;
}
template <>
inline terra_msg::verdict_t Sample() {
  terra_msg::verdict_t m{};
  m.decision = 5;
  m.subject = terra_msg::verdict_t::SUBJECT_ADVICE;
  m.request_id = 4242;
  m.map_id = 0x0102030405060708;
  m.baseline_digest = -77;
  m.anchor_session = 1;
  m.anchor_route_seq = 2;
  m.anchor_index = 3;
  m.anchor_x = 4;
  m.anchor_y = 5;
  m.advisor = "search";
  m.advisor_session = 99;
  m.attempt = 6;
  m.candidate = 7;
  m.code = terra_msg::verdict_t::CODE_OBSTACLE;
  m.candidate_cost = 300.25;
  m.baseline_cost = 321.5;
  m.cost_to_beat = 310.75;
  m.route_seq_before = 2;
  m.fail_segment = 1;
  m.fail_x = 60;
  m.fail_y = 61;
  m.t_det_us = 15;
  return m;
}
template <>
inline terra_msg::deployed_t Sample() {
  terra_msg::deployed_t m{};
  m.decision = 6;
  m.route_seq = 3;
  m.request_id = 4242;
  m.start_x = 1;
  m.start_y = 2;
  m.goal_x = 190;
  m.goal_y = 120;
  m.map_id = 0x0102030405060708;
  m.baseline_digest = -77;
  m.mode = terra_msg::deployed_t::MODE_CANDIDATE;
  m.cause = terra_msg::deployed_t::CAUSE_UPGRADE;
  m.source = "search";
  m.source_session = 99;
  m.source_attempt = 6;
  m.source_candidate = 7;
  m.num_waypoints = 2;
  m.waypoint_x = {1, 4};
  m.waypoint_y = {2, 2};
  m.num_steps = 3;
  m.num_chain_bytes = 2;
  m.chain = {0x71, 0x02};
  m.deployed_cost = 300.25;
  m.baseline_cost = 321.5;
  return m;
}
template <>
inline terra_msg::pose_t Sample() {
  terra_msg::pose_t m{};
  m.pose_x = 10;
  m.pose_y = 11;
  m.heading_rad = 1.5;
  m.speed_mps = 0.75;
  m.deployed_session = 99;
  m.deployed_route_seq = 3;
  return m;
}
template <>
inline terra_msg::status_t Sample() {
  terra_msg::status_t m{};
  m.status_name = "planner";
  m.host = "robot";
  m.pid = 1234;
  m.state = "ready";
  m.build_id = "0.1.0+abc";
  m.num_counters = 2;
  m.counter_name = {"received", "malformed"};
  m.counter_value = {17, 1};
  m.last_error = "none";
  return m;
}
template <>
inline terra_msg::config_t Sample() {
  terra_msg::config_t m{};
  m.config_name = "planner";
  m.build_id = "0.1.0+abc";
  m.config_text = "stride=50\n";
  return m;
}
template <>
inline terra_msg::log_mark_t Sample() {
  terra_msg::log_mark_t m{};
  m.mark_kind = terra_msg::log_mark_t::KIND_CHECKSUM;
  m.format_version = 1;
  m.part = 2;
  m.first_byte = 100;
  m.num_bytes = 200;
  m.num_events = 3;
  m.checksum = -4;
  m.mark_text = "why";
  return m;
}

template <>
inline terra_msg::gate_step_t Sample() {
  terra_msg::gate_step_t m{};
  m.step = 21;
  m.now_us = 123'456'789;
  m.kind = terra_msg::gate_step_t::KIND_ADVICE;
  m.lookup = terra_msg::gate_step_t::LOOKUP_NEW;
  m.event_session = 99;
  m.event_seq = 12;
  m.event_digest = -31;
  m.request_id = 4242;
  m.request_cancelled = 1;
  m.answered_by = 98;
  m.map_id = 0x0102030405060708;
  m.baseline_digest = -77;
  m.baseline_session = 97;
  m.route_seq = 3;
  m.place_x = 10;
  m.place_y = 11;
  m.place_index = 12;
  m.place_on_route = 1;
  m.place_speed = 0.75;
  m.place_age_us = 1'300;
  m.dwell_end_us = 123'999'999;
  m.decision = 5;
  m.core_before = -32;
  m.num_decisions = 2;
  m.decisions_digest = -33;
  m.core_after = -34;
  m.bytes_digest = -35;
  m.num_bytes = 5;
  m.event_bytes = {1, 2, 3, 4, 255};
  return m;
}

/// The sample with an envelope.
template <typename T>
T StampedSample() {
  T message = Sample<T>();
  message.utime = 1'700'000'000'000'000;
  message.session = 0x1122334455667788;
  message.seq = 9;
  return message;
}

}  // namespace terra::testing
