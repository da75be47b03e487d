// terra-advisor: proposes cheaper routes.
// Listens to the map and BASELINE on the deployed bus and sends nothing there;
// publishes ADVICE, MAP_REQUEST, STATUS and CONFIG on the advice bus; exits
// when asked to (SIGINT, SIGTERM) or when it has no bus.
#include <memory>
#include <string>

#include "advisor/advisor_node.h"
#include "advisor/advisor_options.h"
#include "base/secrets.h"
#include "bus/log.h"
#include "bus/process.h"

int main(int argc, char** argv) {
  terra::advisor::AdvisorOptions options;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-advisor";
  spec.name = "advisor";
  spec.is_advisor = true;
  spec.description =
      "Proposes routes that are cheaper than the baseline. Any number may run, "
      "under different names.\nexample: terra-advisor --name search --backend "
      "search";
  spec.add_options = [&](CLI::App& app) {
    terra::advisor::AddAdvisorOptions(app, options);
  };
  spec.make_node = [&](terra::bus::ProcessContext& context)
      -> terra::Result<std::unique_ptr<terra::bus::Node>> {
    terra::LeaveNoCore();
    auto backend = terra::advisor::MakeBackend(options);
    if (!backend) return backend.error();
    if (const std::string notice = (*backend)->notice(); !notice.empty()) {
      terra::bus::LogWarning(notice);
    }
    terra::bus::Inbox& inbox = context.inbox;
    return std::unique_ptr<terra::bus::Node>(
        std::make_unique<terra::advisor::AdvisorNode>(
            context.name, *std::move(backend), context.out, [&inbox] {
              inbox.Wake();
            }));
  };
  return terra::bus::RunProcess(spec, argc, argv);
}
