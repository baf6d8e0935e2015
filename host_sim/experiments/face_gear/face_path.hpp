#pragma once
// Where the axes of the YK7280 stand so that its ball is beside a flank: the table turns the slot
// to the arm, the slides do the rest. For the simulated controller and for NC programs alike.

#include <utility>

#include "comp/core/units.hpp"
#include "comp/machine/frame.hpp"
#include "comp/machine/machine_chain.hpp"
#include "comp/metrology/faces/measuring_grid.hpp"
#include "comp/probe/face_gear.hpp"

namespace volcomp::face_gear {

// One flank of one slot.
struct FlankName {
  int side = 1;
  int slot = 0;
};

// A limit the paper gives: step of the scale of the table.
inline constexpr double kScaleStep_rad = 1.8 / 3600.0 * kPi / 180.0;

inline constexpr double kStandOff_mm = 0.4;    // of the ball before a touch
inline constexpr double kAgain_mm = 0.15;      // before one more of the same point
inline constexpr double kOverTravel_mm = 0.4;  // as far as it may go without one

class FacePath {
 public:
  // `mounting`: the gear frame in the work frame, as assumed. Chain and gear must outlive the path.
  FacePath(const MachineChain& chain, const FaceGear& gear, Frame mounting)
      : chain_(chain), gear_(gear), mounting_(std::move(mounting)) {}

  // C with this slot at the arm: the nearest line of the scale, rad, 0…2π.
  [[nodiscard]] double table_at(int slot) const;
  // The centre of the ball `off` along the normal from this point, which is given for slot 0 and
  // its flank at y > 0.
  [[nodiscard]] Pose ball_at(const FlankName& flank, const SurfacePoint& at, double off,
                             double table) const;
  // The same with the ball clear of the gear.
  [[nodiscard]] Pose above_tips(Pose at) const;

 private:
  [[nodiscard]] Pose pose_at(const Vec3& in_gear, double table) const;

  const MachineChain& chain_;
  const FaceGear& gear_;
  Frame mounting_;
};

}  // namespace volcomp::face_gear
