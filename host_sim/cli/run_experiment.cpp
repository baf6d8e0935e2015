#include "host_sim/cli/run_experiment.hpp"

#include <utility>

#include <fmt/format.h>

#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"
#include "host_sim/sim/controller/tick_tables.hpp"

namespace volcomp::cli {
namespace {

// Where the figures, the log and the report go, before anything is read.
Results results_of(const RunArguments& arguments, std::vector<std::string> inputs) {
  inputs.insert(inputs.end(), {arguments.machine, arguments.node.firmware.image.string()});
  return Results(
      with_report({arguments.json_file, arguments.node.log_file}, arguments.report_folder),
      std::move(inputs), arguments.report_folder);
}

// Passes the progress or the reason of a failure to the live page, too.
RunOutcome run_watched(RunPlace& place, RunView& view, const Experiment& experiment) {
  try {
    return run_with_bar(place.bus(), [&](const host::Progress& bar) {
      return experiment(place, [&](double done, const std::string& what) {
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

}  // namespace

RunPlace::RunPlace(const RunArguments& arguments, RunView& view)
    : arguments_(arguments), view_(view) {
  if (!arguments.node.integrated()) bus_ = std::make_unique<ScenarioBus>(arguments.node, &view);
}

sim::BusAxesFactory RunPlace::axes() { return bus_ ? bus_->axes() : sim::BusAxesFactory(); }

sim::CellFactory RunPlace::cells(const std::filesystem::path& machine) {
  const host::MachineFile file = host::read_machine_file(machine);
  if (bus_) return bus_->cells(file);
  std::string letters;
  for (const host::AxisFile& axis : file.axes)
    letters += axis.letter;
  return sim::watched_integrated_cells(letters, view_);
}

host::RunContext RunPlace::context() const {
  return {arguments_.command, describe(arguments_.node), [&view = view_] {
            return view.ticks().periods() > 0 ? sim::tick_tables(view.ticks())
                                              : nlohmann::json::array();
          }};
}

int run_experiment(const RunArguments& arguments, const std::vector<std::string>& inputs,
                   const Experiment& experiment) {
  Results results = results_of(arguments, inputs);
  if (arguments.live.port) require_page("--serve");
  const std::string transport = describe(arguments.node);
  RunView view(arguments.live, arguments.command, transport, results.text());
  RunPlace place(arguments, view);
  RunOutcome outcome = run_watched(place, view, experiment);
  fmt::print(results.text(), "{}transport: {}\n", outcome.summary, transport);
  if (!outcome.folder.empty()) results.add_files(outcome.folder, outcome.files);
  if (!arguments.report_folder.empty())
    add_report(results, arguments.report_folder, outcome.document);
  outcome.figures["transport"] = transport;
  results.add(arguments.json_file, json_text(outcome.figures));
  results.write();
  fmt::print(results.text(), "{}", outcome.file_lines);
  if (!arguments.report_folder.empty())
    fmt::print(results.text(), "report: {}\n", report_page(arguments.report_folder));
  view.ended(outcome.document);
  return number(outcome.good ? ExitCode::done : ExitCode::negative);
}

}  // namespace volcomp::cli
