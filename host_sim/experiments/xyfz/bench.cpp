#include "host_sim/experiments/xyfz/bench.hpp"

namespace volcomp::xyfz {
namespace {

host::MachineFile read_first(const XyfzOptions& options, const host::Progress& progress) {
  host::MachineFile machine = host::read_machine_file(options.machine);
  progress(0.0, "tuning the simulated machine");
  return machine;
}

host::MachineFile with_functional(host::MachineFile machine, Functional functional) {
  if (functional == Functional::circles) machine.squareness->circle_radius = kBallBar_mm;
  return machine;
}

}  // namespace

Bench::Bench(const XyfzOptions& chosen, const host::Progress& progress)
    : Bench(chosen, read_first(chosen, progress)) {}

Bench::Bench(const XyfzOptions& chosen, const host::MachineFile& file)
    : Bench(chosen, file, tune_xyfz(file, chosen.machine_seed)) {}

Bench::Bench(const XyfzOptions& chosen, const host::MachineFile& file, const XyfzTuning& found)
    : options(chosen),
      machine(with_functional(file, chosen.noise_free)),
      noisy_machine(with_functional(file, chosen.noisy)),
      tuning(found),
      truth(make_xyfz_truth(file, chosen.machine_seed, tuning)),
      box(sim::travel_box(machine)) {}

sim::NoiseClasses Bench::noise() const {
  const sim::NoiseClasses all = sim::workshop_noise(machine);
  return options.only ? sim::only(*options.only, all) : all;
}

sim::CampaignDraw Bench::draw(std::size_t number) const {
  return {options.seed, static_cast<std::uint32_t>(number)};
}

std::unique_ptr<sim::MotionCell> Bench::cell(const sim::TrueMachine& of,
                                             const std::vector<std::uint8_t>& image) const {
  auto cell = options.make_cell(of, machine.correction, image);
  cell->place(box.lo);
  return cell;
}

sim::MeasuredDiagonal Bench::pnp(const sim::TrueMachine& of, const std::vector<std::uint8_t>& image,
                                 std::size_t points, const sim::InterferometerSetup& setup,
                                 sim::Random& random) const {
  return sim::measure_diagonal(*cell(of, image), body_diagonals(box)[sim::kPnp], points, setup,
                               random);
}

}  // namespace volcomp::xyfz
