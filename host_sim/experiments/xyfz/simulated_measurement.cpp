#include "host_sim/experiments/xyfz/simulated_measurement.hpp"

#include <fmt/format.h>

namespace volcomp::xyfz {
namespace {

sim::NoiseClasses classes_of(const Instruments& instruments) {
  return instruments.perfect ? sim::no_noise() : sim::NoiseClasses{};
}

}  // namespace

SimulatedMachine simulated_machine(const std::filesystem::path& path, std::uint64_t machine_seed) {
  host::MachineFile machine = host::read_machine_file(path);
  sim::TrueMachine truth = make_xyfz_truth(machine, machine_seed, tune_xyfz(machine, machine_seed));
  return {std::move(machine), std::move(truth)};
}

std::vector<host::RunsFile> simulate_runs(const SimulatedMachine& simulated,
                                          const Instruments& instruments, std::size_t runs) {
  sim::Random random(instruments.seed);
  return sim::measure_machine(simulated.truth, simulated.machine, classes_of(instruments), runs,
                              random)
      .runs;
}

host::DiagonalsFile simulate_diagonals(sim::MotionCell& cell, const host::MachineFile& machine,
                                       const DiagonalPlan& plan, const Instruments& instruments,
                                       const host::Progress& progress) {
  const DiagonalBox box = sim::travel_box(machine);
  std::vector<Diagonal> diagonals;
  for (const Diagonal& d : body_diagonals(box))
    diagonals.push_back(d);
  if (plan.faces) {
    for (const Diagonal& d : face_diagonals(box))
      diagonals.push_back(d);
  }
  const sim::NoiseClasses classes = classes_of(instruments);
  sim::Random random(instruments.seed);
  const double scale = random.normal(classes.interferometer);
  host::DiagonalsFile file;
  const auto all = static_cast<double>(diagonals.size() * plan.runs);
  for (const Diagonal& d : diagonals) {
    host::DiagonalRuns measured{d.name, {}, {}};
    for (std::size_t t = 0; t < plan.points; ++t) {
      const double s = static_cast<double>(t) / static_cast<double>(plan.points - 1);
      measured.targets.push_back({s * d.length(), 0});
    }
    for (std::size_t run = 0; run < plan.runs; ++run) {
      const auto done = static_cast<double>(file.diagonals.size() * plan.runs + run);
      progress(done / all, fmt::format("diagonal {}, run {} of {}", d.name, run + 1, plan.runs));
      const sim::DiagonalPass pass = sim::pass_along(cell, d, plan.points, [&](double length_mm) {
        return scale * length_mm + random.normal(classes.repeatability_mm);
      });
      const auto number = static_cast<long>(run + 1);
      measured.runs.push_back({number, true, 0, pass.up});
      measured.runs.push_back({number, false, 0, pass.down});
    }
    file.diagonals.push_back(std::move(measured));
  }
  return file;
}

host::VolumeFile simulate_volume(sim::MotionCell& cell, const host::MachineFile& machine,
                                 int points, std::uint64_t seed) {
  return {"", sim::visit_volume(cell, sim::travel_box(machine), points, seed)};
}

}  // namespace volcomp::xyfz
