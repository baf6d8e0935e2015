#include "host_sim/cli/command_tree.hpp"

#include <sstream>

namespace volcomp::cli {
namespace {

// "TEXT:{lsq,end}": the validator describes its choices.
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  std::vector<std::string> choices;
  std::istringstream list(type.substr(open + 1, close - open - 1));
  for (std::string choice; std::getline(list, choice, ',');)
    choices.push_back(choice);
  return choices;
}

OptionText option_text(const CLI::Option& option) {
  OptionText text;
  for (const std::string& name : option.get_snames())
    text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    text.names.push_back("--" + name);
  if (option.get_positional()) text.names.push_back(option.get_name(true));
  text.description = option.get_description();
  text.default_value = option.get_default_str();
  text.group = option.get_group();
  text.required = option.get_required();
  text.many = option.get_items_expected_max() > 1;
  const std::string type = option.get_type_name();
  text.choices = choices_of(type);
  if (option.get_items_expected_max() == 0) {
    text.value = ValueKind::none;
  } else if (!text.choices.empty()) {
    text.value = ValueKind::choice;
  } else {
    text.value = type.rfind("TEXT", 0) == 0 ? ValueKind::text : ValueKind::number;
  }
  return text;
}

// Commands are three deep at most.
// NOLINTBEGIN(misc-no-recursion)
CommandText command_text(const CLI::App& app, const std::string& above) {
  CommandText command;
  command.name = above.empty() ? app.get_name() : above + " " + app.get_name();
  command.description = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    (option->get_positional() ? command.arguments : command.options)
        .push_back(option_text(*option));
  }
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
    command.commands.push_back(command_text(*below, command.name));
  return command;
}

void collect(const CommandText& command, std::vector<const CommandText*>& all) {
  all.push_back(&command);
  for (const CommandText& below : command.commands)
    collect(below, all);
}

// NOLINTEND(misc-no-recursion)

}  // namespace

CommandText command_tree(const CLI::App& app) { return command_text(app, {}); }

std::vector<const CommandText*> all_commands(const CommandText& tree) {
  std::vector<const CommandText*> all;
  collect(tree, all);
  return all;
}

}  // namespace volcomp::cli
