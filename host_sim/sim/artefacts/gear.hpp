#pragma once
// External involute gear, spur or helical, as it stands on the axis of A: axis along X, from x = 0
// to its width, tooth 0 centred on +Y at x = 0. Its flanks may deviate from the involute.

#include <functional>

#include "comp/metrology/gears/involute_gear.hpp"
#include "host_sim/sim/artefacts/artefact.hpp"

namespace volcomp::sim {

// Excess material of a flank where it has this roll length and x, mm normal to the flank.
using FlankDeviation = std::function<double(const Flank& flank, double roll_length, double x)>;

class Gear final : public Artefact {
 public:
  // `gear` as derive() has left it.
  explicit Gear(const InvoluteGear& gear, FlankDeviation deviation = {});

  // Exact where a flank, a tip, a face or the ground of a tooth space is nearest; across an edge
  // between two of them never more than the truth. A centre inside the base circle, where there is
  // no involute, counts as inside the material.
  [[nodiscard]] Gap gap(const Vec3& centre, double ball_radius) const override;

  // To one flank alone, wherever it would go on to; the centre is outside the base circle.
  [[nodiscard]] Gap gap_to_flank(const Flank& flank, const Vec3& centre, double ball_radius) const;

 private:
  [[nodiscard]] Gap gap_to_tooth(int tooth, const Vec3& centre, double ball_radius) const;
  [[nodiscard]] Gap gap_to_blank(const Vec3& centre, double outer_radius, double ball_radius) const;
  [[nodiscard]] int nearest_tooth(const Vec3& centre) const;

  InvoluteGear gear_;
  FlankDeviation deviation_;
};

}  // namespace volcomp::sim
