#include "logger/audit.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "logger/recorder.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "tests/logger/recorded_run.h"

namespace terra::logger {
namespace {

using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::gate_step_t;
using terra_msg::verdict_t;
using testing::TempFolder;

Messages Without(Messages messages, bus::Channel channel) {
  std::erase_if(messages, [channel](const bus::RawMessage& message) {
    return message.channel == channel;
  });
  return messages;
}

TEST(Audit, EveryDecisionOfAnHonestLogIsMadeAgain) {
  const Messages messages = EventfulRun();
  const Audit audit = AuditOf(messages);
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_EQ(audit.sessions.size(), 2U);
  EXPECT_EQ(audit.steps, std::ssize(Said<gate_step_t>(messages)));
  EXPECT_EQ(audit.anchors, 0);
  EXPECT_EQ(audit.lookups_given, 0);
  EXPECT_EQ(audit.verdicts, std::ssize(Said<verdict_t>(messages)));
  EXPECT_EQ(audit.verdicts + audit.deployed, DecisionsIn(messages));
}

TEST(Audit, TheEventfulRunHasEveryKindOfVerdict) {
  std::map<int, int> codes;
  for (const verdict_t& verdict : Said<verdict_t>(EventfulRun())) {
    ++codes[verdict.code];
  }
  for (const std::int16_t code :
       {verdict_t::CODE_ACCEPTED, verdict_t::CODE_RETAINED,
        verdict_t::CODE_PARSE_ERROR, verdict_t::CODE_OUT_OF_BOUNDS,
        verdict_t::CODE_NOT_BEST, verdict_t::CODE_STALE_REQUEST,
        verdict_t::CODE_STALE_MAP, verdict_t::CODE_LATE,
        verdict_t::CODE_MALFORMED_MESSAGE}) {
    EXPECT_GT(codes[code], 0) << "code " << code;
  }
}

TEST(Audit, EveryDecisionOfARandomRunIsMadeAgain) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Messages messages = RandomRun(seed);
    const Audit audit = AuditOf(messages);
    EXPECT_TRUE(audit.clean()) << "seed " << seed << ": " << Text(audit);
    EXPECT_EQ(audit.steps, std::ssize(Said<gate_step_t>(messages)));
    EXPECT_EQ(audit.lookups_given, 0);
    EXPECT_EQ(audit.verdicts + audit.deployed, DecisionsIn(messages));
  }
}

// Anybody may call himself anything; the gate repeats it as a message may.
TEST(Audit, AnAdvisorsNameThatIsNoTextChangesNoFinding) {
  RecordedRun run;
  run.StartMap();
  run.StartPlanner();
  run.StartGate();
  run.Run(std::chrono::seconds(1));
  run.Ask(11);
  const auto baseline = run.Baseline();
  ASSERT_TRUE(baseline);
  advice_t advice = run.AdviceFor(
      *baseline, {RecordedRun::kStart, {80, 10}, RecordedRun::kGoal});
  advice.kind = advice_t::KIND_PROPOSE;
  advice.advisor = "\x1b[2J\xff\n";
  run.Inject(advice);
  const auto verdicts = Said<verdict_t>(run.messages());
  ASSERT_FALSE(verdicts.empty());
  EXPECT_EQ(verdicts.back().advisor, "\uFFFD[2J\uFFFD ");
  const Audit audit = AuditOf(run.messages());
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_GT(audit.verdicts, 0);
}

TEST(Audit, TheOrderOfTheLogDoesNotMatter) {
  Messages messages = EventfulRun();
  // Advice is heard by another socket, so it may be logged after its verdict.
  std::stable_partition(messages.begin(), messages.end(),
                        [](const bus::RawMessage& message) {
                          return message.channel == bus::Channel::kGateStep ||
                                 message.channel == bus::Channel::kPose ||
                                 message.channel == bus::Channel::kVerdict ||
                                 message.channel == bus::Channel::kDeployed;
                        });
  const Audit audit = AuditOf(messages);
  EXPECT_TRUE(audit.clean()) << Text(audit);
}

