#include "host_sim/experiments/internal_helical/grinder_control.hpp"

#include <cmath>

#include "comp/strokes/spectral_line.hpp"

namespace volcomp::internal_helical {

host::WatchedStrokes watched_strokes(const host::GrindingFile& job, double flank_per_x,
                                     LearningWay way) {
  const double pitch_mm = way == LearningWay::coarse ? 1.0 : host::kNodeSpacing_mm;
  host::WatchedStrokes w = host::watched_strokes(job, pitch_mm, kStrokeTick_s);
  w.monitor.flank_per_x = flank_per_x;
  w.monitor.order_wavelength_mm = kWavelengths_mm;
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
