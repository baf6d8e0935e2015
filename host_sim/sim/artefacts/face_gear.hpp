#pragma once
// A face gear as it stands on the table of a machine, with its own deviations.

#include <functional>

#include "comp/machine/frame.hpp"
#include "comp/probe/face_gear.hpp"
#include "host_sim/sim/artefacts/artefact.hpp"

namespace volcomp::sim {

// Excess material of a flank, mm along its normal: `side` ±1, `slot`, and the foot in the frame of
// that flank, where it is the one at y > 0 of slot 0.
using FaceDeviation = std::function<double(int side, int slot, const Vec3& foot)>;

class FaceGearOnTable final : public Artefact {
 public:
  // `gear` as derive() has left it; `mounting`: of the gear frame in the work frame of the machine.
  FaceGearOnTable(const FaceGear& gear, Frame mounting, FaceDeviation deviation = {});

  // Difference of the table from the reading of its scale, rad.
  void turn_table(double angle) { turned_ = angle; }

  // Exact where a flank or the plane of the tips is nearest; across an edge never more than the
  // truth. Where there is no flank the gear counts as solid up to its tips.
  [[nodiscard]] Gap gap(const Vec3& centre, double ball_radius) const override;

 private:
  [[nodiscard]] Gap gap_in_slot(const Vec3& centre, double ball_radius) const;
  [[nodiscard]] Gap gap_to_blank(const Vec3& centre, double ball_radius) const;

  FaceGear gear_;
  Frame mounting_;
  FaceDeviation deviation_;
  double turned_ = 0.0;
};

}  // namespace volcomp::sim
