#pragma once
// What the scenarios of volcomp run have in common: where the node is, where the figures go.

#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/cli/scenario_bus.hpp"
#include "host_sim/scenarios/progress.hpp"

namespace volcomp::sim {

struct RunArguments {
  std::string machine;        // empty: the one that comes with the program
  std::string json_file;      // empty: none
  std::string report_folder;  // empty: none
  std::string command;        // as the user has typed it
  NodePlace node;
};

// File and path as the user would type them, without the folder of the program.
[[nodiscard]] std::string command_line(int argc, char** argv);

CLI::Option* add_output_options(CLI::App& scenario, RunArguments& arguments);
// The same for a scenario whose machine is not read from a file.
CLI::Option* add_figure_options(CLI::App& scenario, RunArguments& arguments);
// Cycle and log: only for a node on a bus.
std::vector<CLI::Option*> add_bus_options(CLI::App& scenario, NodePlace& node);

[[nodiscard]] std::filesystem::path machine_of(const RunArguments& arguments,
                                               const std::string& bundled);

void write_figures(const RunArguments& arguments, nlohmann::json figures);
void write_pages(const RunArguments& arguments, const nlohmann::json& document);

// An option that takes one of these words; the first is its default in the help text.
template <class Choice>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Choice& value,
                        const std::map<std::string, Choice>& words, const std::string& what) {
  std::string list;
  for (const auto& [word, choice] : words)
    list += (list.empty() ? "" : "|") + word;
  return app.add_option(name, value, fmt::format("{}: {}", what, list))
      ->transform(CLI::Transformer(words, CLI::ignore_case).description(""))
      ->default_str(words.begin()->first);
}

// `scenario(progress)` with a bar on the terminal, and the bus brought to its end.
template <class Scenario>
auto run_watched(ScenarioBus* bus, const Scenario& scenario) {
  ProgressBar bar;
  const auto run = [&] {
    return scenario([&bar](double done, const std::string& what) { bar.show(done, what); });
  };
  auto result = bus != nullptr ? bus->watch(run) : run();
  if (bus != nullptr) bus->finish();
  return result;
}

}  // namespace volcomp::sim
