#include "host_sim/experiments/xyfz/truth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "comp/metrology/tables/diagonals.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/instruments/ball_bar.hpp"
#include "host_sim/sim/truth/drawn_errors.hpp"

namespace volcomp::xyfz {
namespace {

sim::TrueAxis draw_axis(const host::AxisFile& file, std::size_t own, const XyfzTuning& tuning,
                        sim::Random& random) {
  sim::TrueAxis axis;
  axis.lo = file.lo;
  axis.hi = file.hi;
  for (std::size_t c = 0; c < 6; ++c) {
    const bool angle = c >= 3;
    const double amplitude = sim::default_amplitude(c, own) * (angle ? tuning.angle_scale : 1.0);
    const double rise = angle || c == own ? amplitude * random.uniform(-1.0, 1.0) : 0.0;
    axis.channel[c] = sim::waves_on_line(rise, amplitude, random);
  }
  sim::draw_ripple(axis.channel[own], random);
  sim::draw_reversal(own, axis, random);
  return axis;
}

// Largest deviation on PNP, mean of both directions, µm: measured − predicted where a model is
// given.
double pnp_um(const sim::TrueMachine& machine, const host::MachineFile& file,
              const host::BuiltTables* predicted) {
  const DiagonalBox box = sim::travel_box(file);
  std::vector<double> deviation(sim::kDiagonalPoints);
  DiagonalFigures figures;
  const auto error_at = [&](const Vec3& p) -> Vec3 {
    const Pose q{p.x(), p.y(), p.z()};
    Vec3 e = machine.error(q, {}, machine.chain.tool_point()).position_work;
    if (predicted != nullptr)
      e -= predicted->model.first_order(q, kUnknownTravels, Beyond::stand_at_end);
    return e;
  };
  host::require(diagonal_deviations(error_at, body_diagonals(box)[sim::kPnp], deviation, figures),
                "diagonal");
  return figures.max_abs * kUmPerMm;
}

double naive_residual_um(const host::MachineFile& file, std::uint64_t phase_seed,
                         const XyfzTuning& tuning) {
  const sim::TrueMachine machine = make_xyfz_truth(file, phase_seed, tuning);
  const sim::Campaign campaign = sim::perfect_campaign(machine, file);
  const auto naive = host::build_tables(campaign.machine, campaign.runs,
                                        host::tables_only(host::ModelKind::naive));
  return pnp_um(machine, file, naive.get());
}

double raw_um(const host::MachineFile& file, std::uint64_t phase_seed, const XyfzTuning& tuning) {
  return pnp_um(make_xyfz_truth(file, phase_seed, tuning), file, nullptr);
}

// A function, and a value of it with the place where it was taken.
using Function = std::function<double(double)>;
struct Sample {
  double x = 0.0;
  double f = 0.0;
};

// Where f changes sign between two samples, to `tolerance` in x: interpolate, truncate, project
// (Oliveira and Takahashi, ACM Trans. Math. Softw. 47(1), 2020). Readings are rounded to their
// resolution, so close up f is a staircase where a secant alone crawls; this stays within one call
// of bisection. The side nearer to zero is returned.
double root_between(Sample lo, Sample hi, double tolerance, const Function& f) {
  const double whole = hi.x - lo.x;
  double reach = tolerance * std::exp2(std::ceil(std::log2(whole / tolerance)));
  while (hi.x - lo.x > tolerance) {
    const double width = hi.x - lo.x;
    const double middle = 0.5 * (lo.x + hi.x);
    const double secant = (hi.f * lo.x - lo.f * hi.x) / (hi.f - lo.f);
    const double inwards = std::min(0.2 * width * width / whole, std::abs(middle - secant));
    const double aim = secant + std::copysign(inwards, middle - secant);
    const double room = std::max(0.0, reach - 0.5 * width);
    const double x = std::clamp(aim, middle - room, middle + room);
    const Sample next{x, f(x)};
    ((next.f > 0.0) == (hi.f > 0.0) ? hi : lo) = next;
    reach *= 0.5;
  }
  return std::abs(lo.f) < std::abs(hi.f) ? lo.x : hi.x;
}

// The root nearest to `start` on a grid of equal steps, then refined; nothing if there is none.
std::optional<double> nearest_root(double start, double step, int steps, const Function& f) {
  const double tolerance = 1e-8 * step;  // far below what one rounded reading changes
  Sample up{start, f(start)};
  Sample down = up;
  for (int i = 1; i <= steps; ++i) {
    const Sample above{start + i * step, f(start + i * step)};
    if ((above.f > 0.0) != (up.f > 0.0)) return root_between(up, above, tolerance, f);
    const Sample below{start - i * step, f(start - i * step)};
    if ((below.f > 0.0) != (down.f > 0.0)) return root_between(below, down, tolerance, f);
    up = above;
    down = below;
  }
  return std::nullopt;
}

// The chain that the paper's figures are of: X and Y under the work, Z with the tool, and its
// laser.
bool has_chain_of_paper(const host::MachineFile& file) {
  if (!file.squareness || file.axes.size() != 3) return false;
  for (std::size_t a = 0; a < 3; ++a) {
    const Joint& joint = file.chain.axis(a);
    const Branch branch = a < 2 ? Branch::work : Branch::tool;
    if (branch == Branch::work && file.axes[a].sensed.kappa != 1) return false;
    if (file.axes[a].letter != "XYZ"[a] || index(joint.axis) != a || joint.branch != branch ||
        joint.sign != static_cast<int>(branch_sign(branch)))
      return false;
  }
  return true;
}

}  // namespace

sim::TrueMachine make_xyfz_truth(const host::MachineFile& file, std::uint64_t phase_seed,
                                 const XyfzTuning& tuning) {
  if (!file.squareness || file.axes.size() != 3) {
    throw host::UserError(file.path +
                          ": the xyfz scenario needs three linear axes and a [squareness] table");
  }
  sim::Random random(phase_seed);
  sim::TrueMachine machine;
  machine.chain = file.chain;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto own = static_cast<std::size_t>(file.chain.axis(a).axis);
    machine.axis[a] = draw_axis(file.axes[a], own, tuning, random);
  }
  machine.axis[0].channel[0].linear += tuning.scale_error * (file.axes[0].hi - file.axes[0].lo);

