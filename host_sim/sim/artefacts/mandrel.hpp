#pragma once
// Cylinder along X, as long as the machine reaches: the mandrel a gear machine is calibrated on.

#include "host_sim/sim/artefacts/artefact.hpp"

namespace volcomp::sim {

class Mandrel final : public Artefact {
 public:
  // Its axis runs through (0, y, z).
  explicit Mandrel(double radius, double y = 0.0, double z = 0.0)
      : radius_(radius), on_axis_(0.0, y, z) {}

  // Nothing is nearest to a point on the axis: +Z then.
  [[nodiscard]] Gap gap(const Vec3& centre, double ball_radius) const override {
    Vec3 radial = centre - on_axis_;
    radial.x() = 0.0;
    const double distance = radial.norm();
    const Vec3 normal = distance > 0.0 ? Vec3(radial / distance) : Vec3(Vec3::UnitZ());
    return {distance - radius_ - ball_radius, normal};
  }

 private:
  double radius_;
  Vec3 on_axis_;
};

}  // namespace volcomp::sim
