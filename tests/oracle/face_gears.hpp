#pragma once
// Face gears by other means than the library's: the swept shaper, and minimisers that know nothing
// of closed forms.

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/metrology/faces/face_grid.hpp"

namespace volcomp::test {

inline constexpr double kDegree = kPi / 180.0;

inline FaceGear without_relief(FaceGear gear) {
  gear.relief = {};
  EXPECT_TRUE(derive(gear).ok());
  return gear;
}

inline FaceGear small_face_gear() {
  FaceGear gear;
  gear.shaper_teeth = 20;
  gear.teeth = 60;
  gear.module = 2.5;
  gear.pressure_angle = 20.0 * kDegree;
  EXPECT_TRUE(derive(gear).ok());
  return gear;
}

inline FaceFlank flank_of(const FaceGear& gear, int side, int slot) {
  FaceFlank flank;
  EXPECT_TRUE(choose_flank(gear, side, slot, flank).ok());
  return flank;
}

inline FaceGrid grid_of(const FaceGear& gear, const FaceGridPlan& plan) {
  FaceGrid grid;
  EXPECT_TRUE(make_face_grid(gear, plan, grid).ok());
  return grid;
}

// A node of a grid as a point of any flank of the gear.
inline FacePoint on_flank(const FaceGridNode& node, const FaceFlank& flank) {
  return {from_flank(flank, node.point), from_flank(flank, node.normal)};
}

inline Vec3 turned_by(double angle, const Vec3& v) {
  return Eigen::AngleAxisd(angle, Vec3::UnitZ()) * v;
}

// Least value of a function with one minimum in an interval.
template <class Function>
double least(Function&& f, double low, double high) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int i = 0; i < 70; ++i) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  return f(0.5 * (low + high));
}

// The generated flank of side +1 in slot 0, with the functions of the C library.
inline Vec3 generated_point(const FaceGear& g, double theta, double beta) {
  const double turn = g.ratio * (theta - g.theta0 - beta);
  const double u = g.arm / std::cos(beta);
  const double t = g.r_bs * (theta * std::cos(beta) - std::sin(beta));
  return turned_by(-turn, {u, t, g.r_bs * (std::cos(beta) + theta * std::sin(beta))});
}

// Half the slot angle at a radius and depth: how far the turning shaper sweeps, whatever the
// condition of meshing. Its tooth is cut at the depth z and the radius rho for every turn.
inline double swept_half_slot(const FaceGear& g, double rho, double z) {
  const auto depth = [&](double theta, double shaper_turn) {
    const double beta = theta - g.theta0 - shaper_turn;
    return g.r_bs * (std::cos(beta) + theta * std::sin(beta));
  };
  const auto reach = [&](double shaper_turn) {
    double low = 0.0;  // roll angle where the tooth is at this depth, which grows with it
    double high = g.theta0 + shaper_turn + 1.5;
    if (depth(low, shaper_turn) > z) return -1.0;
    for (int i = 0; i < 60; ++i) {
      const double theta = 0.5 * (low + high);
      (depth(theta, shaper_turn) < z ? low : high) = theta;
    }
    const double beta = low - g.theta0 - shaper_turn;
    const double across = g.r_bs * (low * std::cos(beta) - std::sin(beta));
    return std::asin(across / rho) - g.ratio * shaper_turn;
  };
  constexpr double kStep = 0.01;
  double best = -0.5;
  for (double turn = best; turn < 0.5; turn += kStep)
    best = reach(turn) > reach(best) ? turn : best;
  return -least([&](double turn) { return -reach(turn); }, best - kStep, best + kStep);
}

}  // namespace volcomp::test
