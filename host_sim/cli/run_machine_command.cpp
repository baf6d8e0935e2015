// volcomp run machine

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/experiments/any_machine/figures.hpp"
#include "host_sim/experiments/any_machine/report.hpp"

namespace volcomp::cli {
namespace {

struct MachineArguments : RunArguments {
  any_machine::MachineOptions options;
};

std::string letters_of(const host::MachineFile& machine) {
  std::string letters;
  for (const host::AxisFile& axis : machine.axes)
    letters += axis.letter;
  return letters;
}

int run_machine_command(const MachineArguments& arguments) {
  any_machine::MachineOptions options = arguments.options;
  options.machine = machine_of(arguments, "trunnion");
  Results results = run_results(arguments);
  const std::unique_ptr<RunView> view = run_view(arguments, results);
  const host::MachineFile file = host::read_machine_file(options.machine);
  std::unique_ptr<ScenarioBus> bus;
  if (arguments.node.integrated()) {
    options.make_cell = sim::watched_integrated_cells(letters_of(file), *view);
  } else {
    bus = std::make_unique<ScenarioBus>(arguments.node, view.get());
    options.make_cell = bus->cells(file);
    options.knots = knots_at(arguments.node);
  }
  any_machine::MachineResult result =
      run_watched(*view, bus.get(), [&options](const host::Progress& progress) {
        return any_machine::run_machine(options, progress);
      });
  result.options.make_cell = {};  // the bus has ended
  fmt::print(results.text(), "{}transport: {}\n", any_machine::machine_summary(result),
             describe(arguments.node));
  const nlohmann::json document =
      any_machine::machine_document(result, run_context(arguments, *view));
  write_results(arguments, document, any_machine::machine_figures(result), results);
  view->ended(document);
  return any_machine::machine_verdict(result).ok ? 0 : 1;
}

}  // namespace

void add_run_machine_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* machine = run.add_subcommand(
      "machine", "Any machine file: errors at random, measure, compensate, verify");
  auto a = std::make_shared<MachineArguments>();
  a->command = command;
  a->node.cycle_hz = sim::kBusCycleOfFive_hz;
  any_machine::MachineOptions& options = a->options;
  machine->add_option("--seed", options.seed, "Seed of the machine, of the places and of the noise")
      ->check(seed_number())
      ->capture_default_str();
  machine->add_flag("--noise", options.noise, "Measure with realistic instruments");
  machine->add_option("--places", options.places, "Random places all over the travel")
      ->check(CLI::Range(std::size_t{10}, std::size_t{10000}))
      ->capture_default_str();
  machine
      ->add_option("--tool-length", options.tool_length_mm,
                   "Longer tool for the effect of orientation errors, mm")
      ->check(number_between(0.0, 2000.0))
      ->capture_default_str();
  machine->add_option(
      "--can", a->node.can,
      fmt::format("Compensate by a node on a CAN bus: loopback (in this process), {}",
                  host::kLinkForms));
  add_output_options(*machine, *a);
  const std::vector<CLI::Option*> on_a_bus = add_bus_options(*machine, a->node);
  machine->callback([a, on_a_bus, &code] {
    for (const CLI::Option* option : on_a_bus) {
      if (a->node.integrated() && option->count() > 0)
        throw CLI::RequiresError(option->get_name(), "--can");
    }
    code = run_machine_command(*a);
  });
}

}  // namespace volcomp::cli
