// Log files: every byte is told as an event or as damage, and what reads logs
// (info, audit, report) comes to an end with any of them.

#include <algorithm>
#include <span>
#include <vector>

#include "logger/audit.h"
#include "logger/log_info.h"
#include "logger/log_reader.h"
#include "logger/report.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace terra::logger;

void CheckEveryByteIsTold(std::span<const std::uint8_t> bytes) {
  LogReader reader(bytes);
  std::int64_t events = 0;
  while (const auto item = reader.Next()) {
    terra::fuzz::Require(
        item->raw.data() == bytes.data() + item->offset || item->raw.empty(),
        "an event is where it says");
    std::vector<std::uint8_t> again;
    AppendLogEvent(again, item->event);
    terra::fuzz::Require(std::ranges::equal(again, item->raw),
                         "an event is written as it was read");
    events += static_cast<std::int64_t>(item->raw.size());
  }
  terra::fuzz::Require(events + reader.num_damaged_bytes() ==
                           static_cast<std::int64_t>(bytes.size()),
                       "each byte is in an event or damaged");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  CheckEveryByteIsTold(bytes);
  LogReader for_info(bytes);
  const LogInfo info = Inspect(for_info);
  LogReader for_audit(bytes);
  const Audit audit = AuditLog(for_audit);
  terra::fuzz::Require(info.num_damaged_bytes == 0 || !audit.clean(),
                       "an audit does not pass over damage");
  LogReader for_report(bytes);
  MakeReport("input", for_report);
  return 0;
}
