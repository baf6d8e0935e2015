#include "host_sim/cli/command_tree.hpp"

#include <cstddef>
#include <utility>

namespace volcomp::cli {
namespace {

constexpr auto kAll = [](const CLI::App*) { return true; };

// "TEXT:{lsq,end}": the validator describes its choices.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::vector<const CLI::Option*> shown(const CLI::App& command, bool arguments) {
  return command.get_options([&](const CLI::Option* option) {
    return !option->get_group().empty() && option->get_positional() == arguments;
  });
}

}  // namespace

OptionValue value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  const std::string type = option.get_type_name();
  if (std::vector<std::string> choices = choices_in(type); !choices.empty())
    return {ValueKind::choice, std::move(choices)};
  return {type.rfind("TEXT", 0) == 0 ? ValueKind::text : ValueKind::number, {}};
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames())
    names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    names.push_back("--" + name);
  return names;
}

std::vector<const CLI::Option*> shown_options(const CLI::App& command) {
  return shown(command, false);
}

std::vector<const CLI::Option*> shown_arguments(const CLI::App& command) {
  return shown(command, true);
}

std::vector<const CLI::App*> commands_below(const CLI::App& command) {
  return command.get_subcommands(kAll);
}

const CLI::App* command_named(const CLI::App& above, const std::string& name) {
  for (const CLI::App* command : commands_below(above))
    if (command->get_name() == name) return command;
  return nullptr;
}

std::vector<CLI::App*> all_commands(CLI::App& program) {
  std::vector<CLI::App*> all{&program};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<CLI::App*> below = all[i]->get_subcommands(kAll);
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, below.begin(), below.end());
  }
  return all;
}

std::string full_name(const CLI::App& command) {
  std::string name = command.get_name();
  for (const CLI::App* above = command.get_parent(); above != nullptr; above = above->get_parent())
    name.insert(0, above->get_name() + " ");
  return name;
}

}  // namespace volcomp::cli