// Records a run, a new part beginning after so many messages.
std::vector<std::string> RecordParts(const Messages& messages,
                                     std::size_t per_part,
                                     const TempFolder& folder) {
  RecorderOptions options;
  options.part_bytes = 1;  // whenever it is flushed
  Recorder recorder = Recorder::Start(folder.Path(""), options, 1).value();
  std::vector<std::string> parts = {recorder.path()};
  std::size_t recorded = 0;
  for (const bus::RawMessage& message : messages) {
    recorder.Record(
        {1, std::string(bus::BaseName(message.channel)), message.bytes});
    if (++recorded % per_part != 0) continue;
    EXPECT_TRUE(recorder.Flush(1).ok());
    parts.push_back(recorder.path());
  }
  EXPECT_TRUE(recorder.Close(1).ok());
  return parts;
}

TEST(Audit, EachPartOfARecordingIsAuditedAlone) {
  for (std::uint64_t seed = 0; seed <= 12; ++seed) {
    const Messages messages = seed == 0 ? EventfulRun() : RandomRun(seed);
    const TempFolder folder;
    std::int64_t made_again = 0;
    for (const std::string& part :
         RecordParts(messages, seed == 0 ? 7 : 23, folder)) {
      Result<LogReader> reader = LogReader::Open(part);
      ASSERT_TRUE(reader.ok());
      const Audit audit = AuditLog(*reader);
      EXPECT_TRUE(audit.clean())
          << "seed " << seed << ", " << part << ": " << Text(audit);
      made_again += audit.verdicts + audit.deployed;
    }
    EXPECT_EQ(made_again, DecisionsIn(messages)) << "seed " << seed;
  }
}

