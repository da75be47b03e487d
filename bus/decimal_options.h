#pragma once

namespace CLI {
class App;
}

namespace terra::bus {

/// Lets the whole numbers among the options of a program and its subcommands
/// be decimal alone and fit into 64 bits. CLI11 would read 050 as 40, and take
/// 2^64 - 1 for what is larger or, where no sign is expected, for -1.
/// Pre: all options are there; nothing is parsed yet.
void TakeDecimalNumbersOnly(CLI::App& app);

}  // namespace terra::bus
