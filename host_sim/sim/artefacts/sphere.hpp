#pragma once
// Reference sphere.

#include <utility>

#include "host_sim/sim/artefacts/artefact.hpp"

namespace volcomp::sim {

class Sphere final : public Artefact {
 public:
  Sphere(Vec3 centre, double radius) : centre_(std::move(centre)), radius_(radius) {}

  // Nothing is nearest to the very centre: +Z then.
  [[nodiscard]] Gap gap(const Vec3& centre, double ball_radius) const override {
    const Vec3 from_middle = centre - centre_;
    const double distance = from_middle.norm();
    const Vec3 normal = distance > 0.0 ? Vec3(from_middle / distance) : Vec3(Vec3::UnitZ());
    return {distance - radius_ - ball_radius, normal};
  }

 private:
  Vec3 centre_;
  double radius_;
};

}  // namespace volcomp::sim