TEST(Audit, ALogCutAtASealIsNotClosed) {
  const TempFolder folder;
  const std::string path = RecordParts(EventfulRun(), 1'000'000, folder).at(0);
  std::ifstream file(path, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto audit_of = [](std::span<const std::uint8_t> log) {
    LogReader reader(log);
    return AuditLog(reader);
  };
  const Audit whole = audit_of(bytes);
  EXPECT_TRUE(whole.passed()) << Text(whole);
  EXPECT_EQ(Conclusion(whole), "clean");

  LogReader reader(bytes);
  std::int64_t last_event = 0;  // The mark that closes it.
  while (const auto item = reader.Next()) last_event = item->offset;
  bytes.resize(static_cast<std::size_t>(last_event));
  const Audit cut = audit_of(bytes);
  EXPECT_FALSE(cut.closed);
  EXPECT_FALSE(cut.passed());
}

TEST(Audit, ALogWithoutAJournalIsNothingToAudit) {
  const Messages messages = EventfulRun();
  for (const Messages& log : {Without(messages, bus::Channel::kGateStep),
                              Messages{messages.front()}}) {
    const Audit audit = AuditOf(log);
    EXPECT_TRUE(audit.clean()) << Text(audit);
    EXPECT_FALSE(audit.passed());
    EXPECT_FALSE(audit.has_journal);
    EXPECT_EQ(Conclusion(audit), "nothing to audit");
  }
}

// The audit needs none of them: what the gate heard is in its journal.
TEST(Audit, WhatTheRecorderDidNotHearIsInTheJournal) {
  const Messages messages = EventfulRun();
  for (const bus::Channel channel :
       {bus::Channel::kAdvice, bus::Channel::kPose, bus::Channel::kPlanRequest,
        bus::Channel::kBaseline}) {
    const Audit audit = AuditOf(Without(messages, channel));
    EXPECT_TRUE(audit.clean()) << bus::BaseName(channel) << ": " << Text(audit);
    EXPECT_EQ(audit.verdicts + audit.deployed, DecisionsIn(messages));
  }
}

TEST(Audit, AMapThatIsNotInTheLogIsAMissingInput) {
  const Messages messages = EventfulRun();
  for (const bus::Channel channel :
       {bus::Channel::kMapHeader, bus::Channel::kMapTile}) {
    const Audit audit = AuditOf(Without(messages, channel));
    EXPECT_GT(std::ranges::count(audit.findings, Finding::Kind::kMissingInput,
                                 &Finding::kind),
              0)
        << bus::BaseName(channel);
    EXPECT_EQ(audit.verdicts + audit.deployed + audit.unchecked,
              DecisionsIn(messages));
  }
}

TEST(Audit, ALogThatBeginsInMidRunIsCleanFromThereOn) {
  const Messages messages = EventfulRun();
  // The map was sent long ago, but a recorder asks for it.
  Messages map;
  for (const bus::RawMessage& message : messages) {
    if (message.channel == bus::Channel::kMapHeader ||
        message.channel == bus::Channel::kMapTile ||
        message.channel == bus::Channel::kConfig) {
      map.push_back(message);
    }
  }
  std::int64_t made_again = 0;
  std::int64_t most = 0;
  for (std::size_t cut = 1; cut < messages.size(); cut += 5) {
    Messages rest = map;
    rest.insert(rest.end(), messages.begin() + static_cast<std::ptrdiff_t>(cut),
                messages.end());
    const Audit audit = AuditOf(rest);
    EXPECT_TRUE(audit.clean()) << "cut at " << cut << ": " << Text(audit);
    // The last gate began behind most of the cuts.
    made_again += audit.verdicts + audit.deployed;
    most += DecisionsIn(rest);
  }
  EXPECT_GT(made_again, most / 2);
}

template <typename Change>
Messages WithChangedVerdict(Messages messages, Change change) {
  for (bus::RawMessage& message : messages) {
    if (message.channel != bus::Channel::kVerdict) continue;
    auto verdict = *bus::Decode<verdict_t>(message.bytes);
    change(verdict);
    message.bytes = bus::Encode(verdict);
    break;
  }
  return messages;
}

std::int16_t LastCode(const RecordedRun& run) {
  return Said<verdict_t>(run.messages()).back().code;
}

TEST(Audit, ARobotThatDroveOnIsAtTheStartOfTheRouteAfterANewMap) {
  // On the baseline's own cells for a while, then close to the bar.
  const Route close_by = {
      RecordedRun::kStart, {40, 40}, {69, 29}, {90, 29}, RecordedRun::kGoal};
  for (const int driven_to : {8, 100}) {
    RecordedRun run;
    run.Ask(21);
    run.Advise(run.Baseline().value(), close_by);
    const deployed_t driven = run.Deployed().value();
    ASSERT_EQ(driven.mode, deployed_t::MODE_CANDIDATE);
    run.DriveTo(driven, 8);
    run.AdviseFrom(driven, 5);
    ASSERT_EQ(LastCode(run), verdict_t::CODE_LATE);
    run.DriveTo(driven, driven_to);
    run.SaveMap(RecordedRun::BarMap(10, 25));  // The terrain there is worse.
    run.Run(std::chrono::seconds(3));
    deployed_t back = run.Deployed().value();
    ASSERT_EQ(back.mode, deployed_t::MODE_BASELINE);
    // The new map's baseline is the same route, so no decision names it.
    back.baseline_digest = run.Baseline().value().baseline_digest;
    run.AdviseFrom(back, 6);
    EXPECT_EQ(LastCode(run) == verdict_t::CODE_LATE, driven_to == 8);
    const Audit audit = AuditOf(run.messages());
    EXPECT_TRUE(audit.clean()) << driven_to << ": " << Text(audit);
  }
}

TEST(Audit, AMapThatCameAndWentWhileNothingWasAskedIsStale) {
  RecordedRun run;
  run.SaveMap(RecordedRun::BarMap(9));
  run.Run(std::chrono::seconds(3));
  const std::int64_t passing =
      Said<terra_msg::map_header_t>(run.messages()).back().map_id;
  run.SaveMap(RecordedRun::BarMap(8));
  run.Run(std::chrono::seconds(3));
  run.Ask(21);
  terra_msg::baseline_t baseline = run.Baseline().value();
  ASSERT_NE(baseline.map_id, passing);
  baseline.map_id = passing;
  run.Advise(baseline, {RecordedRun::kStart, RecordedRun::kGoal});
  ASSERT_EQ(LastCode(run), verdict_t::CODE_STALE_MAP);
  const Audit audit = AuditOf(run.messages());
  EXPECT_TRUE(audit.clean()) << Text(audit);
}

TEST(Audit, AForgedVerdictIsAMismatch) {
  const Audit audit =
      AuditOf(WithChangedVerdict(EventfulRun(), [](verdict_t& verdict) {
        verdict.candidate_cost = 1.0;
      }));
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMismatch);
}

TEST(Audit, TheTimeOfTheCheckAndTheEnvelopeMayDiffer) {
  const Audit audit =
      AuditOf(WithChangedVerdict(EventfulRun(), [](verdict_t& verdict) {
        verdict.t_det_us += 17;
        verdict.utime += 17;
        verdict.seq += 17;
      }));
  EXPECT_TRUE(audit.clean()) << Text(audit);
}

