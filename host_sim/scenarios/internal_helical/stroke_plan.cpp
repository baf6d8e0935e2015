#include "host_sim/scenarios/internal_helical/stroke_plan.hpp"

#include <cmath>

#include "host_sim/drives/cia402_axis.hpp"

namespace volcomp::sim {
namespace {

constexpr double kTravel_mm = kFaceWidth_mm + 2.0 * kOverrun_mm;

// The lag of C stays well within the following error that a drive tolerates.
constexpr double kIndexFeed_rad_per_s = 0.6;
constexpr double kIndexAcceleration_rad_per_s2 = 6.0;

int ticks_of(const Trapezoid& move) { return static_cast<int>(move.duration_s() / kStrokeTick_s); }

double begin_of(Direction stroke) {
  return stroke == Direction::forward ? -0.5 * kTravel_mm : 0.5 * kTravel_mm;
}

}  // namespace

StrokePlan::StrokePlan(const InternalGear& gear, double x_mm)
    : gear_(gear),
      x_(to_nm(x_mm)),
      stroke_(kTravel_mm, kStrokeFeed_mm_per_s, kStrokeAcceleration_mm_per_s2),
      index_(2.0 * kPi / gear.teeth, kIndexFeed_rad_per_s, kIndexAcceleration_rad_per_s2) {
  standing_ = at(begin_of(Direction::forward), 0.0);
}

int StrokePlan::index_ticks() const { return ticks_of(index_) + 1; }
int StrokePlan::stroke_ticks() const { return ticks_of(stroke_) + 2; }

// The helix turns C back while Z rises.
StrokeStep StrokePlan::at(double z_mm, double turned) const {
  StrokeStep step;
  step.x = x_;
  step.z = to_nm(z_mm);
  const double c = turned - static_cast<double>(step.z) / kNmPerMm * gear_.turn_per_mm;
  step.c = to_units(c, kDriveUnitsPerTurn / (2.0 * kPi));
  step.slot = static_cast<std::uint16_t>(pass_ % gear_.teeth);
  step.stroke = way();
  step.feed_nm_per_s = static_cast<std::int32_t>(to_nm(kStrokeFeed_mm_per_s));
  return step;
}

void StrokePlan::begin_pass() {
  if (begun_) ++pass_;
  begun_ = true;
}

// The gear turns against its angles. The first slot is there already.
StrokeStep StrokePlan::index(int tick) const {
  const double slots = -2.0 * kPi / gear_.teeth * static_cast<double>(pass_);
  const double left = pass_ == 0 ? 0.0 : 2.0 * kPi / gear_.teeth - index_.at(tick * kStrokeTick_s);
  StrokeStep step = at(begin_of(way()), slots + left);
  step.stroke_end = true;
  return step;
}

StrokeStep StrokePlan::stroke(int tick) const {
  const double gone = stroke_.at(tick * kStrokeTick_s);
  const double z = begin_of(way()) + (way() == Direction::forward ? gone : -gone);
  StrokeStep step = at(z, -2.0 * kPi / gear_.teeth * static_cast<double>(pass_));
  step.in_face = std::abs(z) <= 0.5 * kFaceWidth_mm;
  return step;
}

void StrokePlan::end_pass() { standing_ = stroke(stroke_ticks() - 1); }

}  // namespace volcomp::sim
