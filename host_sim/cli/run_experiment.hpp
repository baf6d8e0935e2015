#pragma once
// What every command of volcomp run does around its experiment.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/cli/run_view.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::cli {

// Where an experiment makes its machines. It outlives them; the view sees every cycle of them.
class RunPlace {
 public:
  // Joins the bus, if there is one.
  RunPlace(const RunArguments& arguments, RunView& view);

  // Empty for the integrated form.
  [[nodiscard]] sim::BusAxesFactory axes();
  // For machines of this machine file, integrated or on the bus.
  [[nodiscard]] sim::CellFactory cells(const std::filesystem::path& machine);
  [[nodiscard]] sim::MachineWatch& watch() { return view_; }
  // How many machines may move at a time: those on a bus share it.
  [[nodiscard]] std::size_t threads() const { return bus_ ? 1 : host::processors(); }
  // For the document, which is made after the run.
  [[nodiscard]] host::RunContext context() const;

  [[nodiscard]] ScenarioBus* bus() { return bus_.get(); }

 private:
  const RunArguments& arguments_;
  RunView& view_;
  std::unique_ptr<ScenarioBus> bus_;  // null: integrated
};

// What an experiment hands to its command.
// NOLINTNEXTLINE(bugprone-exception-escape): nothing in nlohmann::json throws when moved
struct RunOutcome {
  std::string summary;      // for people
  nlohmann::json document;  // of the report
  nlohmann::json figures;   // for programs; where the node was is added
  bool good = false;        // the verdict
  std::string folder = {};  // for `files`; empty: none are written
  std::vector<host::NamedText> files = {};
  std::string file_lines = {};  // about them, for people
};

// Runs the experiment and writes what comes of it. `inputs`: files it reads besides the machine
// file. Returns the exit code; throws UserError.
using Experiment = std::function<RunOutcome(RunPlace& place, const host::Progress& progress)>;
[[nodiscard]] int run_experiment(const RunArguments& arguments,
                                 const std::vector<std::string>& inputs,
                                 const Experiment& experiment);

// The same for an experiment with arguments of its own.
template <class Arguments>
[[nodiscard]] int run_experiment(const Arguments& arguments, const std::vector<std::string>& inputs,
                                 RunOutcome (*experiment)(RunPlace&, const Arguments&,
                                                          const host::Progress&)) {
  return run_experiment(
      static_cast<const RunArguments&>(arguments), inputs,
      [&](RunPlace& place, const host::Progress& p) { return experiment(place, arguments, p); });
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

}  // namespace volcomp::cli
