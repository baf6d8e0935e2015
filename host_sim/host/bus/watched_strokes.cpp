#include "host_sim/host/bus/watched_strokes.hpp"

#include <cmath>

namespace volcomp::host {
namespace {

LearningRules stroke_rules(double pitch_mm) {
  LearningRules rules;
  rules.weight = 0.5;
  rules.least_samples = 8;
  rules.most_step = 1e-3;
  rules.most_offset = 2e-3;
  rules.most_slope = 1e-3;
  rules.spacing = pitch_mm;
  return rules;
}

// Slots are not smoothed: their errors are independent, and C has come to rest before the face, so
// there is no lag to keep out of the loop.
LearningRules slot_rules() {
  LearningRules rules = stroke_rules(1.0);
  rules.periodic = true;
  rules.least_samples = 2;  // passes: one each way
  rules.most_slope = 1e-4;
  rules.taps = {1.0};
  rules.tap_count = 1;
  return rules;
}

}  // namespace

WatchedStrokes watched_strokes(const GrindingFile& job, double pitch_mm, double period_s) {
  const InternalGear& gear = job.gear;
  WatchedStrokes w;
  w.slots = static_cast<std::uint16_t>(gear.teeth);
  w.monitor.turn_per_mm = gear.turn_per_mm;
  w.monitor.flank_per_rad = gear.normal_lever();
  w.monitor.tick_ns = static_cast<std::int32_t>(std::lround(period_s * 1e9));
  w.monitor.z0_nm = to_nm(-0.5 * job.width_mm);
  w.monitor.node_pitch_nm = static_cast<std::uint32_t>(to_nm(pitch_mm));
  w.monitor.nodes = static_cast<std::size_t>(std::lround(job.width_mm / pitch_mm)) + 1;
  w.offsets.rate = 20'000;     // 29 µrad per tick: the tables of two directions meet within 0.1 s
  w.offsets.stale_ticks = 10;  // 20 ms
  w.along = stroke_rules(pitch_mm);
  w.around = slot_rules();
  return w;
}

}  // namespace volcomp::host
