#pragma once
// The CAN bus of a machine: node ids, units of the drives, cycle rate.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "comp/tick/instances.hpp"
#include "firmware/node/wire_scale.hpp"
#include "host_sim/host/bus/watched_strokes.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Run-time units (nm or 2^-40 turn) per unit of a drive.
struct DriveScale {
  std::uint32_t numerator = 1;
  std::uint32_t denominator = 1;
};

class DriveModel;

struct BusAxis {
  char letter = '\0';
  std::uint8_t drive = 0;  // node id
  bool rotary = false;
  std::uint32_t scale_numerator = 1;  // run-time units (nm or 2^-40 turn) per drive unit
  std::uint32_t scale_denominator = 1;
  std::uint32_t units_per_turn = 0;       // rotary: 2036h, instead of the fraction; 0: none
  std::uint16_t referenced_mask = 0x100;  // 2033h; a simulated drive sets bit 8 of 6041h
  std::int32_t lowest = 0;                // software limits 607Dh, drive units; equal: none
  std::int32_t highest = 0;
  Way way = Way::offset;
  // Nothing: every object and the PDOs of host_sim/host/bus/cia402.def.
  std::shared_ptr<const DriveModel> model;
  // 60B0h by TPDO. Otherwise a client writes the held offset to 2206h when the node starts.
  bool reports_offset = true;
  std::int64_t latch_delay_ns = 0;  // of the touch probe input
  // The units of the drive where they differ from those of the controller.
  std::optional<DriveScale> counts_otherwise;
};

// Run-time units (nm or 2^-40 turn) in a position unit of the drive.
[[nodiscard]] double unit_size(const BusAxis& axis);
// As the node counts.
[[nodiscard]] node::WireScale wire_scale(const BusAxis& axis);

struct BusSettings {
  std::uint8_t controller = 127;
  std::uint8_t node = 32;
  std::uint32_t period_us = 2000;
  std::uint32_t deadline_us = 0;    // of the node; 0: 60 % of the period
  bool status_every_cycle = false;  // of the node: for lock step over a bus without real time
  std::uint16_t heartbeat_ms = 100;
  std::uint16_t heartbeat_timeout_ms = 350;
  std::uint32_t machine_id = 0;
  std::vector<BusAxis> axes;
  // A controller that was given no tables waits until the node compensates with those it has
  // itself, stored or from a service tool; a node without any is accepted, too.
  bool node_brings_tables = false;
  bool probes = false;  // the drives latch the rising edges of a touch probe and report them
  CompensatorSettings<LoadedCompensator::kAxes> limits{};  // per cycle of this period
  std::optional<WatchedStrokes> strokes;  // the axes X, Z and C grind a helical gear
};

// 1019h of all devices: 240, or 0 where a drive of the machine cannot count.
[[nodiscard]] std::uint8_t sync_counter_overflow(const BusSettings& settings);

// An axis takes its targets from the node.
[[nodiscard]] bool forwards_targets(const BusSettings& settings);
// The controller needs the state of the node in every cycle: what it forwards, or what it is to
// add.
[[nodiscard]] bool counts_on_node(const BusSettings& settings);

// Node ids, units, software limits and drives from the machine file. Throws UserError where its
// `drive` cannot be read, or cannot do what is asked of it.
[[nodiscard]] BusSettings bus_settings(const MachineFile& machine, double cycle_hz);
// The same file, with `reports_offset` of every axis whose `drive` is given. Throws the same.
[[nodiscard]] MachineFile with_drives_settled(MachineFile machine);

}  // namespace volcomp::host
