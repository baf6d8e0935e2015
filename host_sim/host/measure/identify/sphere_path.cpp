#include "host_sim/host/measure/identify/sphere_path.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"

namespace volcomp::host::identify {
namespace {

constexpr double kClear_mm = 1.0;  // between the ball of the tip and other spheres

bool within_travels(const Problem& problem, const Pose& q) {
  constexpr double kRounding = 1e-9;
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    const Travel& travel = problem.machine.travel.at(a);
    if (!problem.is_slide(a)) continue;
    if (q.at(a) < travel.lo - kRounding || q.at(a) > travel.hi + kRounding) return false;
  }
  return true;
}

// As far along a direction as the travels let.
Pose furthest(const Problem& problem, const Pose& q, const Vec3& direction) {
  constexpr double kPart = 1e-6;
  const Pose step = moved(problem.machine.chain, q, direction);
  double way = HUGE_VAL;
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    const Travel& travel = problem.machine.travel.at(a);
    const double change = step.at(a) - q.at(a);
    if (std::abs(change) > kPart)
      way = std::min(way, ((change > 0.0 ? travel.hi : travel.lo) - q.at(a)) / change);
  }
  return moved(problem.machine.chain, q, std::max(way, 0.0) * direction);
}

double distance(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 way = to - from;
  const double squared = way.squaredNorm();
  const double part = squared > 0.0 ? std::clamp((point - from).dot(way) / squared, 0.0, 1.0) : 0.0;
  return (from + part * way - point).norm();
}

}  // namespace

Pose moved(const MachineChain& chain, const Pose& q, const Vec3& way) {
  Pose out = q;
  move_by(chain, ideal_geometry(chain, q), way, out);
  return out;
}

SpherePaths::SpherePaths(const Problem& problem, const SetUp& setup,
                         const std::vector<std::size_t>& observations)
    : problem_(problem), setup_(setup), out_(touch_directions(*setup.pose)) {
  const Artefact& artefact = problem.artefacts[*setup.artefact];
  const MachineChain& chain = problem.machine.chain;
  const std::size_t first = observations.front();
  const double tip_radius = problem.styli[setup.stylus[first]].radius;
  for (std::size_t k = 0; k < artefact.spheres.size(); ++k)
    balls_.push_back(
        {setup.pose->R * artefact.spheres[k] + setup.pose->t, artefact.radius[k] + tip_radius});
  up_ = ideal_geometry(chain, setup.q[first]).work.R.transpose() *
        ideal_geometry(chain, middle_of(problem)).work.R * Vec3::UnitZ();
  // Spheres that stand beyond the travels are passed at the side or not at all.
  const Vec3& pole = out_.front();
  double reach = HUGE_VAL;
  top_ = HUGE_VAL;
  for (const std::size_t i : observations) {
    const auto tip_at = [&](const Pose& q) {
      return ideal_geometry(chain, q).in_work(problem.tip_of(setup, i));
    };
    reach = std::min(reach, pole.dot(tip_at(furthest(problem, setup.q[i], pole))));
    top_ = std::min(top_, up_.dot(tip_at(furthest(problem, setup.q[i], up_))));
  }
  plane_ = -HUGE_VAL;
  for (const Ball& ball : balls_)
    plane_ =
        std::max(plane_, std::min(reach, pole.dot(ball.centre) + ball.contact + kClearance_mm));
}

bool SpherePaths::above_all() const {
  return std::all_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
    return top_ - up_.dot(ball.centre) >= ball.contact + kClear_mm;
  });
}

bool SpherePaths::is_free(std::optional<std::size_t> touched, const std::vector<Vec3>& way) const {
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    if (touched && b == *touched) continue;
    for (std::size_t k = 1; k < way.size(); ++k)
      if (distance(way[k - 1], way[k], balls_[b].centre) < balls_[b].contact + kClear_mm)
        return false;
  }
  return true;
}

// Every way out is at a right angle to the one before: from one to the next goes round a corner.
std::optional<SpherePath> SpherePaths::of(std::size_t observation) const {
  const MachineChain& chain = problem_.machine.chain;
  const Pose& q = setup_.q[observation];
  const Ball& ball = balls_[setup_.sphere[observation]];
  const double away = ball.contact + kClearance_mm;
  const double beyond = std::max(ball.contact - kOvertravel_mm, 0.5 * ball.contact);
  SpherePath path;
  std::vector<Vec3> points;
  bool reached = true;
  const auto at = [&](const Vec3& offset) {
    const Pose pose = moved(chain, q, offset);
    reached = reached && within_travels(problem_, pose);
    points.emplace_back(ball.centre + offset);
    return pose;
  };
  const Vec3& pole = out_.front();
  const Vec3 to_plane = (plane_ - pole.dot(ball.centre)) * pole;
  path.to_first = {at(to_plane)};
  for (std::size_t k = 0; k < out_.size(); ++k) {
    SphereTouch touch;
    if (k > 0) touch.way.push_back(at(away * (out_.at(k - 1) + out_.at(k))));
    touch.way.push_back(at(away * out_.at(k)));
    touch.target = at(beyond * out_.at(k));
    points.emplace_back(ball.centre + away * out_.at(k));  // and back
    path.touches.push_back(std::move(touch));
  }
  path.away = {at(away * (out_.back() + pole)), at(away * out_.back() + to_plane)};
  path.begin = points.front();
  path.end = points.back();
  path.above = furthest(problem_, path.to_first.front(), up_);
  path.above_end = furthest(problem_, path.away.back(), up_);
  const auto rises_free = [&](const Vec3& from) {
    return is_free({}, {from, from + std::max(top_ - up_.dot(from), 0.0) * up_});
  };
  if (!reached || !is_free(setup_.sphere[observation], points) || !rises_free(path.begin) ||
      !rises_free(path.end))
    return std::nullopt;
  return path;
}

}  // namespace volcomp::host::identify
