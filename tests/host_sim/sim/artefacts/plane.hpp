#pragma once
// Half a world of material behind a plane.

#include <utility>

#include "host_sim/sim/artefacts/artefact.hpp"

namespace volcomp::test {

class Plane final : public sim::Artefact {
 public:
  // `outward`: any length but zero.
  Plane(Vec3 point, const Vec3& outward)
      : point_(std::move(point)), normal_(outward.normalized()) {}

  [[nodiscard]] sim::Gap gap(const Vec3& centre, double ball_radius) const override {
    return {normal_.dot(centre - point_) - ball_radius, normal_};
  }

 private:
  Vec3 point_;
  Vec3 normal_;
};

}  // namespace volcomp::test
