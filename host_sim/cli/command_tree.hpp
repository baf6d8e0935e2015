#pragma once
// The commands of a program and the values of their options, read from its CLI::App: what
// completion, the manual page and the remedy for a misspelt word are made of.

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

enum class ValueKind : std::uint8_t { none, choice, number, text };

struct OptionValue {
  ValueKind kind = ValueKind::none;
  std::vector<std::string> choices;
};

[[nodiscard]] OptionValue value_of(const CLI::Option& option);

// "-h", "--help"; of an argument its name alone, "FILE".
[[nodiscard]] std::vector<std::string> names_of(const CLI::Option& option);

// In the order of the help text, without what it hides.
[[nodiscard]] std::vector<const CLI::Option*> shown_options(const CLI::App& command);
[[nodiscard]] std::vector<const CLI::Option*> shown_arguments(const CLI::App& command);

// The commands directly below.
[[nodiscard]] std::vector<const CLI::App*> commands_below(const CLI::App& command);
// One of them, or null.
[[nodiscard]] const CLI::App* command_named(const CLI::App& above, const std::string& name);
// The program and all its commands, each before those below it.
[[nodiscard]] std::vector<CLI::App*> all_commands(CLI::App& program);
// With those above it: "volcomp run xyfz".
[[nodiscard]] std::string full_name(const CLI::App& command);

}  // namespace volcomp::cli
