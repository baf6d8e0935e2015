#include "host_sim/experiments/face_gear/inspection_program.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::face_gear {
namespace {

constexpr double kBlockRapid_mm_min = 3000.0;
constexpr double kBlockProbing_mm_min = 300.0;
constexpr double kBlockRetract_mm_min = 1200.0;

class FaceProgram {
 public:
  FaceProgram(const FaceProgramSetup& setup, const std::string& title,
              const FaceOffsetFor& offset_for)
      : setup_(setup), offset_for_(offset_for) {
    add("%");
    comment(title);
    comment(fmt::format("face gear z {} m {:g}, effective radius of the ball {:.5f} mm",
                        setup.gear.teeth, setup.gear.module, setup.ball_radius));
    add("G21 G90 G94");  // mm, absolute, feed per minute
  }

  void touch(const std::string& name, const std::vector<PlannedTouch>& touches) {
    comment(name);
    for (const PlannedTouch& planned : touches) {
      go_over(planned.flank);
      const FaceGridNode& node = setup_.grid[planned.row][planned.column];
      const auto ball = [&](double off) {
        return setup_.path.ball_at(planned.flank, {node.point, node.normal}, off, table_);
      };
      const double r = setup_.ball_radius;
      compensation_ = offset_for_(ball(r));
      const Pose beside = ball(r + kStandOff_mm);
      if (!down_) straight("G1", setup_.path.above_tips(beside), kBlockRapid_mm_min);
      down_ = true;
      straight("G1", beside, kBlockRapid_mm_min);
      for (int k = 0; k < setup_.touches; ++k) {
        straight("G38.2", ball(r - kOverTravel_mm), kBlockProbing_mm_min);
        last_ = k + 1 < setup_.touches ? ball(r + kAgain_mm) : beside;
        straight("G1", last_, kBlockRetract_mm_min);
      }
    }
    up();
  }

  std::string end() {
    add("M2\n%");
    return std::move(text_);
  }

 private:
  void add(const std::string& line) { text_ += line + "\n"; }
  void comment(const std::string& words) { add("(" + words + ")"); }

  // Another flank is reached over the tips, another slot by turning the table.
  void go_over(const FlankName& flank) {
    if (begun_ && flank.slot == last_flank_.slot && flank.side == last_flank_.side) return;
    if (begun_) up();
    const double table = setup_.path.table_at(flank.slot);
    if (!begun_ || flank.slot != last_flank_.slot)
      add(fmt::format("G0 C{:.6f}", table * 180.0 / kPi));
    table_ = table;
    last_flank_ = flank;
    begun_ = true;
  }

  void up() {
    if (!down_) return;
    straight("G1", setup_.path.above_tips(last_), kBlockRapid_mm_min);
    down_ = false;
  }

  void straight(const char* word, const Pose& to, double mm_min) {
    add(fmt::format("{} X{:.5f} Y{:.5f} Z{:.5f} F{:.0f}", word, to[0] + compensation_[0],
                    to[1] + compensation_[1], to[2] + compensation_[2], mm_min));
  }

  const FaceProgramSetup& setup_;
  const FaceOffsetFor& offset_for_;
  Pose compensation_{};  // of the touch
  Pose last_{};
  FlankName last_flank_{};
  double table_ = 0.0;  // rad
  bool begun_ = false;
  bool down_ = false;  // among the teeth
  std::string text_;
};

}  // namespace

Pose no_face_offset(const Pose&) { return {}; }

Pose face_offset_at(const VolumetricModel& model, const Pose& pose) {
  constexpr int kOffsetRounds = 3;  // E changes by less than 1e-4 of what it moves the axes
  MotionOffset found;
  for (int i = 0; i < kOffsetRounds; ++i) {
    Pose there = pose;
    for (std::size_t a = 0; a < there.size(); ++a)
      there[a] += found.offset[a];
    const Vec3 error = model.second_order(there, kUnknownTravels, Beyond::stand_at_end);
    host::require(motion_offset(model.chain, pose, model.tool_point, error, found), "compensation");
  }
  return found.offset;
}

std::string face_program(const FaceProgramSetup& setup, const std::string& title,
                         const FaceOffsetFor& offset_for) {
  FaceProgram program(setup, title, offset_for);
  const int teeth = setup.gear.teeth;
  program.touch("frame", frame_touches(teeth));
  for (const int slot : mapped_slots(setup.flanks, teeth)) {
    for (std::size_t side = 0; side < kFaceSides.size(); ++side)
      program.touch(fmt::format("map, slot {}, {} flank", slot + 1, kFaceSideNames.at(side)),
                    map_touches({kFaceSides.at(side), slot}));
  }
  for (std::size_t side = 0; side < kFaceSides.size(); ++side)
    program.touch(fmt::format("pitch, {} flanks", kFaceSideNames.at(side)),
                  pitch_touches(kFaceSides.at(side), teeth));
  return program.end();
}

}  // namespace volcomp::face_gear
