#include "host_sim/experiments/xyfz/dynamics.hpp"

#include <algorithm>

#include "comp/metrology/tables/compensated_command.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/campaign/campaign.hpp"

namespace volcomp::xyfz {
namespace {

constexpr double kLineFeed_mm_s = kLineFeed_m_min * 1000.0 / 60.0;
constexpr double kCircleFeed_mm_s = kCircleFeed_m_min * 1000.0 / 60.0;
constexpr std::size_t kKeepEvery = 8;  // of the ticks, for the pictures

Travels travels_of(const Vec3& direction) {
  Travels t{};
  for (std::size_t a = 0; a < 3; ++a) {
    t[a] = direction(static_cast<Eigen::Index>(a)) > 0.0 ? Travel::forward : Travel::backward;
  }
  return t;
}

void keep(Trace& trace, double x, double y) {
  trace.x.push_back(x);
  trace.y.push_back(y);
}

// Largest component of applied − wanted offset at one tick, nm. Wanted: the offset that makes the
// model stand at the (integer) target.
template <class ErrorAt>
double offset_error_nm(const sim::MotionCell& cell, const ErrorAt& error_at) {
  const host::Targets target_nm = cell.axes().target();
  const host::Offsets offset_nm = cell.axes().offset();
  Vec3 target;
  Vec3 applied;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    target(i) = static_cast<double>(target_nm[a]) / kNmPerMm;
    applied(i) = static_cast<double>(offset_nm[a]);
  }
  const Vec3 wanted = compensated_command(error_at, target, 4) - target;
  return (applied - kNmPerMm * wanted).cwiseAbs().maxCoeff();
}

// Distance from the chord between the first and the last sample.
Trace straightness(const std::vector<double>& path, const std::vector<Vec3>& deviation,
                   const Vec3& direction) {
  Trace trace;
  const double length = path.back() - path.front();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double s = (path[i] - path.front()) / length;
    const Vec3 rest = deviation[i] - (1.0 - s) * deviation.front() - s * deviation.back();
    keep(trace, path[i], kUmPerMm * (rest - rest.dot(direction) * direction).norm());
  }
  return trace;
}

void run_line(sim::MotionCell& cell, const host::MachineFile& machine,
              const host::BuiltTables& closed, bool compensated, Dynamics& out) {
  const Diagonal line = body_diagonals(sim::travel_box(machine))[sim::kPnp];
  const Travels travels = travels_of(line.direction());
  const auto error_at = [&](const Vec3& q) {
    return closed.model.first_order(host::pose_of(q), travels, Beyond::stand_at_end);
  };
  cell.place(line.start);
  out.unit_nm = cell.axes().largest_unit_nm();
  std::vector<double> path;
  std::vector<Vec3> deviation;
  std::size_t tick = 0;
  cell.move_to(line.end, kLineFeed_mm_s, [&](const sim::MotionCell& c) {
    const double s = (c.target_mm() - line.start).norm();
    const bool direction_known = s > 10.0 * machine.correction.hysteresis_mm;
    const bool shown = tick++ % kKeepEvery == 0;
    if (!direction_known) return;
    if (shown) {
      path.push_back(s);
      deviation.push_back(c.deviation_mm());
    }
    if (!compensated) return;
    const double error_nm = offset_error_nm(c, error_at);
    out.line_worst_nm = std::max(out.line_worst_nm, error_nm);
    if (shown) keep(out.line_offset_error_nm, s, error_nm);
  });
  (compensated ? out.line_deviation_um : out.line_deviation_raw_um) =
      straightness(path, deviation, line.direction());
}

