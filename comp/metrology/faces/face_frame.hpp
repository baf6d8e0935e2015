#pragma once
// The frame of a face gear from many touches: the motion that brings all balls onto their flanks,
// least Σ(distance − radius)² (docs/papers/face-gear.md, "What we do").

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "comp/machine/frame.hpp"
#include "comp/probe/face_kernel.hpp"

namespace volcomp {

// Which motions of the frame are fitted. Only these sets of motions follow from each other to the
// same place whatever the order; the remaining coordinates keep still.
enum class FrameFreedom : std::uint8_t {
  turn,        // about the gear axis
  shift,       // x, y, z
  plane,       // x, y, and about the gear axis
  shift_turn,  // x, y, z, and about the gear axis
  all,         // three shifts and three turns
};
[[nodiscard]] std::size_t unknowns(FrameFreedom freedom);

struct FaceTouchPoint {
  FaceFlank flank;
  Vec3 centre = Vec3::Zero();  // of the ball, in the old frame, mm
};

struct FaceFrameSettings {
  FrameFreedom freedom = FrameFreedom::turn;
  double ball_radius = 0.0;  // mm, > 0; on one side alone it is indistinguishable from a turn
  bool relieved = true;      // false: leave the tip relief of the gear out
  double sigma = 0.004;      // standard deviation to expect of a touch, probe and form, mm
};

// How well touches show the frame. Order: shifts x, y, z, mm; turns about x, y, z, rad.
struct FaceObservability {
  int rank = 0;
  double condition = 0.0;  // largest over smallest singular value, turns in mm at the pitch radius;
                           // infinite where the rank is short
  Eigen::Matrix<double, 6, 6> cofactors = Eigen::Matrix<double, 6, 6>::Zero();
  // Covariance over σ²; zero for what is not looked for, and everywhere where the rank is short.
};

struct FaceFrame {
  Frame frame;  // p_gear = R p_old + t
  FaceObservability observability;
  double rms = 0.0;      // of the residuals, mm
  double largest = 0.0;  // residual of largest magnitude, signed, mm
  int worst = -1;        // its point
  int steps = 0;         // Gauss-Newton
};

inline constexpr int kMaxFrameSteps = 12;

// Observability of touches already given in the gear frame. Refused: too_few_points (none), and,
// with the index, what the distance of a point is refused for.
Status face_observability(const FaceGear& gear, Span<const FaceTouchPoint> points,
                          const FaceFrameSettings& settings, FaceObservability& out);

// `residuals`: empty, or one for each point: distance − radius with the new frame, mm. Refused, and
// nothing is written: length_mismatch, bad_setting (field), not_finite (index), frame_not_fixed
// (count: rank; the points are fewer than the unknowns, the reciprocal condition is below 1e-6, or
// all six are looked for on one side only), the reason a point has no foot on its flank for
// (index), residuals_too_large where the steps do not settle, outlier (index and deviation: a
// residual above 5 sigma, or the rms above 20 µm).
Status fit_face_frame(const FaceGear& gear, Span<const FaceTouchPoint> points,
                      const FaceFrameSettings& settings, Span<double> residuals, FaceFrame& out);

// Standard deviations per unit of noise, mm: shifts, and turns at the pitch radius of the gear.
[[nodiscard]] Eigen::Matrix<double, 6, 1> frame_deviations(const FaceGear& gear,
                                                           const FaceObservability& at);

}  // namespace volcomp