  // A ball bar on this machine must read the value of the machine file: unit gain, so one step is
  // exact.
  const XyfzSquareness own =
      sim::measure_squareness(machine, *file.squareness, sim::no_noise(), {});
  machine.directions = xyfz_directions(close_squareness(file.squareness->measured, own));
  return machine;
}

std::optional<XyfzTuning> find_tuning(const host::MachineFile& file, std::uint64_t phase_seed) {
  XyfzTuning tuning;
  constexpr int kRounds = 2;  // the two figures hardly influence each other
  for (int round = 0; round < kRounds; ++round) {
    const bool first = round == 0;
    const auto scale =
        nearest_root(tuning.angle_scale, first ? 0.1 : 0.01, first ? 25 : 50, [&](double s) {
          return naive_residual_um(file, phase_seed, {s, tuning.scale_error}) - kPaperNaive_um;
        });
    if (!scale) return std::nullopt;
    tuning.angle_scale = *scale;
    const auto slope = nearest_root(tuning.scale_error, 2e-6, 150, [&](double s) {
      return raw_um(file, phase_seed, {tuning.angle_scale, s}) - kPaperRaw_um;
    });
    if (!slope) return std::nullopt;
    tuning.scale_error = *slope;
  }
  if (tuning.angle_scale <= 0.0) return std::nullopt;
  return tuning;
}

XyfzTuning tune_xyfz(const host::MachineFile& file, std::uint64_t phase_seed) {
  if (const auto tuning = find_tuning(file, phase_seed)) return *tuning;
  throw host::UserError(
      "this phase seed has no machine with the paper's figures; try another --machine-seed");
}

std::optional<sim::TrueMachine> xyfz_truth(const host::MachineFile& file,
                                           std::uint64_t phase_seed) {
  if (!has_chain_of_paper(file)) return std::nullopt;
  const auto tuning = find_tuning(file, phase_seed);
  if (!tuning) return std::nullopt;
  return make_xyfz_truth(file, phase_seed, *tuning);
}

}  // namespace volcomp::xyfz
