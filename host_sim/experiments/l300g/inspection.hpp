#pragma once
// Inspecting the master gear: profile and lead of one tooth or several, pitch of all teeth, both
// flanks, from points of the node (docs/papers/l300g.md, "What we do").

#include "host_sim/experiments/l300g/inspection_plan.hpp"
#include "host_sim/host/measure/gear_inspection.hpp"

namespace volcomp::l300g {

// How a point and a trace become figures.
struct InspectionRules {
  std::size_t touches = 1;  // of a point; their mean counts
  bool filter = false;  // low-pass before evaluation (trace_filter.hpp), as ISO 1328-1:2013 asks
  TracePlan traces{};
};

// Total deviation of several teeth, beside that of the worst; µm. With one tooth all are alike.
struct SeveralTeeth {
  double mean = 0.0;           // what gear centres print
  double of_mean_trace = 0.0;  // hides what differs between teeth
};

// By kSides.
struct GearInspection {
  // Of the tooth with the largest total deviation, which a grade is about.
  std::array<host::FlankTrace, 2> profile;
  std::array<host::FlankTrace, 2> lead;
  std::array<SeveralTeeth, 2> profile_teeth{};
  std::array<SeveralTeeth, 2> lead_teeth{};
  std::array<host::PitchRound, 2> pitch;
  std::string program;  // that does the same (inspection_program.hpp); empty where nothing moved
};

// What a perfect machine would find.
[[nodiscard]] GearInspection true_gear(const InvoluteGear& gear);

class GearInspector {
 public:
  // The gear stands on A as long as the inspector is used.
  GearInspector(Grinder& grinder, const InspectionSetup& setup, const InspectionRules& rules = {})
      : grinder_(grinder), setup_(setup), rules_(rules) {}

  [[nodiscard]] GearInspection inspect();

  // A touch moves at `probing` from `stand_off` away. mm and mm/s, at the ball. The ball stays in
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
  // As touched.
  [[nodiscard]] host::FlankTrace profile(const Flank& flank);
  [[nodiscard]] host::FlankTrace lead(const Flank& flank);
  // Filtered where the rules say so, evaluated and graded.
  void evaluate_profile(host::FlankTrace& trace) const;
  void evaluate_lead(host::FlankTrace& trace) const;
  [[nodiscard]] host::PitchRound pitch(FlankSide side);
  [[nodiscard]] Vec3 mean_point(const FlankTouch& wanted);
  void approach(const Pose& from);

  Grinder& grinder_;
  InspectionSetup setup_;
  InspectionRules rules_;
  bool beside_gear_ = true;  // it is there
  Pose last_{};              // where the last touch began
};

}  // namespace volcomp::l300g
