#pragma once
// Where a face gear stands on the turntable, from one ball that touches one flank
// (docs/papers/face-gear.md, "What we do").

#include "comp/probe/face_kernel.hpp"

namespace volcomp {

// The workpiece frame of a machine whose Z points out of the table, opposite to that of the gear:
// p_machine = origin + diag(1, −1, −1) Rz(angle) p_gear, mm and rad. Corrected eq. 19 to 24.
struct FacePlacement {
  Vec3 origin = Vec3::Zero();  // of the gear frame, in the machine
  double angle = 0.0;
};
[[nodiscard]] Vec3 to_machine(const FacePlacement& placement, const Vec3& p);
[[nodiscard]] Vec3 to_gear(const FacePlacement& placement, const Vec3& p);
[[nodiscard]] Vec3 direction_to_machine(const FacePlacement& placement, const Vec3& direction);

// A touch of the commanded flank: `centre` of the ball in a frame that is turned about the gear
// axis by an unknown angle γ, p_gear = Rz(γ) p.
struct FaceContact {
  FaceFlank flank;
  double ball_radius = 0.0;  // mm, > 0
  Vec3 centre = Vec3::Zero();
};

// γ from the generated flank, in closed form; not wrapped: between −π and π minus or plus half a
// slot for slot 0. Refused: not_finite, bad_point (radius), and what distance_from_face refuses
// the turned centre for.
Status face_angle(const FaceGear& gear, const FaceContact& contact, double& gamma);

struct FaceAngle {
  double gamma = 0.0;
  double rest = 0.0;    // distance − radius there, mm
  int evaluations = 0;  // of the distance
};

inline constexpr int kMaxAngleSteps = 20;

// γ from the relieved flank: γ += side (distance − radius)/C, which is one step for a generated
// flank and gains two digits each for a relieved one. From `start`, at most half a pitch off, to
// |rest| ≤ `tolerance` (mm, ≥ 1e-12). Refused as above; bad_setting (tolerance);
// residuals_too_large where that is not reached in kMaxAngleSteps.
Status relieved_face_angle(const FaceGear& gear, const FaceContact& contact, double start,
                           double tolerance, FaceAngle& out);

}  // namespace volcomp
