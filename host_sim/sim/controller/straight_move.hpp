#pragma once
// All axes from one pose to another along a straight line, with trapezoidal speed.
//
// The feed counts as in RS274/NGC (NISTIR 6556, section 2.1.2.5): mm/s along the path of the linear
// axes as if the rotary ones stood still; rad/s where only rotary axes move, over the root of the
// sum of their squares. Rotary axes that would have to turn faster than they can slow everything
// down.

#include "host_sim/host/machine/axis_kinds.hpp"

namespace volcomp::sim {

// Way along a trapezoidal profile of speed. Any unit of length; all values ≥ 0, feed and
// acceleration > 0.
class Trapezoid {
 public:
  Trapezoid(double length, double feed, double acceleration);

  [[nodiscard]] double duration_s() const { return duration_s_; }
  [[nodiscard]] double at(double t_s) const;
  [[nodiscard]] double speed(double t_s) const;
  // Where it would be `since_s` after it began to brake at `t_s`, and how long that takes.
  [[nodiscard]] double braking(double t_s, double since_s) const;
  [[nodiscard]] double braking_s(double t_s) const { return speed(t_s) / acceleration_; }

 private:
  double length_;
  double acceleration_;
  double speed_;
  double ramp_s_;
  double duration_s_;
};

inline constexpr double kAcceleration_mm_s2 = 2000.0;
inline constexpr double kAcceleration_rad_s2 = 10.0;  // 1.7 m/s² at the end of an arm of 174 mm
inline constexpr double kMostTurning_rad_s = 1.0;

class StraightMove {
 public:
  StraightMove(const Pose& from, const Pose& to, const host::AxisKinds& kinds, double feed);

  [[nodiscard]] double duration_s() const { return profile_.duration_s(); }
  [[nodiscard]] Pose at(double t_s) const { return along(profile_.at(t_s)); }
  // Instead of going on at `t_s`, comes to a stand on the line.
  [[nodiscard]] Pose braking(double t_s, double since_s) const {
    return along(profile_.braking(t_s, since_s));
  }
  [[nodiscard]] double braking_s(double t_s) const { return profile_.braking_s(t_s); }

 private:
  struct Line {
    Pose direction{};  // by axis, per unit of length
    double length = 0.0;
    double feed = 0.0;
    double acceleration = 0.0;
  };
  static Line line_between(const Pose& from, const Pose& to, const host::AxisKinds& kinds,
                           double feed);
  StraightMove(const Pose& from, const Line& line);
  [[nodiscard]] Pose along(double way) const;

  Pose from_;
  Pose direction_;
  Trapezoid profile_;
};

}  // namespace volcomp::sim
