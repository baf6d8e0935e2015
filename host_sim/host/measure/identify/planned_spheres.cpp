#include "host_sim/host/measure/identify/planned_spheres.hpp"

#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"

namespace volcomp::host::identify {
namespace {

// What five touches leave in a centre, of that of one touch: across the pole and along it.
constexpr double kAcross = 0.7071067811865476;
constexpr double kAlong = 1.118033988749895;

Pose references(const Problem& problem) {
  Pose q{};
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a)
    q.at(a) = problem.machine.travel.at(a).reference;
  return q;
}

// All combinations, the last axis changing first.
std::vector<Pose> turned(const Problem& problem, const SphereChoice& choice) {
  std::vector<Pose> poses{references(problem)};
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    if (choice.turn.at(a).empty()) continue;
    std::vector<Pose> more;
    for (const Pose& pose : poses) {
      for (const double angle : choice.turn.at(a)) {
        more.push_back(pose);
        more.back().at(a) = angle;
      }
    }
    poses = std::move(more);
  }
  return poses;
}

// Distance of the centres at a touch; 0 where radii are not known.
double contact_of(const Problem& problem, const SetUp& setup, std::size_t sphere, std::size_t tip) {
  const Artefact& artefact = problem.artefacts[*setup.artefact];
  return (artefact.radius.empty() ? 0.0 : artefact.radius[sphere]) + problem.styli[tip].radius;
}

// A ball is touched from the side as well: so much room on either side of every linear axis.
bool has_room(const Problem& problem, const Pose& q, double room) {
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    const Travel& travel = problem.machine.travel.at(a);
    if (!problem.is_slide(a)) continue;
    if (q.at(a) < travel.lo + room || q.at(a) > travel.hi - room) return false;
  }
  return true;
}

// Two observations of one sphere with one tip at one rotary position.
bool same_sphere(const Problem& problem, const SetUp& s, std::size_t i, std::size_t k) {
  return s.sphere[i] == s.sphere[k] && problem.stylus_of(s, i) == problem.stylus_of(s, k) &&
         problem.same_turn(s.q[i], s.q[k]);
}

class PlannedSpheres {
 public:
  PlannedSpheres(MeasurementPlan& plan, double sigma, SetUp& setup)
      : plan_(plan), sigma_(sigma), setup_(setup) {}

  void add(const Pose& turned, std::size_t sphere, std::size_t tip) {
    const Problem& problem = plan_.problem;
    const Artefact& artefact = problem.artefacts[*setup_.artefact];
    Pose q = turned;
    const ChainGeometry g = ideal_geometry(problem.machine.chain, q);
    const Vec3 centre = setup_.pose->R * artefact.spheres[sphere] + setup_.pose->t;
    const double contact = contact_of(problem, setup_, sphere, tip);
    const double room = artefact.radius.empty() ? contact : contact + kClearance_mm;
    if (!move_by(problem.machine.chain, g, centre - g.in_work(problem.styli[tip].offset), q) ||
        !has_room(problem, q, room)) {
      plan_.unreached.push_back(
          fmt::format("{}: sphere {} with tip {}", setup_.name, sphere, problem.styli[tip].name));
      return;
    }
    if (setup_.kind == ObservationKind::centre) {
      add_centre(q, sphere, tip);
    } else {
      for (const Vec3& out : touch_directions(*setup_.pose))
        add_touch(q, g, contact * out, sphere, tip);
    }
  }

 private:
  void add_reading(const Pose& q, std::size_t sphere, std::size_t tip) {
    setup_.q.push_back(q);
    setup_.d.push_back({});
    setup_.sphere.push_back(sphere);
    setup_.stylus.push_back(tip);
  }
  void add_centre(const Pose& q, std::size_t sphere, std::size_t tip) {
    add_reading(q, sphere, tip);
    const Vec3 own(kAcross, kAcross, kAlong);
    for (Eigen::Index k = 0; k < 3; ++k)
      setup_.sigma.push_back(sigma_ * setup_.pose->R.row(k).transpose().cwiseProduct(own).norm());
  }
  void add_touch(Pose q, const ChainGeometry& g, const Vec3& way, std::size_t sphere,
                 std::size_t tip) {
    static_cast<void>(move_by(plan_.problem.machine.chain, g, way, q));
    add_reading(q, sphere, tip);
    setup_.sigma.push_back(sigma_);
  }

