#include "host_sim/experiments/internal_helical/grinder_control.hpp"

#include <cmath>

#include "comp/strokes/spectral_line.hpp"

namespace volcomp::internal_helical {
namespace {

// Half of the error is learned per step (w = 0.5). The limits reject a bad pass and are several
// times what the simulated machine needs.
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

host::WatchedStrokes watched_strokes(const host::GrindingFile& job, double flank_per_x,
                                     LearningWay way) {
  const InternalGear& gear = job.gear;
  const double pitch_mm = way == LearningWay::coarse ? 1.0 : kNodeSpacing_mm;
  host::WatchedStrokes w;
  w.slots = static_cast<std::uint16_t>(gear.teeth);
  w.monitor.turn_per_mm = gear.turn_per_mm;
  w.monitor.flank_per_rad = gear.normal_lever();
  w.monitor.flank_per_x = flank_per_x;
  w.monitor.tick_ns = static_cast<std::int32_t>(kStrokeTick_s * 1e9);
  w.monitor.z0_nm = to_nm(-0.5 * job.width_mm);
  w.monitor.node_pitch_nm = static_cast<std::uint32_t>(to_nm(pitch_mm));
  w.monitor.nodes = static_cast<std::size_t>(std::lround(job.width_mm / pitch_mm)) + 1;
  w.monitor.order_wavelength_mm = kWavelengths_mm;
  w.offsets.rate = 20'000;     // 29 µrad per tick: the tables of two directions meet within 0.1 s
  w.offsets.stale_ticks = 10;  // 20 ms
  w.along = stroke_rules(pitch_mm);
  w.around = slot_rules();
  if (way == LearningWay::c_alone) w.target = LearningTarget::c_alone;
  return w;
}

std::vector<double> orders_around(const std::vector<double>& slot_um) {
  std::vector<NodeSums> means;
  means.reserve(slot_um.size());
  for (const double um : slot_um)
    means.push_back({1, um, um * um});
  std::vector<double> amplitude;
  for (int order = 1; order <= static_cast<int>(slot_um.size()) / 2; ++order)
    amplitude.push_back(order_around(means, order).amplitude);
  return amplitude;
}

}  // namespace volcomp::internal_helical