TEST(Audit, AConfigThatCannotBeReadIsNotTakenForAMarginOfZero) {
  Messages messages = EventfulRun();
  for (bus::RawMessage& message : messages) {
    auto config = bus::Decode<terra_msg::config_t>(message.bytes);
    if (message.channel != bus::Channel::kConfig || !config) continue;
    config->config_text = "margin=much\n";
    message.bytes = bus::Encode(*config);
  }
  const Audit audit = AuditOf(messages);
  EXPECT_EQ(audit.verdicts + audit.deployed, 0);
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings.front().kind, Finding::Kind::kMissingInput);
  EXPECT_NE(audit.findings.front().what.find("margin is not known"),
            std::string::npos)
      << Text(audit);
}

TEST(Audit, AMissingDecisionIsAGap) {
  Messages messages = EventfulRun();
  std::erase_if(messages, [](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kVerdict &&
           bus::Decode<verdict_t>(message.bytes)->code ==
               verdict_t::CODE_RETAINED;
  });
  const Audit audit = AuditOf(messages);
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kGap);
}

// All inputs, and of what the gate said only what comes from this step on, and
// the DEPLOYED that is in force then.
Messages BeginningWith(const gate_step_t& step, Messages messages) {
  std::erase_if(messages, [&step](const bus::RawMessage& message) {
    if (message.channel == bus::Channel::kGateStep) {
      const auto other = *bus::Decode<gate_step_t>(message.bytes);
      return other.session == step.session && other.step < step.step;
    }
    if (message.channel == bus::Channel::kVerdict) {
      const auto verdict = *bus::Decode<verdict_t>(message.bytes);
      return verdict.session == step.session &&
             verdict.decision <= step.decision;
    }
    if (message.channel != bus::Channel::kDeployed) return false;
    const auto deployed = *bus::Decode<deployed_t>(message.bytes);
    return deployed.session == step.session &&
           deployed.route_seq < step.route_seq;
  });
  return messages;
}

// A step names the core before it, so a log may begin with any.
TEST(Audit, EachStepMayBeTheFirst) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Messages messages = RandomRun(seed);
    const auto steps = Said<gate_step_t>(messages);
    // Others after it would have lost their beginning.
    const std::int64_t first_gate = steps.front().session;
    for (const gate_step_t& step : steps) {
      if (step.session != first_gate || step.step == 1) continue;
      const Audit audit = AuditOf(BeginningWith(step, messages));
      EXPECT_TRUE(audit.clean())
          << "seed " << seed << ", step " << step.step << ": " << Text(audit);
      EXPECT_EQ(audit.anchors, 1);
      EXPECT_EQ(audit.unchecked, 0);
      EXPECT_EQ(audit.verdicts + audit.deployed,
                DecisionsIn(messages) - step.decision);
    }
  }
}

TEST(Audit, AForgedStateThatALogBeginsWithIsNotTaken) {
  const Messages messages = EventfulRun();
  const auto steps = Said<gate_step_t>(messages);
  const auto last = std::find_if(
      steps.rbegin(), steps.rend(), [&steps](const gate_step_t& step) {
        return step.session == steps.front().session && step.route_seq > 1 &&
               step.num_decisions > 0;
      });
  ASSERT_NE(last, steps.rend());
  Messages rest = BeginningWith(*last, messages);
  ASSERT_TRUE(AuditOf(rest).clean()) << Text(AuditOf(rest));
  const std::int64_t whole = AuditOf(rest).verdicts + AuditOf(rest).deployed;
  for (bus::RawMessage& message : rest) {
    if (message.channel != bus::Channel::kDeployed) continue;
    auto deployed = *bus::Decode<deployed_t>(message.bytes);
    if (deployed.session != last->session ||
        deployed.route_seq != last->route_seq) {
      continue;
    }
    deployed.deployed_cost -= 1;
    message.bytes = bus::Encode(deployed);
  }
  const Audit audit = AuditOf(rest);
  EXPECT_GE(audit.unchecked, last->num_decisions);
  EXPECT_LT(audit.verdicts + audit.deployed, whole);
}

