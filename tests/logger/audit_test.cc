#include "logger/audit.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "logger/recorder.h"
#include "terrain/builtin_legends.h"
#include "tests/logger/recorded_run.h"

namespace terra::logger {
namespace {

using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::verdict_t;
using testing::TempFolder;

std::int64_t DecisionsIn(const Messages& messages) {
  std::map<std::int64_t, std::int64_t> last;
  for (const verdict_t& verdict : Said<verdict_t>(messages)) {
    last[verdict.session] = std::max(last[verdict.session], verdict.decision);
  }
  for (const deployed_t& deployed : Said<deployed_t>(messages)) {
    last[deployed.session] =
        std::max(last[deployed.session], deployed.decision);
  }
  std::int64_t all = 0;
  for (const auto& [session, decisions] : last) all += decisions;
  return all;
}

TEST(Audit, EveryDecisionOfAnHonestLogIsMadeAgain) {
  const Messages messages = EventfulRun();
  const Audit audit = AuditOf(messages);
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_EQ(audit.sessions.size(), 2U);
  EXPECT_EQ(audit.anchors, 0);
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
                          return message.channel == bus::Channel::kPose ||
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

TEST(Audit, ALogWithoutDecisionsIsNothingToAudit) {
  Messages messages = EventfulRun();
  std::erase_if(messages, [](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kVerdict ||
           message.channel == bus::Channel::kDeployed;
  });
  for (const Messages& log : {messages, Messages{messages.front()}}) {
    const Audit audit = AuditOf(log);
    EXPECT_TRUE(audit.clean()) << Text(audit);
    EXPECT_FALSE(audit.passed());
    EXPECT_EQ(Conclusion(audit), "nothing to audit");
  }
}

TEST(Audit, ALogThatBeginsInMidRunIsCleanFromItsFirstDeployedOn) {
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
  for (std::size_t cut = 1; cut < messages.size(); cut += 5) {
    Messages rest = map;
    rest.insert(rest.end(), messages.begin() + static_cast<std::ptrdiff_t>(cut),
                messages.end());
    const Audit audit = AuditOf(rest);
    for (const Finding& finding : audit.findings) {
      // Inputs of the first decisions may lie before the log.
      EXPECT_EQ(finding.kind, Finding::Kind::kMissingInput)
          << "cut at " << cut << ": " << Text(audit);
    }
  }
}

TEST(Audit, AMissingInputIsNamed) {
  Messages messages = EventfulRun();
  std::int64_t attempt = 0;
  std::erase_if(messages, [&attempt](const bus::RawMessage& message) {
    if (message.channel != bus::Channel::kAdvice || attempt != 0) return false;
    attempt = bus::Decode<advice_t>(message.bytes)->attempt;
    return true;
  });
  const Audit audit = AuditOf(messages);
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMissingInput);
  EXPECT_NE(audit.findings[0].what.find("attempt " + std::to_string(attempt)),
            std::string::npos);
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

// Loses an advice of a request, so that the audit goes on from the next one's
// DEPLOYED.
Messages WithoutAttempt(Messages messages, std::int64_t attempt) {
  std::erase_if(messages, [attempt](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kAdvice &&
           bus::Decode<advice_t>(message.bytes).value().attempt == attempt;
  });
  return messages;
}

// What is missing before a new request does not make a mismatch of it, though
// somebody said nonsense about its baseline later.
TEST(Audit, AfterAMissingInputANewRequestIsTheStateToGoOnFrom) {
  constexpr std::int8_t kNoKind = 99;
  RecordedRun run;
  run.Ask(21);
  run.Advise(run.Baseline().value(), {RecordedRun::kStart, RecordedRun::kGoal});
  const std::int64_t lost = Said<advice_t>(run.messages()).back().attempt;
  run.Ask(22);
  run.Advise(run.Baseline().value(), {RecordedRun::kStart, RecordedRun::kGoal},
             kNoKind);
  ASSERT_EQ(Said<verdict_t>(run.messages()).back().code,
            verdict_t::CODE_MALFORMED_MESSAGE);
  const Audit audit = AuditOf(WithoutAttempt(run.messages(), lost));
  ASSERT_EQ(audit.num_findings, 1) << Text(audit);
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMissingInput);
}

TEST(Audit, AfterAMissingInputPosesOfTheRequestBeforeShowNothing) {
  const Route over = {
      RecordedRun::kStart, {69, 29}, {90, 29}, RecordedRun::kGoal};
  RecordedRun run;
  run.Ask(21);
  run.Advise(run.Baseline().value(), over);
  run.DriveTo(run.Deployed().value(), 120);
  run.Advise(run.Baseline().value(), {RecordedRun::kStart, RecordedRun::kGoal});
  const std::int64_t lost = Said<advice_t>(run.messages()).back().attempt;
  run.Ask(22);
  run.Advise(run.Baseline().value(), over);
  const deployed_t driven = run.Deployed().value();
  ASSERT_EQ(driven.mode, deployed_t::MODE_CANDIDATE);
  run.DriveTo(driven, 30);
  run.AdviseFrom(driven, 10);
  ASSERT_EQ(Said<verdict_t>(run.messages()).back().code, verdict_t::CODE_LATE);
  run.AdviseFrom(driven, 90);
  ASSERT_NE(Said<verdict_t>(run.messages()).back().code, verdict_t::CODE_LATE);
  const Audit audit = AuditOf(WithoutAttempt(run.messages(), lost));
  ASSERT_EQ(audit.num_findings, 1) << Text(audit);
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMissingInput);
}

std::int16_t LastCode(const RecordedRun& run) {
  return Said<verdict_t>(run.messages()).back().code;
}

// Which poses the gate had heard when the map changed no decision says; its
// place along the route that it goes back to depends on them.
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

TEST(Audit, AForgedStateThatALogBeginsWithIsAMismatch) {
  Messages messages = EventfulRun();
  // Only the baseline, the map and what is deployed at the end.
  const auto deployed = Said<deployed_t>(messages);
  const auto last = std::find_if(
      deployed.rbegin(), deployed.rend(), [](const deployed_t& message) {
        return message.mode == deployed_t::MODE_CANDIDATE;
      });
  ASSERT_NE(last, deployed.rend());
  std::erase_if(messages, [](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kVerdict ||
           message.channel == bus::Channel::kDeployed;
  });
  messages.push_back({bus::Channel::kDeployed, bus::Encode(*last)});
  EXPECT_TRUE(AuditOf(messages).clean()) << Text(AuditOf(messages));
  deployed_t forged = *last;
  forged.deployed_cost -= 1;
  messages.back().bytes = bus::Encode(forged);
  EXPECT_FALSE(AuditOf(messages).clean());
}

// All inputs, and of what the gate said only this.
Messages BeginningWith(const deployed_t& deployed, Messages messages) {
  std::erase_if(messages, [](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kVerdict ||
           message.channel == bus::Channel::kDeployed;
  });
  messages.push_back({bus::Channel::kDeployed, bus::Encode(deployed)});
  return messages;
}

// Whatever a DEPLOYED says follows from the inputs that it names, so a log may
// begin with any of them.
TEST(Audit, EachDeployedMayBeTheFirst) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Messages messages = RandomRun(seed);
    std::int64_t last = 0;
    for (const deployed_t& deployed : Said<deployed_t>(messages)) {
      if (deployed.decision == last) continue;
      last = deployed.decision;
      const Audit audit = AuditOf(BeginningWith(deployed, messages));
      EXPECT_TRUE(audit.clean())
          << "seed " << seed << ", decision " << last << ": " << Text(audit);
    }
  }
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
  EXPECT_TRUE(AuditOf(BeginningWith(*kept, run.messages())).clean())
      << Text(AuditOf(BeginningWith(*kept, run.messages())));
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
  EXPECT_TRUE(AuditOf(BeginningWith(kept, run.messages())).clean())
      << Text(AuditOf(BeginningWith(kept, run.messages())));
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

