// A touch probe on axes on a bus: from the way of the axes to edges at the drives, and back from
// what the drives report.

#include <algorithm>
#include <cmath>
#include <utility>

#include "comp/core/units.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::sim {

void BusAxes::mount(TouchProbe probe) {
  probe_.emplace(std::move(probe));
  felt_ = {position(), approach()};
}

// The positions of all axes at a SYNC are settled before the first drive answers, because a touch
// on the way there belongs to the answers. The first drive to be served therefore serves the
// others, too.
void BusAxes::serve_drives(std::uint64_t now_us) {
  const auto has_mail = [](const SimulatedBus::Port* port) { return port->waiting() != 0; };
  const std::uint64_t now_ns = bus_.bus().now_ns();
  if (served_ns_ == now_ns && std::none_of(drive_port_.begin(), drive_port_.end(), has_mail))
    return;
  served_ns_ = now_ns;
  for (std::size_t a = 0; a < drive_.size(); ++a)
    drive_rest_[a].receive(*drive_[a], *drive_port_[a], now_us);
  feel();
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    if (drive_port_[a]->connected()) serve_drive(a, now_us);
  }
}

void BusAxes::feel() {
  std::uint64_t periods = 0;
  for (const auto& drive : drive_)
    periods += drive->periods();
  if (periods == felt_periods_) return;
  felt_periods_ = periods;
  const Stance here{position(), approach()};
  const std::int64_t period_ns = std::llround(period_us_ * 1000.0);
  for (const ProbeEdge& edge : probe_->travel(felt_, here, period_ns)) {
    for (std::size_t a = 0; a < drive_.size(); ++a) {
      if (line_broken_[a]) continue;
      drive_[a]->probe_edge(edge.rising, edge.time_ns);
      drive_rest_[a].disturb();
    }
  }
  felt_ = here;
}

// The wire counts two turns of a rotary axis; of the possible ones, the one next to the target.
Latches BusAxes::latches() const {
  Latches latches{};
  for (std::size_t a = 0; a < drive_.size(); ++a) {
    const host::BusAxis& axis = controller_.settings().axes[a];
    const ProbeReport& report = controller_.probe(a);
    const std::int64_t near = drive_units(a, target_[a]);
    const std::int64_t units =
        axis.rotary ? near + wrapped(report.position - near) : std::int64_t{report.position};
    const double run_time_units = static_cast<double>(units) * host::unit_size(axis);
    latches[a] = {report.latches, run_time_units / (axis.rotary ? kUnitsPerRad : kNmPerMm),
                  report.time_ns};
  }
  return latches;
}

}  // namespace volcomp::sim
