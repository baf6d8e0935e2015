#include "host_sim/experiments/l300g/inspection.hpp"

#include <utility>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {

GearInspection true_gear(const InvoluteGear& gear) {
  GearInspection truth;
  const OwnDeviation own(gear);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    host::FlankTrace& profile = truth.profile[side];
    for (const FlankTouch& touch : profile_touches(gear, kSides[side])) {
      profile.at.push_back(touch.roll_length);
      profile.deviation.push_back(kUmPerMm * own(touch.roll_length, 0.0));
    }
    host::grade_profile(gear, "true profile", profile);
    host::FlankTrace& lead = truth.lead[side];
    for (const FlankTouch& touch : lead_touches(gear, kSides[side])) {
      lead.at.push_back(touch.x);
      lead.deviation.push_back(kUmPerMm * own(touch.roll_length, touch.x));
    }
    host::grade_lead(gear, "true lead", lead);
    truth.pitch[side].position.assign(static_cast<std::size_t>(gear.teeth), 0.0);
    host::grade_pitch(gear, "true pitch", truth.pitch[side]);
  }
  return truth;
}

void GearInspector::retract() {
  last_[1] = setup_.beside();
  grinder_.go(last_, sim::ProbingFeeds{}.rapid);
  beside_gear_ = true;
}

// Into a tooth space along Y, everything else already where it belongs.
void GearInspector::approach(const Pose& from) {
  last_ = from;
  if (!beside_gear_) return;
  beside_gear_ = false;
  Pose outside = from;
  outside[1] = setup_.beside();
  grinder_.go(outside, sim::ProbingFeeds{}.rapid);
}

sim::NodePoint GearInspector::touch(const FlankTouch& touch, const Speed& speed) {
  const FlankMove move = flank_move(setup_, touch, speed.stand_off);
  approach(move.from);
  constexpr double kRetract_mm_s = 20.0;
  return grinder_.prober().touch(
      move.from, move.beyond, move.normal,
      {sim::ProbingFeeds{}.rapid, speed.probing / move.lift_mm, kRetract_mm_s / move.lift_mm});
}

FlankDistance GearInspector::distance(const Flank& flank, const Vec3& point) const {
  FlankDistance d;
  host::require(distance_from_flank(setup_.gear, flank, {point.y(), point.z()}, point.x(), d),
                "flank");
  return d;
}

GearInspector::Deviation GearInspector::deviation(const Flank& flank, const Vec3& point) const {
  Deviation d;
  host::require(deviation_from_flank(setup_.gear, flank, point, d.mm, d.roll_length), "flank");
  return d;
}

// Workpiece frame.
Vec3 GearInspector::mean_point(const FlankTouch& wanted) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < rules_.touches; ++k)
    sum += touch(wanted, {}).workpiece;
  return sum / static_cast<double>(rules_.touches);
}

host::FlankTrace GearInspector::profile(FlankSide side) {
  host::FlankTrace trace;
  for (const FlankTouch& wanted : profile_touches(setup_.gear, side)) {
    const Deviation d = deviation(wanted.flank, mean_point(wanted));
    trace.at.push_back(d.roll_length);
    trace.deviation.push_back(kUmPerMm * d.mm);
  }
  if (rules_.filter)
    host::filter_as_2013(trace, host::profile_range(setup_.gear, host::kRollUsed1995), "profile");
  host::grade_profile(setup_.gear, "profile", trace);
  return trace;
}

host::FlankTrace GearInspector::lead(FlankSide side) {
  host::FlankTrace trace;
  for (const FlankTouch& wanted : lead_touches(setup_.gear, side)) {
    const Vec3 point = mean_point(wanted);
    trace.at.push_back(point.x());
    trace.deviation.push_back(kUmPerMm * deviation(wanted.flank, point).mm);
  }
  if (rules_.filter) host::filter_as_2013(trace, host::lead_range(setup_.gear), "lead");
  host::grade_lead(setup_.gear, "lead", trace);
  return trace;
}

host::PitchRound GearInspector::pitch(FlankSide side) {
  host::PitchRound round;
  for (const FlankTouch& wanted : pitch_touches(setup_.gear, side)) {
    const Vec3 point = mean_point(wanted);
    retract();
    const double along_base = distance(wanted.flank, point).distance;
    round.position.push_back(kUmPerMm * along_base * setup_.gear.r / setup_.gear.r_b);
  }
  host::grade_pitch(setup_.gear, "pitch", round);
  return round;
}

GearInspection GearInspector::inspect() {
  GearInspection result;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    result.profile[side] = profile(kSides[side]);
    retract();
    result.lead[side] = lead(kSides[side]);
    retract();
    result.pitch[side] = pitch(kSides[side]);
  }
  return result;
}

}  // namespace volcomp::l300g