// ---- Advice that the recorder turned away in a flood. ----

constexpr std::int64_t kRecorder = 31;

// A recorder's heartbeat.
bus::RawMessage Heartbeat(std::int64_t session, std::int64_t turned_away) {
  terra_msg::status_t status{};
  status.session = session;
  status.num_counters = 2;
  status.counter_name = {"acknowledged", "advice_over_limit"};
  status.counter_value = {1, turned_away};
  return {bus::Channel::kStatus, bus::Encode(status)};
}

// Audits what a recorder wrote of these messages.
Audit AuditOfRecording(Messages messages, const bus::RawMessage& heartbeat) {
  messages.push_back(heartbeat);
  const TempFolder folder;
  RecorderOptions options;
  options.session = kRecorder;
  Recorder recorder = Recorder::Start(folder.Path(""), options, 1).value();
  const std::string path = recorder.path();
  for (const bus::RawMessage& message : messages) {
    recorder.Record(
        {1, std::string(bus::BaseName(message.channel)), message.bytes});
  }
  EXPECT_TRUE(recorder.Close(1).ok());
  Result<LogReader> reader = LogReader::Open(path);
  return AuditLog(*reader);
}

// Verdicts on an attempt, of them accepted ones.
std::pair<std::int64_t, std::int64_t> VerdictsOn(const Messages& messages,
                                                 std::int64_t attempt) {
  std::pair<std::int64_t, std::int64_t> verdicts;
  std::int64_t last = 0;
  for (const verdict_t& verdict : Said<verdict_t>(messages)) {
    if (verdict.subject != verdict_t::SUBJECT_ADVICE ||
        verdict.attempt != attempt || verdict.decision == last) {
      continue;
    }
    last = verdict.decision;
    ++verdicts.first;
    if (verdict.code == verdict_t::CODE_ACCEPTED) ++verdicts.second;
  }
  return verdicts;
}