// The digest shows that it was deployed so, and not that it was right.
TEST(Audit, AWrongPriceInTheStateThatALogBeginsWithIsAMismatch) {
  RecordedRun run;
  run.Ask(21);
  const deployed_t honest = run.Deployed().value();
  Messages quiet = Without(run.messages(), bus::Channel::kGateStep);
  std::erase_if(quiet, [&honest](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kDeployed &&
           bus::Decode<deployed_t>(message.bytes)->decision != honest.decision;
  });
  // A later gate's journal, so that there is one.
  RecordedRun other;
  other.Ask(22);
  const Messages later = other.messages();
  quiet.insert(quiet.end(), later.begin(), later.end());
  EXPECT_TRUE(AuditOf(quiet).clean()) << Text(AuditOf(quiet));
  EXPECT_EQ(AuditOf(quiet).anchors, 1);
  for (bus::RawMessage& message : quiet) {
    if (message.channel != bus::Channel::kDeployed) continue;
    auto deployed = *bus::Decode<deployed_t>(message.bytes);
    if (deployed.session != honest.session) continue;
    deployed.deployed_cost -= 1;
    message.bytes = bus::Encode(deployed);
  }
  const Audit audit = AuditOf(quiet);
  ASSERT_EQ(audit.num_findings, 1) << Text(audit);
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMismatch);
}

// ---- Gaps ----

Messages WithoutStep(Messages messages, const gate_step_t& step) {
  std::erase_if(messages, [&step](const bus::RawMessage& message) {
    if (message.channel != bus::Channel::kGateStep) return false;
    const auto other = *bus::Decode<gate_step_t>(message.bytes);
    return other.session == step.session && other.step == step.step;
  });
  return messages;
}

TEST(Audit, AMissingStepCostsOnlyWhatItHides) {
  for (const Messages& messages : {EventfulRun(), RandomRun(3), RandomRun(8)}) {
    const auto steps = Said<gate_step_t>(messages);
    std::map<std::int64_t, std::int64_t> last;
    for (const gate_step_t& step : steps) last[step.session] = step.step;
    for (const gate_step_t& step : steps) {
      const Audit audit = AuditOf(WithoutStep(messages, step));
      const bool hides =
          step.step != last[step.session] || step.num_decisions > 0;
      const bool is_whole_journal = step.step == 1 && last[step.session] == 1;
      if (is_whole_journal) continue;
      // The beginning of the first gate's journal may lie before the log.
      const bool may_begin =
          step.step == 1 && step.session == steps.front().session;
      if (!may_begin && hides) {
        ASSERT_EQ(audit.num_findings, 1)
            << "step " << step.step << ": " << Text(audit);
        EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kGap);
      } else {
        EXPECT_TRUE(audit.clean()) << Text(audit);
      }
      EXPECT_GE(audit.verdicts + audit.deployed,
                DecisionsIn(messages) - step.num_decisions)
          << "step " << step.step << ": " << Text(audit);
    }
  }
}

// What keeps the journal within its rate is said by the journal.
TEST(Audit, WhatTheGateLeftOutOfItsJournalIsNoFinding) {
  Messages messages = EventfulRun();
  std::int64_t hidden = 0;
  std::int64_t seq = 0;
  Messages kept;
  for (bus::RawMessage& message : messages) {
    if (message.channel == bus::Channel::kGateStep) {
      auto step = *bus::Decode<gate_step_t>(message.bytes);
      if (step.step == 1) seq = 0;
      const bool leave_out = step.kind == gate_step_t::KIND_ADVICE &&
                             step.num_decisions == 1 && hidden < 2;
      if (leave_out) {
        ++hidden;
        continue;
      }
      step.seq = ++seq;
      message.bytes = bus::Encode(step);
    }
    kept.push_back(message);
  }
  ASSERT_EQ(hidden, 2);
  const Audit audit = AuditOf(kept);
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_EQ(audit.unrecorded, hidden);
  EXPECT_EQ(audit.verdicts + audit.deployed + audit.unrecorded,
            DecisionsIn(messages));
}

// As the gate leaves them out.
void DropBytes(gate_step_t& step) {
  step.num_bytes = 0;
  step.event_bytes.clear();
  step.bytes_digest = BytesDigest({});
}

TEST(Audit, AdviceWithoutItsBytesIsLookedForInTheLog) {
  Messages messages = EventfulRun();
  std::int64_t decisions = 0;
  for (bus::RawMessage& message : messages) {
    if (message.channel != bus::Channel::kGateStep) continue;
    auto step = *bus::Decode<gate_step_t>(message.bytes);
    if (step.kind != gate_step_t::KIND_ADVICE) continue;
    decisions += step.num_decisions;
    DropBytes(step);
    message.bytes = bus::Encode(step);
  }
  ASSERT_GT(decisions, 5);
  const Audit audit = AuditOf(messages);
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_EQ(audit.unrecorded, 0);
  EXPECT_EQ(audit.verdicts + audit.deployed, DecisionsIn(messages));
  // Each costs only what it led to.
  const Audit without = AuditOf(Without(messages, bus::Channel::kAdvice));
  EXPECT_TRUE(without.clean()) << Text(without);
  EXPECT_EQ(without.unrecorded, decisions);
  EXPECT_EQ(without.verdicts + without.deployed + without.unrecorded,
            DecisionsIn(messages));
}

