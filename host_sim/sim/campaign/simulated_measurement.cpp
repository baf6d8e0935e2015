#include "host_sim/sim/campaign/simulated_measurement.hpp"

#include <fmt/format.h>

#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/campaign/measured_diagonals.hpp"

namespace volcomp::sim {
namespace {

NoiseClasses classes_of(const Instruments& instruments) {
  return instruments.perfect ? no_noise() : NoiseClasses{};
}

// Whether a laser between work and tool reads the three slides, which includes the errors of the
// axes that stand still: the sensed point is on the side of the tool where an axis carries the
// work. On any other machine each axis is read by itself.
bool is_read_between_work_and_tool(const host::MachineFile& file) {
  if (!file.squareness || file.axes.size() != 3) return false;
  if (file.convention != Convention::relative || file.side != Side::moving) return false;
  for (std::size_t a = 0; a < 3; ++a) {
    const host::AxisFile& axis = file.axes[a];
    const bool carries_work = file.chain.axis(a).branch == Branch::work;
    if (axis.rotary || axis.letter != "XYZ"[a]) return false;
    if (carries_work && axis.sensed.kappa != 1) return false;
  }
  return true;
}

}  // namespace

std::vector<host::RunsFile> simulate_runs(const SimulatedMachine& simulated,
                                          const Instruments& instruments, std::size_t runs) {
  Random random(instruments.seed);
  const host::MachineFile file = with_targets_at_references(simulated.machine);
  const auto measure = is_read_between_work_and_tool(file) ? measure_machine : measure_any_machine;
  return measure(simulated.truth, file, classes_of(instruments), runs, random).runs;
}

host::DiagonalsFile simulate_diagonals(MotionCell& cell, const host::MachineFile& machine,
                                       const DiagonalPlan& plan, const Instruments& instruments,
                                       const host::Progress& progress) {
  const host::XyzAxes axes(machine);
  const std::vector<Diagonal> diagonals = axes.diagonals(plan.faces);
  const NoiseClasses classes = classes_of(instruments);
  Random random(instruments.seed);
  const double scale = random.normal(classes.interferometer);
  host::DiagonalsFile file;
  const auto all = static_cast<double>(diagonals.size() * plan.runs);
  for (const Diagonal& d : diagonals) {
    const MeasuredLine line = line_of(axes, d, plan.points);
    host::DiagonalRuns measured{d.name, {}, {}};
    for (std::size_t t = 0; t < plan.points; ++t) {
      const double s = static_cast<double>(t) / static_cast<double>(plan.points - 1);
      measured.targets.push_back({s * d.length(), 0});
    }
    for (std::size_t run = 0; run < plan.runs; ++run) {
      const auto done = static_cast<double>(file.diagonals.size() * plan.runs + run);
      progress(done / all, fmt::format("diagonal {}, run {} of {}", d.name, run + 1, plan.runs));
      const DiagonalPass pass = pass_along(cell, line, [&](double at_mm) {
        return line.along.dot(cell.deviation_mm()) + scale * at_mm +
               random.normal(classes.repeatability_mm);
      });
      const auto number = static_cast<long>(run + 1);
      measured.runs.push_back({number, true, 0, pass.up});
      measured.runs.push_back({number, false, 0, pass.down});
    }
    file.diagonals.push_back(std::move(measured));
  }
  return file;
}

host::VolumeFile simulate_volume(MotionCell& cell, const host::MachineFile& machine, int points,
                                 std::uint64_t seed) {
  return {"", visit_volume(cell, host::XyzAxes(machine), points, seed)};
}

}  // namespace volcomp::sim
