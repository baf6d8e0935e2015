// volcomp: the host tool. Exit codes: exit_codes.hpp.

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "host_sim/cli/command_tree.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/completion.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/nearest_word.hpp"
#include "host_sim/host/io/version.hpp"

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

// The first word that is no command or option where one is expected, with the known one that it may
// have been: "unknown command \"simulte\", did you mean \"simulate\"?". Empty where all are known.
// `words`: the command line without the name of the program.
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

// An empty value is what an unset variable of a shell leaves, and would pass for "not given".
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator given{[](const std::string& value) {
                               return std::string(value.empty() ? "the value is empty" : "");
                             },
                             ""};
  for (CLI::App* command : all_commands(app)) {
    for (CLI::Option* option : command->get_options()) {
      const bool takes_none = option->get_name() == "--gear";  // "": no gear
      if (option->get_items_expected_max() > 0 && !takes_none) option->check(given);
    }
  }
}

// Nothing may be thrown here, not even where standard error takes nothing.
void complain(const std::string& what) {
  const std::string line = "volcomp: " + what + standing_results() + '\n';
  static_cast<void>(std::fputs(line.c_str(), stderr));
}

struct Command {
  const char* name;  // nullptr: several
  std::function<void(CLI::App&)> add;
};

std::vector<Command> all_own_commands(int argc, char** argv, int& code) {
  const auto with = [&code](void (*add)(CLI::App&, int&)) {
    return [add, &code](CLI::App& app) { add(app, code); };
  };
  const auto with_line = [argc, argv, &code](void (*add)(CLI::App&, int, char**, int&)) {
    return [add, argc, argv, &code](CLI::App& app) { add(app, argc, argv, code); };
  };
  return {{"run", with_line(add_run_command)},
          {"collect", with(add_collect_command)},
          {"build-tables", with(add_build_tables_command)},
          {"export-tables", with(add_export_tables_command)},
          {"import", with(add_import_command)},
          {"dump", with(add_dump_command)},
          {"evaluate", with(add_evaluate_command)},
          {"calibrate-probe", with(add_calibrate_probe_command)},
          {"inspect", with(add_inspect_command)},
          {"check-lever", with(add_check_lever_command)},
          {"evaluate-ballbar", with_line(add_evaluate_ballbar_command)},
          {"plan", with_line(add_plan_command)},
          {"identify", with_line(add_identify_command)},
          {"learn", with_line(add_learn_command)},
          {"uncertainty", with_line(add_uncertainty_command)},
          {"verify", with_line(add_verify_command)},
          {"simulate", with(add_simulate_command)},
          {"machine", with(add_machine_command)},
          {"list", with(add_list_command)},
          {"device-files", with(add_device_files_command)},
          {"drive", with(add_drive_command)},
          {"explain", with(add_explain_command)},
          {"setup", with(add_setup_command)},
          {nullptr, with(add_can_commands)},
          {"monitor", with(add_monitor_command)},
          {"replay", with(add_replay_command)},
          {"bus-load", with(add_bus_load_command)},
          {"compare", with_line(add_compare_command)},
          {nullptr, with(add_completion_command)},  // describes all
          {nullptr, with(add_man_command)}};        // the same
}

// Only the one that is called where that is known: describing the options of all takes longer than
// what many commands do.
void add_commands(CLI::App& app, int argc, char** argv, int& code) {
  const std::vector<Command> commands = all_own_commands(argc, argv, code);
  const std::string called = argc > 1 ? argv[1] : "";
  for (const Command& command : commands)
    if (command.name != nullptr && command.name == called) return command.add(app);
  for (const Command& command : commands)
    command.add(app);
}

int run(int argc, char** argv) {
  CLI::App app{
      "Volumetric error compensation for machine tools: simulate, build tables, check machines."};
  app.name("volcomp");
  app.set_version_flag("--version", std::string("volcomp ") + host::kVersion);
  app.require_subcommand(1);
  app.footer(exit_code_lines());
  int code = 0;
  add_commands(app, argc, argv, code);
  refuse_empty_values(app);
  if (argc > 1 && argv[1] == std::string(kCompleteCommand)) {
    code = print_candidates(app, {argv + 2, argv + argc});
    finish_standard_output();
    return code;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const std::string unknown =
        e.get_exit_code() == 0 ? "" : misspelt(app, {argv + 1, argv + argc});
    if (unknown.empty()) return app.exit(e) == 0 ? 0 : number(ExitCode::unusable);
    complain(unknown);
    return number(ExitCode::unusable);
  }
  finish_standard_output();
  return code;
}

}  // namespace

}  // namespace volcomp::cli

int main(int argc, char** argv) {
  try {
    return volcomp::cli::run(argc, argv);
  } catch (const volcomp::host::Interrupted& interrupted) {
    static_cast<void>(std::raise(interrupted.signal));  // the parent process sees the signal
  } catch (const std::exception& e) {
    volcomp::cli::complain(e.what());
  } catch (...) {
    volcomp::cli::complain("unknown error");
  }
  return volcomp::cli::number(volcomp::cli::ExitCode::unusable);
}
