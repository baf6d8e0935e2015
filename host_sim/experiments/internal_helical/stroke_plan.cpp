#include "host_sim/experiments/internal_helical/stroke_plan.hpp"

#include <cmath>

#include "host_sim/sim/drives/cia402_axis.hpp"

namespace volcomp::internal_helical {
namespace {

// The lag of C stays well within the following error that a drive tolerates.
constexpr double kIndexFeed_rad_per_s = 0.6;
constexpr double kIndexAcceleration_rad_per_s2 = 6.0;

int ticks_of(const sim::Trapezoid& move) {
  return static_cast<int>(move.duration_s() / kStrokeTick_s);
}

}  // namespace

StrokePlan::StrokePlan(const host::GrindingFile& job, double x_mm)
    : job_(job),
      x_(to_nm(x_mm)),
      stroke_(travel_mm(), job.feed_mm_per_s, job.acceleration_mm_per_s2),
      index_(slot_rad(), kIndexFeed_rad_per_s, kIndexAcceleration_rad_per_s2) {
  standing_ = at(begin_mm(), 0.0);
}

int StrokePlan::index_ticks() const { return ticks_of(index_) + 1; }
int StrokePlan::stroke_ticks() const { return ticks_of(stroke_) + 2; }

// The helix turns C back while Z rises.
StrokeStep StrokePlan::at(double z_mm, double turned) const {
  StrokeStep step;
  step.x = x_;
  step.z = to_nm(z_mm);
  const double c = turned - static_cast<double>(step.z) / kNmPerMm * job_.gear.turn_per_mm;
  step.c = to_units(c, sim::kDriveUnitsPerTurn / (2.0 * kPi));
  step.slot = static_cast<std::uint16_t>(pass_ % job_.gear.teeth);
  step.stroke = way();
  step.feed_nm_per_s = static_cast<std::int32_t>(to_nm(job_.feed_mm_per_s));
  return step;
}

void StrokePlan::begin_pass() {
  if (begun_) ++pass_;
  begun_ = true;
}

// The gear turns against its angles. The first slot is there already.
StrokeStep StrokePlan::index(int tick) const {
  const double left = pass_ == 0 ? 0.0 : slot_rad() - index_.at(tick * kStrokeTick_s);
  StrokeStep step = at(begin_mm(), left - slot_rad() * static_cast<double>(pass_));
  step.stroke_end = true;
  return step;
}

StrokeStep StrokePlan::stroke(int tick) const {
  const double gone = stroke_.at(tick * kStrokeTick_s);
  const double z = begin_mm() + (way() == Direction::forward ? gone : -gone);
  StrokeStep step = at(z, -slot_rad() * static_cast<double>(pass_));
  step.in_face = std::abs(z) <= 0.5 * job_.width_mm;
  return step;
}

void StrokePlan::end_pass() { standing_ = stroke(stroke_ticks() - 1); }

}  // namespace volcomp::internal_helical
