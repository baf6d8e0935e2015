#pragma once
// A command line that cannot be parsed because a command or an option is misspelt.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

// The first word that is no command or option where one is expected, with the known one that it may
// have been: "unknown command \"simulte\", did you mean \"simulate\"?". Empty where all are known.
// `words`: the command line without the name of the program.
[[nodiscard]] std::string misspelt(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace volcomp::cli
