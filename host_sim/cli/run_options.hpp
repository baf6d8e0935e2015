#pragma once
// What the scenarios of volcomp run have in common: where the node is, where the figures go.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host_sim/cli/output.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/cli/run_view.hpp"
#include "host_sim/cli/scenario_bus.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::cli {

struct RunArguments {
  std::string machine;        // empty: the one that comes with the program
  std::string json_file;      // empty: none
  std::string report_folder;  // empty: none
  std::string command;        // as the user has typed it
  NodePlace node;
  LiveChoice live;
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

// Refuses an option that writes or shows pages in a program that was built without them.
void require_page(const std::string& option);

// Watches the run from its beginning; must outlive every machine and bus of it.
[[nodiscard]] std::unique_ptr<RunView> run_view(const RunArguments& arguments,
                                                const Results& results);
[[nodiscard]] host::RunContext run_context(const RunArguments& arguments, const RunView& view);
// Where the figures, the log and the report of a run go, before anything is read: the machine file
// and `more_inputs`.
[[nodiscard]] Results run_results(const RunArguments& arguments,
                                  const std::vector<std::string>& more_inputs = {});
// Report and figures, and all that was added before them.
void write_results(const RunArguments& arguments, const nlohmann::json& document,
                   nlohmann::json figures, Results& results);

// `names` and those of a report, if a folder for one is given; refused without require_page().
[[nodiscard]] std::vector<std::string> with_report(std::vector<std::string> names,
                                                   const std::string& folder);
void add_report(Results& results, const std::string& folder, const nlohmann::json& document);

// An option that takes one of these words; the help text shows that of `value` as its default.
template <class Choice>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Choice& value,
                        const std::map<std::string, Choice>& words, const std::string& what) {
  std::string list;
  std::string usual;
  for (const auto& [word, choice] : words) {
    list += (list.empty() ? "" : ",") + word;
    if (choice == value) usual = word;
  }
  // As CLI::IsMember describes itself.
  return app.add_option(name, value, what)
      ->transform(CLI::Transformer(words, CLI::ignore_case).description("{" + list + "}"))
      ->default_str(usual);
}

// `scenario(progress)` with a bar on the terminal, and the bus brought to its end.
template <class Scenario>
auto run_with_bar(ScenarioBus* bus, const Scenario& scenario) {
  ProgressBar bar;
  const auto run = [&] {
    return scenario([&bar](double done, const std::string& what) { bar.show(done, what); });
  };
  auto result = bus != nullptr ? bus->watch(run) : run();
  if (bus != nullptr) bus->finish();
  return result;
}

// The same, and passes the progress or the reason of a failure to the live page.
template <class Scenario>
auto run_watched(RunView& view, ScenarioBus* bus, const Scenario& scenario) {
  try {
    return run_with_bar(bus, [&](const host::Progress& bar) {
      return scenario([&](double done, const std::string& what) {
        bar(done, what);
        view.progress(done, what);
      });
    });
  } catch (const host::Interrupted&) {
    throw;
  } catch (const std::exception& reason) {
    view.failed(reason.what());
    throw;
  }
}

}  // namespace volcomp::cli
