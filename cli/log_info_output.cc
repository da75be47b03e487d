#include "cli/log_info_output.h"

#include <cstdio>
#include <ostream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/utc.h"
#include "cli/output.h"

namespace terra::cli {
namespace {

using logger::ChannelInfo;
using logger::LogInfo;

constexpr std::size_t kPlacesShown = 20;

std::string Time(std::int64_t time_us) {
  const std::string text = FormatUtc(time_us / 1'000'000, "%Y-%m-%d %H:%M:%S");
  if (text.empty()) return std::to_string(time_us) + " us";
  return text + Printed(".%06d UTC", static_cast<int>(time_us % 1'000'000));
}

long long Wide(std::int64_t value) {
  return value;
}

double Seconds(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * (static_cast<double>(to_us) - static_cast<double>(from_us));
}

void PrintChannels(const LogInfo& info, std::ostream& out) {
  out << Printed("\n%-24s %9s %8s %12s %8s %8s %8s %5s\n", "channel", "events",
                 "Hz", "bytes", "missing", "repeat", "badform", "sess");
  for (const auto& [name, channel] : info.channels) {
    out << Printed("%-24s %9lld %8.2f %12lld", name.c_str(),
                   Wide(channel.events), channel.rate_hz(),
                   Wide(channel.bytes));
    if (channel.is_ours) {
      out << Printed(" %8lld %8lld %8lld %5lld", Wide(channel.missing),
                     Wide(channel.repeated), Wide(channel.malformed),
                     Wide(channel.sessions));
    }
    out << "\n";
  }
}

void PrintFaults(const LogInfo& info, std::ostream& out) {
  if (info.num_damaged_places > 0) {
    out << Printed("\nDAMAGE: %lld bytes at %lld places are no events\n",
                   Wide(info.num_damaged_bytes), Wide(info.num_damaged_places));
  }
  for (std::size_t i = 0; i < info.damage.size() && i < kPlacesShown; ++i) {
    out << Printed(
        "  %lld bytes at byte %lld%s\n", Wide(info.damage[i].bytes),
        Wide(info.damage[i].offset),
        info.damage[i].torn_end ? " (the file ends in an event)" : "");
  }
  if (info.num_broken_seals > 0) {
    out << Printed("\nCHANGED: %lld seals do not fit\n",
                   Wide(info.num_broken_seals));
    for (std::size_t i = 0; i < info.broken_seals.size() && i < kPlacesShown;
         ++i) {
      out << Printed("  %lld bytes at byte %lld: ",
                     Wide(info.broken_seals[i].bytes),
                     Wide(info.broken_seals[i].offset))
          << info.broken_seals[i].reason << "\n";
    }
  }
  if (!info.read_error.empty()) {
    out << "\nREAD ERROR: " << info.read_error << "\n";
  }
}

}  // namespace

void PrintLogInfo(const LogInfo& info, std::ostream& out) {
  out << Printed("%lld bytes, %lld events", Wide(info.file_bytes),
                 Wide(info.events));
  if (info.events > 0) {
    out << Printed(", %.3f s\nfrom %s\nto   %s",
                   Seconds(info.first_us, info.last_us),
                   Time(info.first_us).c_str(), Time(info.last_us).c_str());
  }
  out << "\n";
  if (info.sealed) {
    out << Printed("%lld good seals, ", Wide(info.good_seals))
        << (info.closed ? "closed in order" : "not closed: cut or still open");
    if (info.unsealed_bytes > 0) {
      out << Printed(", %lld bytes after the last seal",
                     Wide(info.unsealed_bytes));
    }
    out << Printed(
        "\n%lld events of state from before, %lld lost by the "
        "recorder\n",
        Wide(info.snapshot_events), Wide(info.lost));
  } else {
    out << "no seals: not a log of terra-logger; changed bytes go unnoticed\n";
  }
  if (info.header) {
    out << "part " << info.header->part << "; " << info.header->mark_text
        << "\n";
  }
  PrintChannels(info, out);
  PrintFaults(info, out);
}

void PrintLogInfoJson(const LogInfo& info, std::ostream& out) {
  nlohmann::json channels = nlohmann::json::object();
  for (const auto& [name, channel] : info.channels) {
    nlohmann::json entry = {{"events", channel.events},
                            {"bytes", channel.bytes},
                            {"rate_hz", channel.rate_hz()},
                            {"first_us", channel.first_us},
                            {"last_us", channel.last_us}};
    if (channel.is_ours) {
      entry["missing"] = channel.missing;
      entry["repeated"] = channel.repeated;
      entry["malformed"] = channel.malformed;
      entry["sessions"] = channel.sessions;
    }
    channels[name] = entry;
  }
  nlohmann::json damage = nlohmann::json::array();
  for (const logger::LogDamage& place : info.damage) {
    damage.push_back({{"offset", place.offset},
                      {"bytes", place.bytes},
                      {"torn_end", place.torn_end}});
  }
  nlohmann::json broken = nlohmann::json::array();
  for (const auto& seal : info.broken_seals) {
    broken.push_back({{"offset", seal.offset},
                      {"bytes", seal.bytes},
                      {"reason", seal.reason}});
  }
  nlohmann::json all = {{"intact", info.intact()},
                        {"file_bytes", info.file_bytes},
                        {"events", info.events},
                        {"first_us", info.first_us},
                        {"last_us", info.last_us},
                        {"snapshot_events", info.snapshot_events},
                        {"channels", channels},
                        {"damaged_places", info.num_damaged_places},
                        {"damaged_bytes", info.num_damaged_bytes},
                        {"damage", damage},
                        {"read_error", info.read_error},
                        {"sealed", info.sealed},
                        {"closed", info.closed},
                        {"good_seals", info.good_seals},
                        {"broken_seals", broken},
                        {"num_broken_seals", info.num_broken_seals},
                        {"unsealed_bytes", info.unsealed_bytes},
                        {"lost", info.lost}};
  // Channel names and texts are whatever somebody sent.
  out << all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
      << "\n";
}

}  // namespace terra::cli
