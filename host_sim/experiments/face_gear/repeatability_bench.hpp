#pragma once
// The YK7280 with a plate or a ring in place of the gear: one point after another, each touched in
// a straight line.

#include <memory>
#include <utility>

#include "host_sim/experiments/face_gear/station.hpp"

namespace volcomp::face_gear {

// The face of a plate that is square to an axis of the machine: material below `at`.
class Plate final : public sim::Artefact {
 public:
  Plate(std::size_t axis, double at) : axis_(static_cast<Eigen::Index>(axis)), at_(at) {}

  [[nodiscard]] sim::Gap gap(const Vec3& centre, double ball_radius) const override {
    return {centre(axis_) - at_ - ball_radius, Vec3::Unit(axis_)};
  }

 private:
  Eigen::Index axis_;
  double at_;
};

// The bore of a ring, its axis along Z.
class Ring final : public sim::Artefact {
 public:
  Ring(double radius, Vec3 middle) : radius_(radius), middle_(std::move(middle)) {}

  // Every direction is as near from the axis: −X then.
  [[nodiscard]] sim::Gap gap(const Vec3& centre, double ball_radius) const override {
    Vec3 out = centre - middle_;
    out.z() = 0.0;
    const double distance = out.norm();
    const Vec3 inwards = distance > 0.0 ? Vec3(-out / distance) : Vec3(-Vec3::UnitX());
    return {radius_ - distance - ball_radius, inwards};
  }

 private:
  double radius_;
  Vec3 middle_;
};

// A touch that comes from `off` along the normal and would end beyond.
struct StraightTouch {
  Vec3 surface;  // nominal, base frame, mm
  Vec3 normal;   // unit, out of the material
};

class RepeatabilityBench {
 public:
  // Uncompensated. `hall`: of it machine, bus and scatter.
  explicit RepeatabilityBench(const FaceHall& hall);

  // The arm swings out and back.
  void deploy_arm();
  // Goes there, has the artefact set up, touches it: where along the normal the node has found it,
  // µm from nominal. The artefact must outlive the touch.
  [[nodiscard]] double touch(const sim::Artefact& artefact, const StraightTouch& at);

 private:
  const FaceHall& hall_;
  sim::TrueMachine truth_;  // with the arm as it has come to stand
  sim::Random random_;
  sim::BusAxes* axes_ = nullptr;
  std::unique_ptr<sim::MotionCell> cell_;
  std::unique_ptr<sim::Prober> prober_;
  Plate nothing_{0, -1e6};  // what stands there while the ball goes from place to place
  std::uint32_t set_ups_ = 0;
};

}  // namespace volcomp::face_gear
