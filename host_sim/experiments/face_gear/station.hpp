#pragma once
// The YK7280 on its bus: axes, node with tables, a probe on a swing arm, a face gear on the table.

#include <functional>
#include <memory>
#include <optional>

#include "comp/tables/machine_tables.hpp"
#include "host_sim/experiments/face_gear/face_path.hpp"
#include "host_sim/sim/artefacts/face_gear.hpp"
#include "host_sim/sim/controller/prober.hpp"
#include "host_sim/sim/instruments/probe_signature.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::face_gear {

// What touches do besides touching, and which random numbers they take.
struct FaceScatter {
  sim::ProbeSignature probe;   // none by default
  double slide_step_mm = 0.0;  // of the scales of the slides: a reading lies anywhere in a step
  std::uint64_t seed = 1;

  // Standard deviation of a touch along the normal. Rounding three coordinates independently of one
  // another scatters by the same in every direction.
  [[nodiscard]] double sigma_mm() const;
  // What each touch adds, by its number within a set-up (touch_probe.hpp); empty without scatter.
  // Another set-up, other numbers.
  [[nodiscard]] std::function<double(std::uint32_t touch)> of_set_up(std::uint32_t set_up) const;
};

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
  FaceScatter scatter{};
  std::optional<LobingMap> radius{};  // as calibrated; none: the one of the machine file
};

// Limits the paper gives (docs/papers/face-gear.md, "The machine").
inline constexpr double kSlideStep_mm = 1e-3;         // of the scales of the slides
inline constexpr double kArmRepeatability_mm = 3e-3;  // of the swing arm

inline constexpr std::uint32_t kGearId = 1;  // of the gear on the table, for the node
inline constexpr double kGate_mm = 0.25;     // more than a frame is off before it was found

// A touch as the node reports it.
struct FaceStationTouch {
  Vec3 ball = Vec3::Zero();  // centre, in the assumed gear frame
  sim::FlankJudgement judgement;
  double radius = 0.0;         // effective in the direction of the touch, mm
  Vec3 normal = Vec3::Zero();  // of the part there, in that frame

  // Where the centre of a ball of another radius would have been.
  [[nodiscard]] Vec3 centre_of(double other) const { return ball + (other - radius) * normal; }
};

enum class TouchFrom : std::uint8_t { beside, where_it_was };

class FaceStation {
 public:
  // The arm is deployed once. `believed`: the assumed gear frame in the work frame, until
  // believe(). `placement`: another number for every station of a run, for its random numbers.
  FaceStation(const FaceHall& hall, const MachineTables& tables, const Frame& believed,
              std::uint32_t placement = 0);

  // The arm swings out and back: the ball is up to kArmRepeatability_mm from where it was, and a
  // frame that was solved before is stale.
  void deploy_arm();
  [[nodiscard]] unsigned deployments() const { return deployments_; }

  void believe(const Frame& mounting);
  [[nodiscard]] const Frame& believed() const { return believed_; }

  // Turns the slot to the arm, touches this point of its flank, given for slot 0, along the normal.
  // Sends `row` and `column` to the node. Throws UserError when nothing was touched. `away`: from
  // there the ball sets out; nearer when the same point is touched once more.
  [[nodiscard]] FaceStationTouch touch(const FlankName& flank, const SurfacePoint& at,
                                       std::size_t row, std::size_t column,
                                       TouchFrom away = TouchFrom::beside);
  void retract();

 private:
  [[nodiscard]] FacePath path() const { return {chain_, hall_.gear, believed_}; }
  // Effective radius where the part pushes the ball along `normal` (base), mm.
  [[nodiscard]] double effective_radius(const Pose& at, const Vec3& normal) const;
  void arrive_at(int slot);
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
  std::uint32_t placement_ = 0;
  unsigned deployments_ = 0;
  double table_ = 0.0;  // C, rad
  bool clear_ = true;   // the ball is above the tips
  Pose last_{};
  FlankName last_flank_{0, -1};
};

}  // namespace volcomp::face_gear
