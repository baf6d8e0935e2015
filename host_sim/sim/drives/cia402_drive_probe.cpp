// The touch probe input of a Cia402Drive: edges become latches of where the axis was.

#include <algorithm>

#include "host_sim/sim/drives/cia402_drive.hpp"
#include "host_sim/sim/drives/cia402_touch_probe.hpp"

namespace volcomp::sim {

void Cia402Drive::probe_edge(bool rising, std::int64_t time_ns) {
  if (!powered_) return;
  const std::int64_t grid_ns = settings_.latch_resolution_ns;
  const std::int64_t latch_ns = time_ns + settings_.latch_delay_ns;
  edges_.push_back({rising, (latch_ns + grid_ns / 2) / grid_ns * grid_ns});
  latch_edges();
}

// Those of the period that has been gone.
void Cia402Drive::latch_edges() {
  const auto period_ns = static_cast<std::int64_t>(1000U * period_us_);
  const auto later =
      std::stable_partition(edges_.begin(), edges_.end(),
                            [period_ns](const Edge& edge) { return edge.latch_ns < period_ns; });
  std::for_each(edges_.begin(), later, [this, period_ns](const Edge& edge) {
    const double part = static_cast<double>(edge.latch_ns) / static_cast<double>(period_ns);
    const std::int32_t position = on_wire(axis_.reading_at(part));
    const auto time_ns = static_cast<std::uint32_t>(edge.latch_ns);
    if (!latch(objects_.probe, edge.rising, position, time_ns)) return;
    device_.trigger_belated(host::kLatchPdo);
    device_.trigger_belated(host::kEdgePdo);
  });
  edges_.erase(edges_.begin(), later);
}

}  // namespace volcomp::sim
