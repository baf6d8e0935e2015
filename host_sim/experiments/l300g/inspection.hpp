#pragma once
// Inspecting the master gear: profile and lead of tooth 0, pitch of all teeth, both flanks, from
// points of the node (seed 000 section 4).

#include <optional>
#include <vector>

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_tolerance.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "host_sim/experiments/l300g/inspection_plan.hpp"

namespace volcomp::l300g {

struct FlankTrace {
  std::vector<double> at;         // roll length or x, mm
  std::vector<double> deviation;  // µm, excess positive
  EvaluationRange range;          // of the edition of 1995
  TraceDeviations figures;        // over it, µm
  std::optional<int> grade_1995;  // of the total deviation; none: worse than the last
  std::optional<int> grade_2013;
};

struct PitchRound {
  std::vector<double> position;   // of each tooth from where it should be, µm
  PitchDeviations figures;        // µm
  std::optional<int> grade_1995;  // the worse of single and total pitch
};

// Traces by kSides.
struct GearInspection {
  std::array<FlankTrace, 2> profile;
  std::array<FlankTrace, 2> lead;
  std::array<PitchRound, 2> pitch;
  std::string program;  // that does the same (inspection_program.hpp); empty where nothing moved
};

// What a perfect machine would find.
[[nodiscard]] GearInspection true_gear(const InvoluteGear& gear);

[[nodiscard]] GearSize size_of(const InvoluteGear& gear);

class GearInspector {
 public:
  // The gear stands on A as long as the inspector is used.
  GearInspector(Grinder& grinder, const InspectionSetup& setup)
      : grinder_(grinder), setup_(setup) {}

  [[nodiscard]] GearInspection inspect();

  // One touch, as fast as told, from `stand_off` away. mm and mm/s, at the ball. The ball stays in
  // the tooth space.
  struct Speed {
    double probing = 5.0;
    double stand_off = 0.2;
  };
  [[nodiscard]] sim::NodePoint touch(const FlankTouch& touch, const Speed& speed);
  // Normal to the flank, excess positive, mm.
  struct Deviation {
    double mm = 0.0;
    double roll_length = 0.0;
  };
  [[nodiscard]] Deviation deviation(const Flank& flank, const Vec3& point) const;
  // How far the touched point lies outside the involute, transverse, mm.
  [[nodiscard]] FlankDistance distance(const Flank& flank, const Vec3& point) const;
  // Out of the tooth space along Y.
  void retract();

 private:
  [[nodiscard]] FlankTrace profile(FlankSide side);
  [[nodiscard]] FlankTrace lead(FlankSide side);
  [[nodiscard]] PitchRound pitch(FlankSide side);
  void approach(const Pose& from);

  Grinder& grinder_;
  InspectionSetup setup_;
  bool beside_gear_ = true;  // it is there
  Pose last_{};              // where the last touch began
};

}  // namespace volcomp::l300g
