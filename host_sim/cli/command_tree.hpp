#pragma once
// The commands of a program as plain data, read from its CLI::App: what completion and manual pages
// are made of.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

enum class ValueKind : std::uint8_t { none, choice, number, text };

struct OptionText {
  std::vector<std::string> names;  // "--json", "-h"; of an argument its name alone, "FILE"
  std::string description;
  ValueKind value = ValueKind::none;
  std::vector<std::string> choices;
  std::string default_value;  // empty: none, or not worth printing
  std::string group;          // of the help text
  bool required = false;
  bool many = false;  // more than one value
};

struct CommandText {
  std::string name;  // with those above it: "volcomp run xyfz"
  std::string description;
  std::vector<OptionText> options;
  std::vector<OptionText> arguments;
  std::vector<CommandText> commands;
};

[[nodiscard]] CommandText command_tree(const CLI::App& app);

// The tree as a list, a command before those below it. It refers to the tree.
[[nodiscard]] std::vector<const CommandText*> all_commands(const CommandText& tree);

}  // namespace volcomp::cli
