// terra-verifier: the gate.
// Listens to the map, PLAN_REQUEST, BASELINE, POSE and, on the advice bus,
// ADVICE; publishes DEPLOYED, VERDICT, STATUS, CONFIG and, on a port of its
// own, GATE_STEP; exits when asked to (SIGINT, SIGTERM) or when it has no bus.
#include <optional>

#include <CLI/CLI.hpp>

#include "bus/advice_receiver.h"
#include "bus/bus.h"
#include "bus/process.h"
#include "verifier/gate_options.h"
#include "verifier/verifier_node.h"

namespace {

// Datagrams read from the advice bus in one turn, so few that decoding the
// largest keeps the deployed bus waiting for less than a millisecond.
constexpr std::size_t kDatagramsPerTurn = 8;

// Which advice is judged, and when, is the node's queue's business: a limit on
// all senders together would be filled by whoever speaks most. This one bounds
// what is decoded.
constexpr terra::bus::AdviceRateLimiter::Limits kLimits = {.per_sender = 20,
                                                           .all = 6'000};

terra::verifier::SenderId IdOf(terra::bus::SenderAddress sender) {
  return (std::uint64_t{sender.address} << 16) | sender.port;
}

std::int64_t Microseconds(terra::bus::Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             time.time_since_epoch())
      .count();
}

// Where the journal goes: a bus apart, which only the recorder hears.
struct JournalBus {
  explicit JournalBus(std::unique_ptr<terra::bus::Bus> opened,
                      std::int64_t session)
      : bus(std::move(opened)), out(*bus, session) {}

  std::unique_ptr<terra::bus::Bus> bus;
  terra::bus::Outbox out;
};

}  // namespace

int main(int argc, char** argv) {
  terra::verifier::GateOptions gate;
  std::optional<terra::bus::AdviceReceiver> receiver;
  std::optional<JournalBus> journal;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-verifier";
  spec.name = "verifier";
  spec.description =
      "The gate: deploys the baseline at once, and an advisor's route only "
      "when it is feasible and strictly cheaper.\nexample: terra-verifier "
      "--margin 0.5";
  spec.add_options = [&](CLI::App& app) {
    terra::verifier::AddGateOptions(app, gate);
  };
  spec.make_node = [&](terra::bus::ProcessContext& context)
      -> terra::Result<std::unique_ptr<terra::bus::Node>> {
    auto node =
        std::make_unique<terra::verifier::VerifierNode>(gate, context.out);
    if (context.bus.OneBus()) {
      node->ListenToAdvice();
      return std::unique_ptr<terra::bus::Node>(std::move(node));
    }
    const auto journal_url = context.bus.JournalUrl();
    if (!journal_url) return journal_url.error();
    auto journal_bus = terra::bus::Bus::Open(*journal_url, context.channels);
    if (!journal_bus) return journal_bus.error();
    journal.emplace(*std::move(journal_bus), context.out.session());
    node->WriteJournalTo(journal->out);
    auto opened = terra::bus::AdviceReceiver::Open(
        context.bus.advice_url,
        context.channels.name(terra::bus::Channel::kAdvice), kLimits);
    if (!opened) return opened.error();
    receiver.emplace(*std::move(opened));
    node->Count(*receiver);
    terra::verifier::VerifierNode* gate_node = node.get();
    context.loop.Watch(receiver->fd(), [&, gate_node](terra::bus::Time now) {
      receiver->Drain(Microseconds(now), kDatagramsPerTurn,
                      [gate_node, now](const terra::bus::LcmDatagram& datagram,
                                       terra::bus::SenderAddress sender) {
                        gate_node->OnAdviceBytes(IdOf(sender), datagram.payload,
                                                 now);
                      });
    });
    return std::unique_ptr<terra::bus::Node>(std::move(node));
  };
  return terra::bus::RunProcess(spec, argc, argv);
}