// A baseline that came after a map's change and is dearer than the candidate is
// held without a decision. When the next map blocks it, the candidate that
// stays names it.
TEST(Audit, ACandidateMayStayBesideABlockedBaselineThatWasNeverDeployed) {
  const TerrainMap walled = RecordedRun::BarMap(11);
  RecordedRun run;
  run.SaveMap(walled);
  run.Run(std::chrono::seconds(3));
  run.Ask(21);
  const Route close_by = {
      RecordedRun::kStart, {40, 40}, {69, 29}, {90, 29}, RecordedRun::kGoal};
  run.Advise(run.Baseline().value(), close_by);
  ASSERT_EQ(LastCode(run), verdict_t::CODE_ACCEPTED);
  // A strip that is worth crossing.
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 14).setConstant(1);
  run.SaveMap(
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value());
  run.Run(std::chrono::seconds(3));
  const std::int64_t across = run.Baseline().value().baseline_digest;
  ASSERT_NE(run.Deployed()->baseline_digest, across);
  run.SaveMap(walled);
  run.Run(std::chrono::milliseconds(1'500));
  const auto deployed = Said<deployed_t>(run.messages());
  const auto kept =
      std::ranges::find(deployed, across, &deployed_t::baseline_digest);
  ASSERT_NE(kept, deployed.end());
  EXPECT_EQ(kept->mode, deployed_t::MODE_CANDIDATE);
  EXPECT_EQ(kept->cause, deployed_t::CAUSE_MAP_UPDATE);
  EXPECT_TRUE(std::isnan(kept->baseline_cost));
  EXPECT_TRUE(AuditOf(run.messages()).clean()) << Text(AuditOf(run.messages()));
}

// The planner found no way on the map before, so no baseline is held.
TEST(Audit, ACandidateMayStayWithoutABaseline) {
  // A wall with a hole that no edge of the lattice goes through.
  const auto hole_at = [](int x) {
    ByteRaster ids = ByteRaster::Zero(120, 160);
    ids.block(0, x, 120, 10).setConstant(11);
    ids.block(27, x, 5, 10).setConstant(0);
    return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  };
  RecordedRun run;
  run.Ask(21);
  run.Advise(
      run.Baseline().value(),
      {RecordedRun::kStart, {40, 40}, {69, 29}, {90, 29}, RecordedRun::kGoal});
  ASSERT_EQ(LastCode(run), verdict_t::CODE_ACCEPTED);
  for (const int x : {72, 76}) {
    run.SaveMap(hole_at(x));
    run.Run(std::chrono::seconds(3));
    ASSERT_EQ(run.Baseline()->status, terra_msg::baseline_t::STATUS_NO_ROUTE);
  }
  const deployed_t kept = run.Deployed().value();
  EXPECT_EQ(kept.mode, deployed_t::MODE_CANDIDATE);
  EXPECT_EQ(kept.baseline_digest, 0);
  EXPECT_TRUE(std::isnan(kept.baseline_cost));
  EXPECT_TRUE(AuditOf(run.messages()).clean()) << Text(AuditOf(run.messages()));
}

// Anybody may copy an attempt number, so two messages under one name are no
// fault of the gate, with seals or without.
TEST(Audit, ACopiedAttemptNumberIsNoConflict) {
  Messages messages = EventfulRun();
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (messages[i].channel != bus::Channel::kAdvice) continue;
    auto advice = *bus::Decode<advice_t>(messages[i].bytes);
    advice.waypoint_x.at(0) += 1;
    messages.insert(messages.begin() + static_cast<std::ptrdiff_t>(i),
                    {bus::Channel::kAdvice, bus::Encode(advice)});
    break;
  }
  EXPECT_TRUE(AuditOf(messages).clean()) << Text(AuditOf(messages));
  const TempFolder folder;
  Result<LogReader> reader =
      LogReader::Open(RecordParts(messages, 1'000'000, folder).at(0));
  const Audit audit = AuditLog(*reader);
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_TRUE(audit.notes.empty());
}

}  // namespace
}  // namespace terra::logger
