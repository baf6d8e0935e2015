#pragma once
// How far a point stands off a flank of a face gear: at the trigger, and everywhere else.
//
// The normals of a generated flank all have the same moment arm C about the gear axis, so a surface
// parallel to the flank is the flank turned about that axis, and the distance is C times an angle
// that needs one scalar equation: exact at any distance. No libm: the same bits on every target.
// Interrupt-safe. See docs/papers/face-gear.md, "What we do".

#include <limits>

#include "comp/core/status.hpp"
#include "comp/machine/double3.hpp"
#include "comp/machine/error_motion.hpp"
#include "comp/probe/face_gear.hpp"

namespace volcomp {

// One flank: +1 is the flank at y > 0 of slot 0, −1 its mirror image.
struct FaceFlank {
  double side = 1.0;
  double cosine = 1.0;  // of the polar angle of the slot
  double sine = 0.0;
};

// Between the gear frame and that of the flank, where it is the one at y > 0 of slot 0.
[[nodiscard]] inline Vec3 to_flank(const FaceFlank& flank, const Vec3& v) {
  return {sum_of_products(flank.cosine, v[0], flank.sine, v[1]),
          flank.side * sum_of_products(flank.cosine, v[1], -flank.sine, v[0]), v[2]};
}
[[nodiscard]] inline Vec3 from_flank(const FaceFlank& flank, const Vec3& v) {
  const double y = flank.side * v[1];
  return {sum_of_products(flank.cosine, v[0], -flank.sine, y),
          sum_of_products(flank.sine, v[0], flank.cosine, y), v[2]};
}

// `side` ±1, `slot` 0…teeth − 1: as commanded, for near the tip the nearest slot is not always the
// one that was meant. Refused: bad_point with the field.
Status choose_flank(const FaceGear& gear, int side, int slot, FaceFlank& out);

// Where the flank of side +1 is cut by the circle of a radius at a depth.
struct FaceSection {
  double inverse_cosine = 1.0;  // 1/cos β
  double tangent = 0.0;         // tan β
  double beta = 0.0;            // pressure angle
  double t = 0.0;               // tangential coordinate before the gear turn, mm
  double roll = 0.0;            // θ of the point of the section
  double slot_turn = 0.0;       // i (θ − θ_0 − β): angle the gear turned by when it was cut
  int steps = 0;                // of Newton's method
};

inline constexpr int kMaxFaceSteps = 12;

// `rho_squared` > 0, finite. ok, inside_gear_base (within 1.0005 C), no_regular_flank: there the
// equation has no root, or none with 0.02 < β ≤ 1.4. At most kMaxFaceSteps of Newton's method;
// 4 for a ball of 0.5 mm on the points of Table 3.
[[nodiscard]] Reason cut_flank(const FaceGear& gear, double rho_squared, double z,
                               FaceSection& out);

// The foot of the perpendicular from a point to a flank, in the gear frame.
struct FaceFoot {
  FaceFoot();

  Reason reason = Reason::not_finite;
  int steps = 0;                                               // of Newton's method
  double distance = std::numeric_limits<double>::quiet_NaN();  // λ, > 0 on the free side, mm
  double theta = 0.0;                                          // roll angle
  double beta = 0.0;                                           // pressure angle
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, out of the material
};

// There is a distance: the foot is on the flank (ok) or on its continuation (below_involute,
// undercut, in_fillet, above_tip).
[[nodiscard]] constexpr bool has_distance(Reason reason) {
  return reason == Reason::ok || reason == Reason::below_involute || reason == Reason::undercut ||
         reason == Reason::in_fillet || reason == Reason::above_tip;
}

// Distance of a point `q` (gear frame) from the generated flank, without relief. The first that
// applies of: not_finite, inside_gear_base, no_regular_flank (NaN distance), and by the foot:
// below_involute, undercut, in_fillet, above_tip. Error ≤ 2e-13 mm on the two gears of the paper.
[[nodiscard]] FaceFoot distance_from_face(const FaceGear& gear, const FaceFlank& flank,
                                          const Vec3& q);

// The same for both flanks of the slot, for little more: the section serves both.
struct FaceFeet {
  FaceFoot here;
  FaceFoot opposite;
};
[[nodiscard]] FaceFeet distances_in_slot(const FaceGear& gear, const FaceFlank& flank,
                                         const Vec3& q);

}  // namespace volcomp
