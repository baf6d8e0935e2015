#include "host_sim/experiments/any_machine/sphere_test.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"

namespace volcomp::any_machine {
namespace {

constexpr std::size_t kAllRound = 12;
constexpr std::size_t kBetweenEnds = 5;
constexpr std::size_t kBallSteps = 4;  // of each following axis; even: not on the axis of a table

struct Roles {
  std::vector<std::size_t> following;
  std::vector<std::size_t> turning;
};

Roles roles_of(const host::MachineFile& file) {
  Roles roles;
  roles.following = slides_of(file);
  const MachineDescription& d = file.chain.description();
  if (roles.following.size() < 3)
    roles.following.assign(d.correcting.begin(), d.correcting.begin() + d.correcting_count);
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const bool follows =
        std::find(roles.following.begin(), roles.following.end(), a) != roles.following.end();
    if (file.axes[a].rotary && !follows) roles.turning.push_back(a);
  }
  return roles;
}

std::vector<double> stations_of(const host::AxisFile& axis) {
  const std::size_t count = axis.full_turn() ? kAllRound : kBetweenEnds;
  const auto parts = static_cast<double>(axis.full_turn() ? count : count - 1);
  std::vector<double> stations;
  for (std::size_t i = 0; i < count; ++i)
    stations.push_back(axis.lo + (axis.hi - axis.lo) * static_cast<double>(i) / parts);
  return stations;
}

// All positions of the turning axes, each axis to and fro so that none travels back idly.
std::vector<Pose> rotary_positions(const host::MachineFile& file, const Roles& roles,
                                   const Pose& start) {
  std::vector<Pose> positions{start};
  for (const std::size_t a : roles.turning) {
    std::vector<double> stations = stations_of(file.axes[a]);
    std::vector<Pose> longer;
    for (const Pose& position : positions) {
      for (const double q : stations) {
        longer.push_back(position);
        longer.back()[a] = q;
      }
      std::reverse(stations.begin(), stations.end());
    }
    positions = longer;
  }
  return positions;
}

bool inside(const host::AxisFile& axis, double q) {
  constexpr double kRounding = 1e-9;
  return q >= axis.lo - kRounding && q <= axis.hi + kRounding;
}

SpherePlan plan_with(const host::MachineFile& file, const Roles& roles, const Vec3& ball,
                     const Pose& start) {
  SpherePlan plan;
  plan.ball = ball;
  plan.poses.push_back(start);
  for (Pose q : rotary_positions(file, roles, start)) {
    if (follow(file, roles.following, ball, q)) {
      plan.poses.push_back(q);
    } else {
      ++plan.left_out;
    }
  }
  return plan;
}

double travel_of(const SpherePlan& plan, const std::vector<std::size_t>& following) {
  double travel = 0.0;
  for (const Pose& q : plan.poses) {
    for (const std::size_t a : following)
      travel += std::abs(q[a] - plan.poses.front()[a]);
  }
  return travel;
}

// Rotary axes at their references, the following ones spread over what is well inside their travel.
std::vector<Pose> starts_of(const host::MachineFile& file, const Roles& roles) {
  Pose middle{};
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    middle[a] = file.axes[a].reference;
  std::vector<Pose> starts{middle};
  for (const std::size_t a : roles.following) {
    std::vector<Pose> more;
    for (const Pose& start : starts) {
      for (std::size_t i = 0; i < kBallSteps; ++i) {
        const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(kBallSteps);
        more.push_back(start);
        more.back()[a] = file.axes[a].lo + part * (file.axes[a].hi - file.axes[a].lo);
      }
    }
    starts = more;
  }
  return starts;
}

}  // namespace

bool follow(const host::MachineFile& file, const std::vector<std::size_t>& following,
            const Vec3& ball, Pose& q) {
  constexpr int kMostSteps = 20;
  constexpr double kNear_mm = 1e-9;
  const MachineChain& chain = file.chain;
  const Vec3 tool = chain.tool_point();
  for (int step = 0; step < kMostSteps; ++step) {
    const Frame work = chain.ideal(chain.work(), q);
    const Vec3 away = work.apply(ball) - chain.ideal(chain.tool(), q).apply(tool);
    if (away.norm() < kNear_mm) {
      return std::all_of(following.begin(), following.end(),
                         [&](std::size_t a) { return inside(file.axes[a], q[a]); });
    }
    MotionOffset authority;
    if (!motion_offset(chain, q, tool, Vec3::Zero(), authority).ok()) return false;
    Mat3 columns;
    for (std::size_t k = 0; k < 3; ++k)
      columns.col(static_cast<Eigen::Index>(k)) = jacobian_column(chain, q, tool, following[k]);
    const Eigen::FullPivLU<Mat3> solver(columns);
    if (!solver.isInvertible()) return false;
    const Vec3 way = solver.solve(away);
    for (std::size_t k = 0; k < 3; ++k)
      q[following[k]] += way(static_cast<Eigen::Index>(k));
  }
  return false;
}

SpherePlan plan_sphere_test(const host::MachineFile& file) {
  const Roles roles = roles_of(file);
  SpherePlan best;
  if (roles.turning.empty() || roles.following.size() < 3) return best;
  double farthest = 0.0;
  for (const Pose& start : starts_of(file, roles)) {
    const Vec3 ball = ideal_points(file.chain, start, file.chain.tool_point()).work;
    const SpherePlan plan = plan_with(file, roles, ball, start);
    const double travel = travel_of(plan, roles.following);
    const bool better = plan.poses.size() > best.poses.size() ||
                        (plan.poses.size() == best.poses.size() && travel > farthest);
    if (!better) continue;
    best = plan;
    farthest = travel;
  }
  return best;
}

std::vector<PlaceReading> measure_sphere(sim::MotionCell& cell, const MachineChain& chain,
                                         const SpherePlan& plan) {
  std::vector<PlaceReading> readings = measure_places(cell, chain, plan.poses);
  if (readings.empty()) return readings;
  const Vec3 found = readings.front().deviation_mm;
  for (PlaceReading& r : readings)
    r.deviation_mm -= found;
  return readings;
}

}  // namespace volcomp::any_machine
