#include "host_sim/host/bus/bus_settings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/bus/drive_model.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/compensator_settings.hpp"

namespace volcomp::host {
namespace {

void take_drive(const MachineFile& machine, const DriveFile& drive, BusAxis& axis) {
  axis.way = drive.way;
  if (!drive.model.empty()) {
    try {
      const auto folder = std::filesystem::path(machine.path).parent_path();
      put_model(axis, find_drive_model(drive.model, folder));
    } catch (const UserError& why) {
      throw UserError(fmt::format("{}: {}", machine.path, why.what()));
    }
  }
  if (drive.reports_offset) axis.reports_offset = *drive.reports_offset;
}

}  // namespace

node::WireScale wire_scale(const BusAxis& axis) {
  return {axis.scale_numerator, axis.scale_denominator, axis.rotary, axis.units_per_turn};
}

double unit_size(const BusAxis& axis) { return node::units_per_wire(wire_scale(axis)); }

std::uint8_t sync_counter_overflow(const BusSettings& settings) {
  constexpr std::uint8_t kUsual = 240;
  const bool all = std::all_of(settings.axes.begin(), settings.axes.end(), [](const BusAxis& axis) {
    return axis.model == nullptr || axis.model->counts_sync();
  });
  return all ? kUsual : 0;
}

bool forwards_targets(const BusSettings& settings) {
  return std::any_of(settings.axes.begin(), settings.axes.end(),
                     [](const BusAxis& axis) { return axis.way == Way::forwarded_target; });
}

bool counts_on_node(const BusSettings& settings) {
  return forwards_targets(settings) ||
         std::any_of(settings.axes.begin(), settings.axes.end(),
                     [](const BusAxis& axis) { return axis.way == Way::controller_adds; });
}

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
    a.scale_denominator = drive.scale_denominator;
    a.units_per_turn = drive.units_per_turn;
    if (drive.software_limits_mm) {
      const auto units = [&a](double mm) {
        return static_cast<std::int32_t>(
            std::clamp(std::round(mm * kNmPerMm * a.scale_denominator / a.scale_numerator),
                       -2147483648.0, 2147483647.0));
      };
      a.lowest = units((*drive.software_limits_mm)[0]);
      a.highest = units((*drive.software_limits_mm)[1]);
    }
    take_drive(machine, drive, a);
    a.latch_delay_ns = std::llround(1000.0 * machine.axes[i].latch_delay_us);
    b.axes.push_back(a);
  }
  require_latches(b);
  return b;
}

MachineFile with_drives_settled(MachineFile machine) {
  const BusSettings bus = bus_settings(machine, machine.correction.tick_hz);
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    DriveFile& drive = machine.axes[i].drive;
    if (!drive.model.empty()) drive.reports_offset = bus.axes[i].reports_offset;
  }
  return machine;
}

}  // namespace volcomp::host
