#include "host_sim/experiments/l300g/inspection.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {
namespace {

// Point by point: all were touched at the same nominal places.
host::FlankTrace mean_of(const std::vector<host::FlankTrace>& teeth) {
  const auto share = 1.0 / static_cast<double>(teeth.size());
  host::FlankTrace mean;
  mean.at.assign(teeth.front().at.size(), 0.0);
  mean.deviation = mean.at;
  for (const host::FlankTrace& tooth : teeth) {
    for (std::size_t i = 0; i < mean.at.size(); ++i) {
      mean.at[i] += share * tooth.at[i];
      mean.deviation[i] += share * tooth.deviation[i];
    }
  }
  return mean;
}

// The worst of them, and what all give together. `evaluate(trace)`.
template <class Evaluate>
host::FlankTrace judge(std::vector<host::FlankTrace> teeth, SeveralTeeth& together,
                       const Evaluate& evaluate) {
  host::FlankTrace mean = mean_of(teeth);
  evaluate(mean);
  together = {0.0, mean.figures.total};
  for (host::FlankTrace& tooth : teeth) {
    evaluate(tooth);
    together.mean += tooth.figures.total / static_cast<double>(teeth.size());
  }
  return *std::max_element(teeth.begin(), teeth.end(), [](const auto& a, const auto& b) {
    return a.figures.total < b.figures.total;
  });
}

}  // namespace

GearInspection true_gear(const InvoluteGear& gear) {
  GearInspection truth;
  const OwnDeviation own(gear);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    host::FlankTrace& profile = truth.profile[side];
    for (const FlankTouch& touch : profile_touches(gear, {kSides[side], 0})) {
      profile.at.push_back(touch.roll_length);
      profile.deviation.push_back(kUmPerMm * own(touch.roll_length, 0.0));
    }
    host::grade_profile(gear, "true profile", profile);
    host::FlankTrace& lead = truth.lead[side];
    for (const FlankTouch& touch : lead_touches(gear, {kSides[side], 0})) {
      lead.at.push_back(touch.x);
      lead.deviation.push_back(kUmPerMm * own(touch.roll_length, touch.x));
    }
    host::grade_lead(gear, "true lead", lead);
    truth.profile_teeth[side] = {profile.figures.total, profile.figures.total};
    truth.lead_teeth[side] = {lead.figures.total, lead.figures.total};
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

host::FlankTrace GearInspector::profile(const Flank& flank) {
  host::FlankTrace trace;
  for (const FlankTouch& wanted : profile_touches(setup_.gear, flank, setup_.traces.points)) {
    const Deviation d = deviation(wanted.flank, mean_point(wanted));
    trace.at.push_back(d.roll_length);
    trace.deviation.push_back(kUmPerMm * d.mm);
  }
  retract();
  return trace;
}

void GearInspector::evaluate_profile(host::FlankTrace& trace) const {
  if (rules_.filter)
    host::filter_as_2013(trace, host::profile_range(setup_.gear, host::kRollUsed1995), "profile");
  host::grade_profile(setup_.gear, "profile", trace);
}

host::FlankTrace GearInspector::lead(const Flank& flank) {
  host::FlankTrace trace;
  for (const FlankTouch& wanted : lead_touches(setup_.gear, flank, setup_.traces.points)) {
    const Vec3 point = mean_point(wanted);
    trace.at.push_back(point.x());
    trace.deviation.push_back(kUmPerMm * deviation(wanted.flank, point).mm);
  }
  retract();
  return trace;
}

void GearInspector::evaluate_lead(host::FlankTrace& trace) const {
  if (rules_.filter) host::filter_as_2013(trace, host::lead_range(setup_.gear), "lead");
  host::grade_lead(setup_.gear, "lead", trace);
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
    std::vector<host::FlankTrace> profiles;
    std::vector<host::FlankTrace> leads;
    for (const int tooth : traced_teeth(setup_.gear, setup_.traces)) {
      profiles.push_back(profile({kSides[side], tooth}));
      leads.push_back(lead({kSides[side], tooth}));
    }
    result.profile[side] = judge(std::move(profiles), result.profile_teeth[side],
                                 [this](host::FlankTrace& t) { evaluate_profile(t); });
    result.lead[side] = judge(std::move(leads), result.lead_teeth[side],
                              [this](host::FlankTrace& t) { evaluate_lead(t); });
    result.pitch[side] = pitch(kSides[side]);
  }
  return result;
}

}  // namespace volcomp::l300g
