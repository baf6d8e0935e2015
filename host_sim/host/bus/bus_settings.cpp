#include "host_sim/host/bus/bus_settings.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/host/machine/compensator_settings.hpp"

namespace volcomp::host {

BusSettings bus_settings(const MachineFile& machine, double cycle_hz) {
  BusSettings b;
  b.period_us = static_cast<std::uint32_t>(std::lround(1e6 / cycle_hz));
  b.machine_id = machine.id;
  b.node = machine.bus.node;
  b.controller = machine.bus.controller;
  CorrectionFile correction = machine.correction;
  correction.tick_hz = cycle_hz;
  b.probes = machine.probe.has_value();
  const AxisKinds kinds = axis_kinds(machine.chain);
  b.limits = compensator_settings(correction, kinds);
  for (std::size_t i = 0; i < kinds.count; ++i) {
    BusAxis a;
    a.letter = machine.axes[i].letter;
    const DriveFile& drive = machine.axes[i].drive;
    a.drive = drive.node;
    a.rotary = kinds.rotary[i];
    a.scale_numerator = drive.scale_numerator;
    a.reports_offset = drive.reports_offset;
    a.scale_denominator = drive.scale_denominator;
    if (drive.software_limits_mm) {
      const auto units = [&a](double mm) {
        return static_cast<std::int32_t>(
            std::clamp(std::round(mm * kNmPerMm * a.scale_denominator / a.scale_numerator),
                       -2147483648.0, 2147483647.0));
      };
      a.lowest = units((*drive.software_limits_mm)[0]);
      a.highest = units((*drive.software_limits_mm)[1]);
    }
    a.latch_delay_ns = std::llround(1000.0 * machine.axes[i].latch_delay_us);
    b.axes.push_back(a);
  }
  return b;
}

}  // namespace volcomp::host
