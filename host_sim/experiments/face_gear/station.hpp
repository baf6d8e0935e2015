#pragma once
// The YK7280 on its bus: axes, node with tables, a probe on a swing arm, a face gear on the table.

#include <memory>

#include "comp/metrology/faces/measuring_grid.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/sim/artefacts/face_gear.hpp"
#include "host_sim/sim/controller/prober.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::face_gear {

// What all stations of a run share; outlives them.
struct FaceHall {
  host::MachineFile file;
  sim::TrueMachine truth;
  FaceGear gear;              // as drawn
  Frame mounting;             // of the gear on the table, as it really is
  sim::FaceDeviation errors;  // of the gear itself
  sim::BusAxesFactory make_axes;
  double cycle_hz = sim::kBusCycleOfFive_hz;
  std::uint64_t seed = 1;
};

// Both are limits the paper gives (docs/papers/face-gear.md, "What stays open").
inline constexpr double kScaleStep_rad = 1.8 / 3600.0 * kPi / 180.0;  // of the table
inline constexpr double kArmRepeatability_mm = 3e-3;                  // of the swing arm

// One flank of one slot.
struct FlankName {
  int side = 1;
  int slot = 0;
};

inline constexpr std::uint32_t kGearId = 1;  // of the gear on the table, for the node
inline constexpr double kGate_mm = 0.25;     // more than a frame is off before it was found

// A touch as the node reports it.
struct FaceStationTouch {
  Vec3 ball = Vec3::Zero();  // centre, in the assumed gear frame
  sim::FlankJudgement judgement;
};

class FaceStation {
 public:
  // The arm is deployed once. `believed`: the assumed gear frame in the work frame, until
  // believe().
  FaceStation(const FaceHall& hall, const MachineTables& tables, const Frame& believed);

  // The arm swings out and back: the ball is up to kArmRepeatability_mm from where it was, and a
  // frame that was solved before is stale.
  void deploy_arm();
  [[nodiscard]] unsigned deployments() const { return deployments_; }

  void believe(const Frame& mounting);
  [[nodiscard]] const Frame& believed() const { return believed_; }

  // Turns the slot to the arm, touches this point of its flank, given for slot 0, along the normal.
  // Sends `row` and `column` to the node. Throws UserError when nothing was touched.
  [[nodiscard]] FaceStationTouch touch(const FlankName& flank, const SurfacePoint& at,
                                       std::size_t row, std::size_t column);
  void retract();

 private:
  [[nodiscard]] Pose pose_at(const Vec3& in_gear) const;
  [[nodiscard]] Pose above_tips(Pose at) const;
  void turn_to(int slot);
  void approach(const FlankName& flank, const Pose& from);

  const FaceHall& hall_;
  MachineChain chain_;
  sim::TrueMachine truth_;  // with the arm as it has come to stand
  sim::FaceGearOnTable gear_;
  sim::Random random_;
  Frame believed_;
  sim::BusAxes* axes_ = nullptr;
  std::unique_ptr<sim::MotionCell> cell_;
  std::unique_ptr<sim::Prober> prober_;
  unsigned deployments_ = 0;
  double table_ = 0.0;  // C, rad
  bool clear_ = true;   // the ball is above the tips
  Pose last_{};
  FlankName last_flank_{0, -1};
};

}  // namespace volcomp::face_gear
