#include "host_sim/cli/simulate_options.hpp"

#include "host_sim/cli/number_check.hpp"
#include "host_sim/experiments/xyfz/truth.hpp"

namespace volcomp::cli {

sim::SimulatedMachine machine_of(const SimulateArguments& a) {
  host::MachineFile machine = host::read_machine_file(
      a.machine.empty() ? host::bundled_machine("xyfz") : std::filesystem::path(a.machine));
  std::optional<sim::TrueMachine> truth =
      xyfz::xyfz_truth(sim::with_targets_at_references(machine), a.machine_seed);
  if (!truth) truth = sim::draw_slides(machine, a.machine_seed);
  return {std::move(machine), std::move(*truth)};
}

std::shared_ptr<SimulateArguments> add_machine_options(CLI::App& command) {
  auto a = std::make_shared<SimulateArguments>();
  command.add_option(
      "--machine", a->machine,
      "Machine file (TOML) with linear axes; rotary ones stand still (default: the xyfz "
      "that comes with the program)");
  command
      .add_option("--machine-seed", a->machine_seed, "Seed of the errors of the simulated machine")
      ->check(seed_number())
      ->capture_default_str();
  command.add_option("--seed", a->instruments.seed, "Seed of instruments and places")
      ->check(seed_number())
      ->capture_default_str();
  return a;
}

void add_perfect(CLI::App& command, sim::Instruments& instruments) {
  command.add_flag(
      "--perfect", instruments.perfect,
      "Instruments without errors (default: 0.7 µm and 0.7 µrad per reading and more)");
}

}  // namespace volcomp::cli
