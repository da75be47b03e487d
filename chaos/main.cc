// terra-chaos: a misbehaving advisor, to attack one's own deployment with.
// Listens to the map, BASELINE, VERDICT and, on the advice bus, ADVICE; sends
// what its faults make to the advice port (or, with --to deployed, to the other
// one); publishes STATUS, CONFIG; exits when asked to, after --for or --count,
// with 1 when the gate accepted what it must refuse.
#include <list>
#include <optional>

#include <CLI/CLI.hpp>

#include "bus/advice_receiver.h"
#include "bus/number_range.h"
#include "bus/process.h"
#include "chaos/chaos_node.h"
#include "chaos/datagram_socket.h"

namespace {

using terra::Result;
using terra::bus::AdviceReceiver;
using terra::chaos::AllFaults;
using terra::chaos::ChaosNode;
using terra::chaos::Datagram;
using terra::chaos::DatagramSocket;

struct Arguments {
  terra::chaos::ChaosOptions chaos;
  std::list<bool> chosen;  // One per fault; a list, as flags point into it.
  bool all = false;
  bool many_senders = false;
  std::uint64_t seed = 1;
  std::string to = "advice";
};

// What must outlive the node.
struct Connections {
  std::optional<DatagramSocket> out;
  std::optional<AdviceReceiver> overheard;
};

// Throws as CLI11 does for wrong usage.
void ChooseFaults(Arguments& arguments) {
  auto chosen = arguments.chosen.begin();
  for (const terra::chaos::Fault& fault : AllFaults()) {
    const bool by_all = arguments.all && fault.name != "offset-wrap";
    if (*chosen++ || by_all) arguments.chaos.faults.push_back(&fault);
  }
  if (arguments.chaos.faults.empty()) {
    throw CLI::ValidationError("which fault?",
                               "--all, or one or more of the flags of --help");
  }
}

void AddOptions(CLI::App& app, Arguments& arguments) {
  for (const terra::chaos::Fault& fault : AllFaults()) {
    arguments.chosen.push_back(false);
    app.add_flag("--" + std::string(fault.name), arguments.chosen.back(),
                 std::string(fault.help))
        ->group("Faults (with several, one of them at a time, by the seed)");
  }
  app.add_flag("--all", arguments.all,
               "every fault but offset-wrap, which ends other programs on the "
               "bus that read with liblcm (1.3.1 as 1.5.2)");
  app.add_flag("--flood", arguments.chaos.flood,
               "as fast as the machine can, instead of --rate");
  app.add_flag("--many-senders", arguments.many_senders,
               "each datagram from another port, past limits per sender");
  app.add_option("--rate", arguments.chaos.rate, "misdeeds a second")
      ->check(terra::bus::InRange(0.001, 1e6));
  app.add_option("--seed", arguments.seed, "the same seed, the same misdeeds");
  app.add_option("--for", arguments.chaos.duration_s,
                 "ends after so many seconds (0 = when asked to)")
      ->check(terra::bus::InRange(0.0, 1e6));
  app.add_option("--count", arguments.chaos.count,
                 "ends after so many misdeeds (0 = never)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--to", arguments.to,
                 "the port that is attacked. On the deployed one the faults of "
                 "bytes spoil what was overheard there, of every channel; it "
                 "is trusted: see docs/deployment.md for what an attack on it "
                 "can do")
      ->check(CLI::IsMember({"advice", "deployed"}));
  app.callback([&arguments] {
    ChooseFaults(arguments);
  });
}

Result<std::unique_ptr<terra::bus::Node>> MakeNode(
    Arguments& arguments, Connections& connections,
    terra::bus::ProcessContext& context) {
  const std::string& url =
      arguments.to == "advice" ? context.bus.advice_url : context.bus.lcm_url;
  Result<DatagramSocket> socket = DatagramSocket::Open(url);
  if (!socket) return socket.error();
  connections.out.emplace(*std::move(socket));
  Result<AdviceReceiver> overheard =
      AdviceReceiver::Open(context.bus.advice_url,
                           context.channels.name(terra::bus::Channel::kAdvice));
  if (!overheard) return overheard.error();
  connections.overheard.emplace(*std::move(overheard));

  const bool many_senders = arguments.many_senders;
  auto send = [&connections, url, many_senders](const Datagram& datagram) {
    if (many_senders) {
      Result<DatagramSocket> fresh = DatagramSocket::Open(url);
      if (fresh) *connections.out = *std::move(fresh);
    }
    return connections.out->Send(datagram);
  };
  auto node = std::make_unique<ChaosNode>(
      arguments.chaos,
      terra::chaos::Attacker({context.name, context.out.session(),
                              context.channels, arguments.seed,
                              arguments.to == "deployed"}),
      context.out, send);
  ChaosNode* listener = node.get();
  AdviceReceiver& receiver = *connections.overheard;
  context.loop.Watch(
      receiver.fd(), [&receiver, listener](terra::bus::Time now) {
        receiver.Drain(terra::bus::MonotonicMicroseconds(now), 64,
                       [listener](const terra::bus::LcmDatagram& datagram,
                                  terra::bus::SenderAddress) {
                         listener->Overhear(datagram.payload);
                       });
      });
  return std::unique_ptr<terra::bus::Node>(std::move(node));
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Connections connections;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-chaos";
  spec.name = "chaos";
  spec.is_advisor = true;
  spec.description =
      "A misbehaving advisor: attacks a running set the way a broken or "
      "hostile advisor would, says what the gate made of it, and exits with 1 "
      "when the gate accepted what it must refuse.\n"
      "examples:\n"
      "  terra-chaos --all --for 60 --seed 7\n"
      "  terra-chaos --flood --honest --for 10\n"
      "  terra-chaos --through-obstacles --wrong-map --rate 5 --count 100\n"
      "  terra-chaos --hostile-counts --to deployed --for 10";
  spec.add_options = [&](CLI::App& app) {
    AddOptions(app, arguments);
  };
  spec.make_node = [&](terra::bus::ProcessContext& context) {
    return MakeNode(arguments, connections, context);
  };
  return terra::bus::RunProcess(spec, argc, argv);
}
