#include "host_sim/sim/controller/straight_move.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp::sim {
namespace {

double length_of(const Pose& path, const host::AxisKinds& kinds, bool rotary) {
  double squares = 0.0;
  for (std::size_t a = 0; a < kinds.count; ++a) {
    if (kinds.rotary[a] == rotary) squares += path[a] * path[a];
  }
  return std::sqrt(squares);
}

}  // namespace

Trapezoid::Trapezoid(double length, double feed, double acceleration)
    : length_(length),
      acceleration_(acceleration),
      speed_(std::min(feed, std::sqrt(length * acceleration))),
      ramp_s_(speed_ / acceleration),
      duration_s_(length > 0.0 ? length / speed_ + ramp_s_ : 0.0) {}

double Trapezoid::at(double t_s) const {
  if (t_s >= duration_s_) return length_;
  if (t_s < ramp_s_) return 0.5 * acceleration_ * t_s * t_s;
  const double rest = duration_s_ - t_s;
  if (rest < ramp_s_) return length_ - 0.5 * acceleration_ * rest * rest;
  return speed_ * (t_s - 0.5 * ramp_s_);
}

double Trapezoid::speed(double t_s) const {
  const double from_an_end = std::min(t_s, duration_s_ - t_s);
  return std::clamp(acceleration_ * from_an_end, 0.0, speed_);
}

double Trapezoid::braking(double t_s, double since_s) const {
  const double t = std::min(since_s, braking_s(t_s));
  return at(t_s) + (speed(t_s) - 0.5 * acceleration_ * t) * t;
}

StraightMove::Line StraightMove::line_between(const Pose& from, const Pose& to,
                                              const host::AxisKinds& kinds, double feed) {
  Line line;
  for (std::size_t a = 0; a < kinds.count; ++a)
    line.direction[a] = to[a] - from[a];
  const double travel = length_of(line.direction, kinds, false);
  const double turning = length_of(line.direction, kinds, true);
  line.length = travel > 0.0 ? travel : turning;
  line.feed = feed;
  line.acceleration = travel > 0.0 ? kAcceleration_mm_s2 : kAcceleration_rad_s2;
  if (!(line.length > 0.0)) return line;
  if (turning > 0.0) {
    const double per_rad = line.length / turning;
    line.feed = std::min(line.feed, kMostTurning_rad_s * per_rad);
    line.acceleration = std::min(line.acceleration, kAcceleration_rad_s2 * per_rad);
  }
  for (double& d : line.direction)
    d /= line.length;
  return line;
}

StraightMove::StraightMove(const Pose& from, const Pose& to, const host::AxisKinds& kinds,
                           double feed)
    : StraightMove(from, line_between(from, to, kinds, feed)) {}

StraightMove::StraightMove(const Pose& from, const Line& line)
    : from_(from),
      direction_(line.direction),
      profile_(line.length, line.feed, line.acceleration) {}

Pose StraightMove::along(double way) const {
  Pose q = from_;
  for (std::size_t a = 0; a < q.size(); ++a)
    q[a] = from_[a] + way * direction_[a];
  return q;
}

}  // namespace volcomp::sim
