#include "host_sim/experiments/l300g/inspection.hpp"

#include <algorithm>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {
namespace {

// A touch that was meant for the end of the range belongs to it, though encoders count nanometres.
constexpr double kEnd_mm = 1e-5;

TraceDeviations evaluated(const FlankTrace& trace, const EvaluationRange& range) {
  TraceDeviations figures;
  host::require(evaluate_trace(trace.at, trace.deviation,
                               {range.low - kEnd_mm, range.high + kEnd_mm}, figures),
                "evaluation");
  return figures;
}

void judge_profile(const InvoluteGear& gear, FlankTrace& trace) {
  trace.range = profile_range(gear, 0.92);
  trace.figures = evaluated(trace, trace.range);
  trace.grade_1995 = grade_of(GearStandard::iso1328_1995, size_of(gear), GearDeviation::profile,
                              trace.figures.total);
  trace.grade_2013 = grade_of(GearStandard::iso1328_2013, size_of(gear), GearDeviation::profile,
                              evaluated(trace, profile_range(gear, 0.95)).total);
}

void judge_lead(const InvoluteGear& gear, FlankTrace& trace) {
  trace.range = lead_range(gear);
  trace.figures = evaluated(trace, trace.range);
  const auto grade = [&](GearStandard standard) {
    return grade_of(standard, size_of(gear), GearDeviation::lead, trace.figures.total);
  };
  trace.grade_1995 = grade(GearStandard::iso1328_1995);
  trace.grade_2013 = grade(GearStandard::iso1328_2013);
}

void judge_pitch(const InvoluteGear& gear, PitchRound& round) {
  host::require(evaluate_pitch(round.position, round.figures), "pitch");
  const auto grade = [&](GearDeviation deviation, double um) {
    return grade_of(GearStandard::iso1328_1995, size_of(gear), deviation, um);
  };
  const auto single = grade(GearDeviation::single_pitch, round.figures.single);
  const auto total = grade(GearDeviation::total_pitch, round.figures.total);
  if (single && total) round.grade_1995 = std::max(*single, *total);
}

}  // namespace

GearSize size_of(const InvoluteGear& gear) { return {2.0 * gear.r, gear.module, gear.width}; }

GearInspection true_gear(const InvoluteGear& gear) {
  GearInspection truth;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    FlankTrace& profile = truth.profile[side];
    for (const FlankTouch& touch : profile_touches(gear, kSides[side])) {
      profile.at.push_back(touch.roll_length);
      profile.deviation.push_back(kUmPerMm * own_deviation(touch.roll_length, 0.0));
    }
    judge_profile(gear, profile);
    FlankTrace& lead = truth.lead[side];
    for (const FlankTouch& touch : lead_touches(gear, kSides[side])) {
      lead.at.push_back(touch.x);
      lead.deviation.push_back(kUmPerMm * own_deviation(touch.roll_length, touch.x));
    }
    judge_lead(gear, lead);
    truth.pitch[side].position.assign(static_cast<std::size_t>(gear.teeth), 0.0);
    judge_pitch(gear, truth.pitch[side]);
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

FlankTrace GearInspector::profile(FlankSide side) {
  FlankTrace trace;
  for (const FlankTouch& wanted : profile_touches(setup_.gear, side)) {
    const Deviation d = deviation(wanted.flank, touch(wanted, {}).workpiece);
    trace.at.push_back(d.roll_length);
    trace.deviation.push_back(kUmPerMm * d.mm);
  }
  judge_profile(setup_.gear, trace);
  return trace;
}

FlankTrace GearInspector::lead(FlankSide side) {
  FlankTrace trace;
  for (const FlankTouch& wanted : lead_touches(setup_.gear, side)) {
    const sim::NodePoint point = touch(wanted, {});
    trace.at.push_back(point.workpiece.x());
    trace.deviation.push_back(kUmPerMm * deviation(wanted.flank, point.workpiece).mm);
  }
  judge_lead(setup_.gear, trace);
  return trace;
}

PitchRound GearInspector::pitch(FlankSide side) {
  PitchRound round;
  for (const FlankTouch& wanted : pitch_touches(setup_.gear, side)) {
    const sim::NodePoint point = touch(wanted, {});
    retract();
    const double along_base = distance(wanted.flank, point.workpiece).distance;
    round.position.push_back(kUmPerMm * along_base * setup_.gear.r / setup_.gear.r_b);
  }
  judge_pitch(setup_.gear, round);
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
