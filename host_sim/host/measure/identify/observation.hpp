#pragma once
// What an instrument would read, and how that changes with everything that is not known.

#include <array>
#include <vector>

#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

// All that a reading depends on. Corrections are what is estimated of the value beside them.
struct Circumstances {
  Pose q{};
  ErrorSet errors = zero_errors();
  Vec3 tip = Vec3::Zero();  // of the stylus, tool frame
  Vec3 tip_correction = Vec3::Zero();
  double tip_radius = 0.0;  // with its correction
  Vec3 sphere = Vec3::Zero();
  Vec3 sphere_correction = Vec3::Zero();
  double sphere_radius = 0.0;
  double kappa = 0.0;         // lengths of the set-up are longer by this share
  std::vector<double> local;  // nuisances (local_count); of a placement none
  Placement placement;        // of centre and touch
};

using Row3 = Eigen::Matrix<double, 1, 3>;
using LocalRow = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 12>;

// One component.
struct Reading {
  double y = 0.0;  // a touch: how much too far the ball stands from the sphere
  // First order at the ideal machine, directions at the present estimate.
  std::array<Eigen::Matrix<double, 1, 6>, kMaxAxes> by_error{};
  LocalRow by_local;  // of a placement: left turn and way
  double by_kappa = 0.0;
  Row3 by_tip = Row3::Zero();
  Row3 by_sphere = Row3::Zero();
  double by_tip_radius = 0.0;
};

// The components of one observation.
[[nodiscard]] std::vector<Reading> reading_of(const Problem& problem, const SetUp& setup,
                                              const Circumstances& at);

}  // namespace volcomp::host::identify
