#pragma once
// How well the error of a point is known over a volume, and which set-ups to take for it.

#include <utility>
#include <vector>

#include "host_sim/host/measure/identify/solution.hpp"

namespace volcomp::host::identify {

// Least squares: without their best rigid motion, t + w × (p − mean).
[[nodiscard]] std::vector<Vec3> without_rigid(const std::vector<Vec3>& points,
                                              const std::vector<Vec3>& errors);

// Where the error of a point is asked for.
struct VolumePlaces {
  std::vector<Pose> q;
  std::vector<Directions> d = {};  // as many, from where the axes have come; none: the mean of both

  // NOLINTNEXTLINE(google-explicit-constructor): poses are places
  VolumePlaces(std::vector<Pose> poses) : q(std::move(poses)) {}
  VolumePlaces(std::vector<Pose> poses, std::vector<Directions> directions)
      : q(std::move(poses)), d(std::move(directions)) {}
};

// Standard uncertainties of an error vector at each place: root of the trace of its covariance.
struct VolumeUncertainty {
  std::vector<double> datum;  // in the gauge
  std::vector<double> rigid;  // beside the best rigid motion over all places: what a user sees who
                              // clamps and aligns a part

  [[nodiscard]] double rms_rigid() const;
};
[[nodiscard]] VolumeUncertainty volume_uncertainty(const Equations& equations,
                                                   const Triangle& triangle,
                                                   const VolumePlaces& places,
                                                   const Vec3& tool_point);

// What such uncertainties come to: error vectors drawn from the covariance, of each draw the 95 %
// of the places and the worst, their means over the draws. Beside the best rigid motion.
struct DrawnVolume {
  double p95 = 0.0;
  double max = 0.0;
};
[[nodiscard]] DrawnVolume draw_volume(const Equations& equations, const Triangle& triangle,
                                      const VolumePlaces& places, const Vec3& tool_point);

// The uncertainty beside the best rigid motion at places of their own, beside the rigid motion that
// is best over `fitted`.
[[nodiscard]] std::vector<double> rigid_uncertainty_at(const Equations& equations,
                                                       const Triangle& triangle,
                                                       const std::vector<Pose>& fitted,
                                                       const std::vector<Pose>& places,
                                                       const Vec3& tool_point);

// Set-ups of a plan in the order in which each adds most, and what is left after it.
struct PlanChoice {
  std::vector<std::size_t> chosen;
  std::vector<double> rms_u;
};
// Greedy: `count` of the set-ups. What is known of everything is a weak prior besides the
// problem's own, so that every part of the plan can be solved.
[[nodiscard]] PlanChoice choose_setups(const Problem& problem, const std::vector<Pose>& places,
                                       const Vec3& tool_point, std::size_t count);

}  // namespace volcomp::host::identify