TEST(Audit, AdviceThatTheRecorderTurnedAwayIsNoFinding) {
  const Messages messages = EventfulRun();
  std::set<std::int64_t> attempts;
  for (const advice_t& advice : Said<advice_t>(messages)) {
    attempts.insert(advice.attempt);
  }
  std::int64_t passed_over = 0;
  for (const std::int64_t attempt : attempts) {
    const auto [verdicts, accepted] = VerdictsOn(messages, attempt);
    const Messages without = WithoutAttempt(messages, attempt);
    const Audit audit = AuditOfRecording(without, Heartbeat(kRecorder, 7));
    EXPECT_TRUE(audit.clean()) << "attempt " << attempt << ": " << Text(audit);
    EXPECT_EQ(audit.advice_turned_away, 7);
    EXPECT_EQ(audit.unrecorded, verdicts) << "attempt " << attempt;
    // Nothing else is lost by it. The route of one that was accepted is the
    // state to go on from.
    EXPECT_EQ(audit.anchors, accepted) << "attempt " << attempt;
    EXPECT_EQ(audit.verdicts + audit.deployed + audit.unrecorded +
                  audit.anchors + audit.unchecked,
              DecisionsIn(messages))
        << "attempt " << attempt;
    passed_over += audit.unrecorded;
  }
  EXPECT_GT(passed_over, 5);
}

TEST(Audit, MissingAdviceIsAFindingWhereTheRecorderTurnedAwayNothing) {
  const Messages run = EventfulRun();
  const auto verdicts = Said<verdict_t>(run);
  const auto judged = std::ranges::find(
      verdicts, std::int8_t{verdict_t::SUBJECT_ADVICE}, &verdict_t::subject);
  ASSERT_NE(judged, verdicts.end());
  const Messages messages = WithoutAttempt(run, judged->attempt);
  for (const bus::RawMessage& heartbeat :
       {Heartbeat(kRecorder, 0), Heartbeat(kRecorder, -7),
        Heartbeat(kRecorder + 1, 7)}) {
    const Audit audit = AuditOfRecording(messages, heartbeat);
    ASSERT_FALSE(audit.clean());
    EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMissingInput);
    EXPECT_EQ(audit.unrecorded, 0);
  }
  // In a log without seals a heartbeat proves nothing.
  Messages unsealed = messages;
  unsealed.push_back(Heartbeat(kRecorder, 7));
  EXPECT_FALSE(AuditOf(unsealed).clean());
}

// What the log holds is judged, flood or not.
TEST(Audit, AForgedVerdictIsAMismatchInAFloodToo) {
  const Messages forged =
      WithChangedVerdict(EventfulRun(), [](verdict_t& verdict) {
        verdict.candidate_cost = 1.0;
      });
  const Audit audit = AuditOfRecording(forged, Heartbeat(kRecorder, 7));
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.unrecorded, 0);
}

}  // namespace
}  // namespace terra::logger
