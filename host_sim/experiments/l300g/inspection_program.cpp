#include "host_sim/experiments/l300g/inspection_program.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {
namespace {

constexpr double kDegrees = 180.0 / kPi;
constexpr double kRapid_mm_min = 3000.0;
constexpr double kProbing_mm_min = 300.0;
constexpr double kRetract_mm_min = 1200.0;
constexpr double kStandOff_mm = 0.2;

class Program {
 public:
  Program(const InspectionSetup& setup, const std::string& title, OffsetFor offset_for)
      : setup_(setup), offset_for_(std::move(offset_for)) {
    add("%");
    comment(title);
    comment(fmt::format("master gear z {} m {}, effective radius of the ball {:.5f} mm",
                        setup.gear.teeth, setup.gear.module, setup.ball_radius));
    comment("B probes: interpreters that keep rotary axes still while probing cannot run this");
    add("G21 G90 G94");  // mm, absolute, feed per minute
  }

  void trace(const std::string& name, const std::vector<FlankTouch>& touches, bool out_after_each) {
    comment(name);
    bool outside = true;
    for (const FlankTouch& touch : touches) {
      const FlankMove move = flank_move(setup_, touch, kStandOff_mm);
      compensation_ = offset_for_(move.contact);
      Pose beside = move.from;
      beside[1] = setup_.beside();
      if (outside) straight(beside);
      straight(move.from);
      swing("G38.2", move.beyond, kProbing_mm_min, move.lift_mm);
      swing("G1", move.from, kRetract_mm_min, move.lift_mm);
      outside = out_after_each || &touch == &touches.back();
      if (outside) straight(beside);
    }
  }

  std::string end() {
    add("M2\n%");
    return std::move(text_);
  }

 private:
  void add(const std::string& line) { text_ += line + "\n"; }
  void comment(const std::string& words) { add("(" + words + ")"); }

  void straight(const Pose& to) {
    const Pose q = compensated(to);
    add(fmt::format("G1 X{:.5f} Y{:.5f} B{:.6f} A{:.6f} F{:.0f}", q[0], q[1], kDegrees * q[2],
                    kDegrees * q[3], kRapid_mm_min));
  }
  void swing(const char* word, const Pose& to, double mm_min, double lift_mm) {
    const Pose q = compensated(to);
    add(fmt::format("{} B{:.6f} F{:.2f}", word, kDegrees * q[2], kDegrees * mm_min / lift_mm));
  }

  [[nodiscard]] Pose compensated(Pose pose) const {
    for (std::size_t a = 0; a < pose.size(); ++a)
      pose[a] += compensation_[a];
    return pose;
  }

  const InspectionSetup& setup_;
  OffsetFor offset_for_;
  Pose compensation_{};  // of the touch
  std::string text_;
};

}  // namespace

Pose no_offset(const Pose&) { return {}; }

Pose compensation_at(const VolumetricModel& model, const Pose& pose) {
  constexpr int kEvaluations = 3;  // E changes by less than 1e-4 of what it moves the axes
  MotionOffset found;
  for (int i = 0; i < kEvaluations; ++i) {
    Pose q = pose;
    for (std::size_t a = 0; a < q.size(); ++a)
      q[a] += found.offset[a];
    const Vec3 error = model.second_order(q, kUnknownTravels, Beyond::stand_at_end);
    host::require(motion_offset(model.chain, pose, model.tool_point, error, found), "compensation");
  }
  return found.offset;
}

std::string inspection_program(const InspectionSetup& setup, const std::string& title,
                               const OffsetFor& offset_for) {
  Program program(setup, title, offset_for);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const char* const side_name = kSideNames[side];
    const std::size_t points = setup.traces.points;
    for (const int number : traced_teeth(setup.gear, setup.traces)) {
      const Flank tooth{kSides[side], number};
      const auto name = [&](const char* trace) {
        return fmt::format("{} flank, {} of tooth {}", side_name, trace, number);
      };
      program.trace(name("profile"), profile_touches(setup.gear, tooth, points), false);
      program.trace(name("lead"), lead_touches(setup.gear, tooth, points), false);
    }
    program.trace(fmt::format("{} flank, pitch", side_name),
                  pitch_touches(setup.gear, kSides[side]), true);
  }
  return program.end();
}

}  // namespace volcomp::l300g