// One turn to get going, one turn measured.
void run_circle(sim::MotionCell& cell, const Vec3& centre, Trace& out) {
  cell.place(centre + Vec3(kCircleRadius_mm, 0.0, 0.0));
  std::size_t tick = 0;
  double travelled = 0.0;
  Vec3 last = cell.target_mm();
  cell.circle(centre, kCircleRadius_mm, kCircleFeed_mm_s, 2, [&](const sim::MotionCell& c) {
    travelled += (c.target_mm() - last).norm();
    last = c.target_mm();
    const double angle = 180.0 / kPi * travelled / kCircleRadius_mm;
    if (angle < 300.0 || angle > 660.0 || tick++ % (4 * kKeepEvery) != 0) return;
    const Vec3 radial = (c.target_mm() - centre).normalized();
    keep(out, angle - 360.0, kUmPerMm * radial.dot(c.deviation_mm()));
  });
  // Only the shape matters: a ball bar centres itself.
  double mean = 0.0;
  for (const double y : out.y)
    mean += y / static_cast<double>(out.y.size());
  double c1 = 0.0;
  double s1 = 0.0;
  for (std::size_t i = 0; i < out.x.size(); ++i) {
    const double a = out.x[i] * kPi / 180.0;
    c1 += 2.0 * (out.y[i] - mean) * std::cos(a) / static_cast<double>(out.y.size());
    s1 += 2.0 * (out.y[i] - mean) * std::sin(a) / static_cast<double>(out.y.size());
  }
  for (std::size_t i = 0; i < out.x.size(); ++i) {
    const double a = out.x[i] * kPi / 180.0;
    out.y[i] -= mean + c1 * std::cos(a) + s1 * std::sin(a);
  }
}

// A random position of one axis: mostly inside its table, sometimes a knot ± 1 nm, an end, or far
// beyond.
std::int64_t random_position(const AxisTable& table, sim::Random& random) {
  const double kind = random.uniform();
  const auto knot =
      static_cast<std::int64_t>(random.uniform(0.0, static_cast<double>(table.knots)));
  const auto wiggle = static_cast<std::int64_t>(random.uniform(-1.0, 2.0));
  if (kind < 0.1) return table.q0 + table.pitch * knot + wiggle;
  if (kind < 0.15) return table.q0 - static_cast<std::int64_t>(random.uniform(0.0, 3e8));
  if (kind < 0.2) return table.last() + static_cast<std::int64_t>(random.uniform(0.0, 3e8));
  return table.q0 + static_cast<std::int64_t>(
                        random.uniform(0.0, static_cast<double>(table.last() - table.q0)));
}

}  // namespace

Dynamics run_dynamics(const sim::TrueMachine& truth, const host::MachineFile& machine,
                      const host::BuiltTables& closed, const sim::CellFactory& make_cell) {
  const DiagonalBox box = sim::travel_box(machine);
  const Vec3 centre = 0.5 * (box.lo + box.hi);
  const std::vector<std::uint8_t> image = host::make_image(closed.tables);
  const auto raw = [&] { return make_cell(truth, machine.correction, {}); };
  const auto compensated = [&] { return make_cell(truth, machine.correction, image); };
  Dynamics out;
  run_line(*raw(), machine, closed, false, out);
  run_line(*compensated(), machine, closed, true, out);
  run_circle(*raw(), centre, out.circle_raw_um);
  run_circle(*compensated(), centre, out.circle_um);
  return out;
}

double measure_tick_error_nm(const host::BuiltTables& closed, int points, std::uint64_t seed) {
  LoadedCompensator::Settings settings;
  for (AxisLimits& l : settings.axis)
    l = {{4'000'000, 1'000'000'000, 1, 0}, 0, 0};
  settings.source = PositionSource::actual;
  settings.ramp_ticks = 1;
  const auto compensator = std::make_unique<LoadedCompensator>(
      LoadedMachine<5>{make_runtime_chain(closed.tables.machine)});
  host::require(compensator->configure(settings), "tick accuracy");
  host::require(compensator->stage(closed.tables, closed.model.tool_point, 0), "tick accuracy");
  host::require(compensator->activate(), "tick accuracy");

  sim::Random random(seed);
  TickInput<5> in;
  TickOutput<5> out;
  Travels travels{};
  double worst = 0.0;
  for (int i = 0; i < points; ++i) {
    Pose q{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t before = in.axis[a].position;
      in.axis[a] = {random_position(closed.tables.axis[a], random), true, true};
      q[a] = static_cast<double>(in.axis[a].position) / kNmPerMm;
      if (i > 0 && in.axis[a].position != before) {
        travels[a] = in.axis[a].position > before ? Travel::forward : Travel::backward;
      }
    }
    compensator->tick(in, out);
    const Vec3 e = closed.model.first_order(q, travels, Beyond::stand_at_end);
    for (std::size_t a = 0; a < 3; ++a) {
      const double wanted = -kNmPerMm * e(static_cast<Eigen::Index>(a));
      worst = std::max(worst, std::abs(wanted - static_cast<double>(out.offset[a])));
    }
  }
  return worst;
}

}  // namespace volcomp::xyfz
