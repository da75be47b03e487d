// terra-advisor: proposes cheaper routes.
// Listens to the map and BASELINE; publishes ADVICE on the advice bus, STATUS
// and CONFIG on the deployed one; exits when asked to (SIGINT, SIGTERM) or when
// it has no bus.
#include <memory>
#include <string>

#include "advisor/advisor_node.h"
#include "advisor/advisor_options.h"
#include "bus/bus.h"
#include "bus/log.h"
#include "bus/process.h"
#include "bus/secrets.h"

int main(int argc, char** argv) {
  terra::advisor::AdvisorOptions options;
  std::unique_ptr<terra::bus::Bus> advice_bus;
  std::unique_ptr<terra::bus::Outbox> advice_out;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-advisor";
  spec.name = "advisor";
  spec.description =
      "Proposes routes that are cheaper than the baseline. Any number may run, "
      "under different names.\nexample: terra-advisor --name search --backend "
      "search";
  spec.add_options = [&](CLI::App& app) {
    terra::advisor::AddAdvisorOptions(app, options);
  };
  spec.make_node = [&](terra::bus::ProcessContext& context)
      -> terra::Result<std::unique_ptr<terra::bus::Node>> {
    terra::bus::LeaveNoCore();
    auto backend = terra::advisor::MakeBackend(options);
    if (!backend) return backend.error();
    if (const std::string notice = (*backend)->notice(); !notice.empty()) {
      terra::bus::LogWarning(notice);
    }
    if (!context.bus.OneBus()) {
      auto opened =
          terra::bus::Bus::Open(context.bus.advice_url, context.channels);
      if (!opened) return opened.error();
      advice_bus = *std::move(opened);
      advice_out = std::make_unique<terra::bus::Outbox>(*advice_bus,
                                                        context.out.session());
    }
    terra::bus::Outbox& advice = advice_out ? *advice_out : context.out;
    terra::bus::Inbox& inbox = context.inbox;
    return std::unique_ptr<terra::bus::Node>(
        std::make_unique<terra::advisor::AdvisorNode>(
            context.name, *std::move(backend), context.out, advice, [&inbox] {
              inbox.Wake();
            }));
  };
  return terra::bus::RunProcess(spec, argc, argv);
}
