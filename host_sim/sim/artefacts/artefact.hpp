#pragma once
// What a probe ball can touch. Everything in the work frame of the machine, mm.

#include "comp/machine/error_motion.hpp"

namespace volcomp::sim {

struct Gap {
  double mm = 0.0;             // between the ball and the material; negative: how deep it is inside
  Vec3 normal = Vec3::Zero();  // unit, out of the material, where the ball is nearest to it
};

class Artefact {
 public:
  Artefact() = default;
  Artefact(const Artefact&) = delete;
  Artefact& operator=(const Artefact&) = delete;
  virtual ~Artefact() = default;

  // For a ball of this radius (≥ 0) about `centre`.
  [[nodiscard]] virtual Gap gap(const Vec3& centre, double ball_radius) const = 0;
};

}  // namespace volcomp::sim
