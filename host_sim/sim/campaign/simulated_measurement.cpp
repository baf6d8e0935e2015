#include "host_sim/sim/campaign/simulated_measurement.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/metrology/tables/line_fit.hpp"
#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/campaign/measured_diagonals.hpp"
#include "host_sim/sim/instruments/ball_bar.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::sim {
namespace {

constexpr std::size_t kMostTargets = 401;
constexpr std::size_t kTargetsOfGrid = 101;
constexpr double kSamePlace = 1e-9;  // of a pitch

// Relative values of an axis that its file states in another convention or on another side.
ErrorMotion in_relative_terms(const ErrorMotion& stated, const host::MachineFile& file,
                              std::size_t a, double q) {
  host::MachineFile relative = file;
  relative.convention = Convention::relative;
  relative.side = Side::moving;
  return in_file_terms(to_internal(stated, file.chain.axis(a), q, file.convention, file.side),
                       relative, a, q);
}

void have_at_reference(const host::MachineFile& file, std::size_t a, TrueAxis& truth) {
  const host::AxisFile& axis = file.axes[a];
  const ErrorMotion there = in_relative_terms(axis.at_reference, file, a, axis.reference);
  for (std::size_t c = 0; c < 6; ++c) {
    ErrorFunction& f = truth.channel[c];
    f.constant += there(static_cast<Eigen::Index>(c)) - f.at(axis.reference, truth.lo, truth.hi);
  }
}

// At the sensed point and in the terms of the file, where the builder of tables takes them out.
void take_slopes(const host::MachineFile& file, std::size_t a, TrueMachine& machine) {
  const host::AxisFile& axis = file.axes[a];
  const Joint& joint = file.chain.axis(a);
  const std::vector<double> at = axis.all_targets();
  std::vector<ErrorMotion> value;
  for (const double q : at) {
    Pose pose{};
    pose[a] = q;
    value.push_back(at_lever(in_file_terms(machine.errors(pose, {})[a], file, a, q),
                             axis.sensed.lever(joint.axis, q)));
  }
  const double sense = file.convention == Convention::relative ? 1.0 : branch_sign(joint.branch);
  for (std::size_t c = 0; c < 3; ++c) {
    if (c == index(joint.axis)) continue;
    std::vector<double> straightness;
    straightness.reserve(value.size());
    for (const ErrorMotion& v : value)
      straightness.push_back(v(static_cast<Eigen::Index>(c)));
    TrueAxis& truth = machine.axis[a];
    truth.channel[c].linear -=
        sense * least_squares_slope(at, straightness) * (truth.hi - truth.lo);
  }
}

void have_squareness(const host::MachineFile& file, TrueMachine& machine) {
  const host::SquarenessFile& s = *file.squareness;
  const std::array<std::size_t, 3> xyz{file.axis_index('X'), file.axis_index('Y'),
                                       file.axis_index('Z')};
  // Unit gain, so one step is exact.
  const XyfzSquareness own = measure_squareness(machine, s, no_noise(), {}, xyz);
  const DirectionErrors directions = xyfz_directions(close_squareness(s.measured, own));
  for (std::size_t k = 0; k < 3; ++k)
    machine.directions[xyz[k]] = directions[k];
}

// Squareness is defined between X, Y and Z.
bool has_squareness(const host::AxisFile& axis) { return axis.letter >= 'X' && axis.letter <= 'Z'; }

bool has_target_at_reference(const host::AxisFile& axis, std::size_t targets) {
  const double place =
      (axis.reference - axis.lo) / (axis.hi - axis.lo) * static_cast<double>(targets - 1);
  return std::abs(place - std::round(place)) < kSamePlace * static_cast<double>(targets);
}

void place_targets(host::AxisFile& axis) {
  for (std::size_t targets = axis.targets; targets <= kMostTargets; ++targets) {
    if (!has_target_at_reference(axis, targets)) continue;
    axis.targets = targets;
    return;
  }
  const double pitch = (axis.hi - axis.lo) / static_cast<double>(kTargetsOfGrid - 1);
  const double below = std::floor((axis.reference - axis.lo) / pitch);
  const double above = std::floor((axis.hi - axis.reference) / pitch);
  axis.lo = axis.reference - below * pitch;
  axis.hi = axis.reference + above * pitch;
  axis.targets = static_cast<std::size_t>(below + above) + 1;
}

NoiseClasses classes_of(const Instruments& instruments, const host::MachineFile& file) {
  return instruments.perfect ? no_noise() : workshop_noise(file);
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

TrueMachine draw_slides(const host::MachineFile& file, std::uint64_t seed) {
  Random random(seed);
  TrueMachine machine = ideal_machine(file);
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    if (!file.axes[a].rotary) {
      machine.axis[a] = draw_linear(file.axes[a], index(file.chain.axis(a).axis), random);
      have_at_reference(file, a, machine.axis[a]);
      if (!file.squareness || !has_squareness(file.axes[a])) take_slopes(file, a, machine);
    }
    have_at_reference(file, a, machine.axis[a]);
  }
  if (file.squareness) have_squareness(file, machine);
  return machine;
}

host::MachineFile with_targets_at_references(host::MachineFile file) {
  for (host::AxisFile& axis : file.axes)
    place_targets(axis);
  return file;
}

std::vector<host::RunsFile> simulate_runs(const SimulatedMachine& simulated,
                                          const Instruments& instruments, std::size_t runs) {
  const host::MachineFile file = with_targets_at_references(simulated.machine);
  const auto measure = is_read_between_work_and_tool(file) ? measure_machine : measure_any_machine;
  return measure(simulated.truth, file, classes_of(instruments, file), runs, {instruments.seed, 0})
      .runs;
}

host::DiagonalsFile simulate_diagonals(MotionCell& cell, const host::MachineFile& machine,
                                       const DiagonalPlan& plan, const Instruments& instruments,
                                       const host::Progress& progress) {
  const host::XyzAxes axes(machine);
  const std::vector<Diagonal> diagonals = axes.diagonals(plan.faces);
  const NoiseClasses classes = classes_of(instruments, machine);
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
