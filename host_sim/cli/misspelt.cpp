#include "host_sim/cli/misspelt.hpp"

#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/cli/command_tree.hpp"
#include "host_sim/host/io/nearest_word.hpp"

namespace volcomp::cli {
namespace {

std::vector<std::string> names_below(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_below(app))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
  return names;
}

std::string unknown(const char* what, const std::string& word,
                    const std::vector<std::string>& known, const std::string& remedy) {
  const std::string nearest = host::nearest_word(word, known);
  return fmt::format("unknown {} \"{}\"{}{}", what, word,
                     nearest.empty() ? "" : fmt::format(", did you mean \"{}\"?", nearest), remedy);
}

}  // namespace

std::string misspelt(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.rfind("--", 0) == 0 && word.size() > 2) {
      const std::string name = word.substr(0, word.find('='));
      const CLI::Option* option = command->get_option_no_throw(name);
      if (option == nullptr)
        return unknown("option", name, option_names(*command),
                       fmt::format(" (all: {} --help)", full_name(*command)));
      const bool has_value = option->get_items_expected_max() > 0;
      if (has_value && name.size() == word.size()) ++i;
      continue;
    }
    if (word.rfind('-', 0) == 0 || command->get_require_subcommand_min() == 0) continue;
    const CLI::App* below = command_named(*command, word);
    if (below == nullptr)
      return unknown("command", word, names_below(*command),
                     fmt::format(" (known: {})", fmt::join(names_below(*command), ", ")));
    command = below;
  }
  return {};
}

}  // namespace volcomp::cli