  MeasurementPlan& plan_;
  double sigma_;
  SetUp& setup_;
};

}  // namespace

void add_planned_spheres(MeasurementPlan& plan, const SphereChoice& choice, double sigma,
                         SetUp& setup) {
  if (!setup.pose)
    throw UserError(fmt::format("{}: set-up \"{}\" has neither readings nor pose_deg_mm", plan.path,
                                setup.name));
  const std::vector<Pose> poses = turned(plan.problem, choice);
  const std::size_t spheres = plan.problem.artefacts[*setup.artefact].spheres.size();
  PlannedSpheres planned(plan, sigma, setup);
  const auto add_all = [&](const std::vector<std::size_t>& tips, std::size_t every) {
    for (const std::size_t tip : tips)
      for (std::size_t n = 0; n < poses.size(); n += every)
        for (std::size_t sphere = 0; sphere < spheres; ++sphere)
          planned.add(poses[n], sphere, tip);
  };
  add_all(choice.tips, 1);
  add_all(choice.more_tips, choice.more_every);
  if (setup.q.empty())
    throw UserError(
        fmt::format("{}: no sphere of set-up \"{}\" is within reach", plan.path, setup.name));
}

std::array<Vec3, kTouchesOfSphere> touch_directions(const Placement& pose) {
  const Vec3 x = pose.R.col(0);
  const Vec3 y = pose.R.col(1);
  return {pose.R.col(2), x, y, -x, -y};
}

std::vector<TouchMove> touch_moves(const MeasurementPlan& plan, std::size_t setup) {
  const Problem& problem = plan.problem;
  const MachineChain& chain = problem.machine.chain;
  const SetUp& s = problem.setups[setup];
  const Artefact& artefact = problem.artefacts[*s.artefact];
  if (!s.pose)
    throw UserError(fmt::format("{}: set-up \"{}\" has no pose_deg_mm", plan.path, s.name));
  if (artefact.radius.empty())
    throw UserError(
        fmt::format("{}: artefact \"{}\" has no radius_mm, without which nothing can be touched",
                    plan.path, artefact.name));
  std::vector<TouchMove> moves;
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    // Single touches of a sphere stand one after the other.
    if (i > 0 && same_sphere(problem, s, i - 1, i)) continue;
    const std::size_t stylus = *problem.stylus_of(s, i);
    const ChainGeometry g = ideal_geometry(chain, s.q[i]);
    const Vec3 centre = s.pose->R * artefact.spheres[s.sphere[i]] + s.pose->t;
    const double contact = contact_of(problem, s, s.sphere[i], stylus);
    for (const Vec3& out : touch_directions(*s.pose)) {
      TouchMove move{setup, s.sphere[i], stylus, s.q[i], s.q[i]};
      const Vec3 way = centre - g.in_work(problem.styli[stylus].offset);
      static_cast<void>(move_by(chain, g, way + (contact + kClearance_mm) * out, move.from));
      static_cast<void>(move_by(chain, g, way + (contact - kOvertravel_mm) * out, move.beyond));
      moves.push_back(move);
    }
  }
  return moves;
}

void arrive_at(const Pose& from, const Pose& to, Directions& d) {
  constexpr double kMoves = 1e-3;  // mm, rad: less is no side
  for (std::size_t a = 0; a < kMaxAxes; ++a)
    if (std::abs(to.at(a) - from.at(a)) > kMoves) d.at(a) = to.at(a) > from.at(a) ? 1.0 : -1.0;
}

}  // namespace volcomp::host::identify
