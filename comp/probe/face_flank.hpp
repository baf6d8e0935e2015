#pragma once
// Flanks of a face gear by their parameters: roll angle θ ≥ 0 and pressure angle β > 0. Points,
// normals and derivatives of the generated flank, and of the flank with tip relief. No libm: the
// same bits on every target. See docs/papers/face-gear.md.

#include "comp/machine/error_motion.hpp"
#include "comp/probe/face_gear.hpp"
#include "comp/probe/face_kernel.hpp"

namespace volcomp {

struct FaceParameters {
  double theta = 0.0;
  double beta = 0.0;
};

struct FacePoint {
  Vec3 point;
  Vec3 normal;  // unit, out of the material
};

// The tip relief at the depth `z` of a generated point, and its derivatives by that depth.
struct ReliefAt {
  double depth = 0.0;   // how far the flank is set back, ≥ 0, mm
  double slope = 0.0;   // per mm
  double change = 0.0;  // of the slope, per mm²
};
[[nodiscard]] ReliefAt relief_at(const TipRelief& relief, double z);

// What travels with a point of the flank of side +1 in slot 0: e1 and e2 tangential, n the normal
// of the generated flank, all unit. The point itself is (u, r_bs, −r_bs θ) in it.
class FaceTriad {
 public:
  FaceTriad(const FaceGear& gear, const FaceParameters& at);

  [[nodiscard]] Vec3 to_gear(const Vec3& v) const;    // from components along e1, e2, n
  [[nodiscard]] Vec3 from_gear(const Vec3& v) const;  // the inverse

  double beta_sine = 0.0;
  double beta_cosine = 1.0;

 private:
  double turn_sine_ = 0.0;  // of the gear turn φ_2
  double turn_cosine_ = 1.0;
};

// Point of the generated flank.
[[nodiscard]] FacePoint face_point(const FaceGear& gear, const FaceFlank& flank,
                                   const FaceParameters& at);

struct FacePartials {
  Vec3 point_theta;  // mm per rad
  Vec3 point_beta;
  Vec3 normal_theta;  // per rad
  Vec3 normal_beta;
};
[[nodiscard]] FacePartials face_partials(const FaceGear& gear, const FaceFlank& flank,
                                         const FaceParameters& at);

// Point of the flank with its relief: `at` is the generated point that it is set back from. The
// normal is that of the relieved surface.
[[nodiscard]] FacePoint relieved_face_point(const FaceGear& gear, const FaceFlank& flank,
                                            const FaceParameters& at);

// Tangents of the relieved flank along e1, e2, n, and how they change along the surface.
struct ReliefTangents {
  Vec3 point;  // of the relieved flank
  Vec3 theta;
  Vec3 beta;
  Vec3 theta_theta;
  Vec3 theta_beta;
  Vec3 beta_beta;
};
[[nodiscard]] ReliefTangents relief_tangents(const FaceGear& gear, const FaceTriad& triad,
                                             const FaceParameters& at);

}  // namespace volcomp
