#pragma once
// A machine on a simulated bus that lives through something, as a log.

#include <string>

#include "host_sim/sim/controller/bus_axes.hpp"
#include "tests/host_sim/host/bus/service_bench.hpp"

namespace volcomp::host {

// The machine starts, moves, and lives through what `incident` does to it. `deadline_us`: of the
// node, 0: 60 % of the cycle. `status_every_cycle`: of the node. `cycle_hz`: of the bus.
template <class Incident>
std::string record_run(const Incident& incident, std::uint32_t deadline_us = 0,
                       bool status_every_cycle = false, double cycle_hz = 500.0) {
  std::string log;
  const KnownMachine& machine = known_machine();
  BusSettings settings = bus_settings(machine.file, cycle_hz);
  settings.deadline_us = deadline_us;
  settings.status_every_cycle = status_every_cycle;
  sim::BusAxes axes(settings, machine.image);
  record(axes.bus(), log);
  axes.stand_at({-250.0, -150.0, -200.0});
  axes.bring_up();
  const Targets start = axes.target();
  for (std::int32_t i = 0; i < 600; ++i) {
    if (i == 200) incident(axes);
    std::vector<std::int32_t> path;
    for (std::size_t a = 0; a < 3; ++a)
      path.push_back(static_cast<std::int32_t>(start[a]) + 100'000 * i);
    axes.run_cycle(path);
  }
  return log;
}

inline std::string record_quiet_run() {
  return record_run([](sim::BusAxes&) {});
}

inline std::string record_drive_failure() {
  return record_run([](sim::BusAxes& axes) { axes.power_drive(1, false); });
}

// Power failure of the node, for 50 cycles. When the drives are started, they report in the middle
// of a cycle. The simulated node has no timer, it sees its deadline with the next frame; the
// replayed one sees it to the microsecond: none of those reports may fall between.
inline std::string record_power_failure() {
  constexpr std::uint32_t kLateDeadline_us = 1800;
  return record_run(
      [](sim::BusAxes& axes) {
        axes.power_node(false);
        for (int i = 0; i < 50; ++i)
          axes.run_cycle({-250'000'000, -150'000'000, -200'000'000});
        axes.power_node(true);
      },
      kLateDeadline_us);
}

}  // namespace volcomp::host
