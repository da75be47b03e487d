#pragma once

namespace CLI {
class App;
}

namespace terra::bus {

/// Lets --config read TOML 1.0 and nothing else: `option = value` at the top of
/// the file. Refused, with the line: what is no TOML (a string without its end,
/// a value without quotes), a section, a date, a key with more than 32 dots, a
/// file above 64 kB.
void ReadConfigAsToml(CLI::App& app);

}  // namespace terra::bus
