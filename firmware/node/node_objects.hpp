#pragma once
// The values behind the object dictionary of the compensation node, with their defaults, and the
// table that describes them (firmware/volcomp.eds says the same to configuration tools).
//
//   2000h machine and identity      2010h…201Fh process data of the axes, drive position units
//   2020h offsets to the drives     2030h scaling between drive and run-time units
//   2100h tables                    2200h limits and ramps
//   2300h probe and feature         2400h points
//   2500h strokes of a grinder
//   2600h diagnostics               2700h temperatures, expansion, date
//
// Run-time units: nm, or 2^-32 turn for offsets and limits of a rotary axis.

#include <array>
#include <cstdint>
#include <type_traits>

#include "firmware/canopen/communication_objects.hpp"
#include "firmware/canopen/pdo.hpp"
#include "firmware/node/node_features.hpp"
#include "firmware/node/probe/probe_objects.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"
#include "firmware/node/tables/node_compensator.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"

namespace volcomp::node {

inline constexpr std::uint32_t kProductCode = 0x564F4C43;  // 1018h:02: "VOLC"

template <class T>
using PerAxis = std::array<T, kNodeAxes>;

// 2111h: what to do with the staged image.
enum class TableCommand : std::uint8_t {
  none = 0,
  validate = 1,    // check it: 2112h:02 says ok or why not
  arm = 2,         // fold it into the spare half of the double buffer
  activate = 3,    // ramp it in
  deactivate = 4,  // ramp to zero and stay there
  discard = 5,     // forget the staged image
};

inline constexpr canopen::ObjectId kTableImage{0x2110, 1};
inline constexpr canopen::ObjectId kTableCommand{0x2111, 0};

// 2112h: what became of it.
constexpr canopen::ObjectId table_verdict(std::uint8_t sub) { return {0x2112, sub}; }
inline constexpr std::size_t kMostReasonText = 160;  // bytes of 2112h:06

// 2112h:01.
enum class TableState : std::uint8_t {
  empty = 0,
  receiving = 1,  // a download is under way or was broken off
  received = 2,   // complete, unchecked
  valid = 3,
  armed = 4,
  active = 5,   // the staged image is the one behind the active tables
  refused = 6,  // 2112h:02 says why
};

// 2600h:01.
enum class NodeState : std::uint8_t {
  idle = 0,          // not OPERATIONAL
  no_tables = 1,     // nothing to compensate with
  waiting = 2,       // for a drive to report the offset it holds
  compensating = 3,  // every axis
  degraded = 4,      // at least one axis is held, ramped down or not answered: 2601h
  overdue = 5,       // the background hangs: every axis is ramped down before the watchdog bites
};

struct NodeObjects {
  canopen::CommunicationObjects communication{};
  std::uint32_t store = 0x1;    // 1010h:01; reads: saves on command; 0: there is no store
  std::uint32_t restore = 0x1;  // 1011h:01; reads: restores on command; 0: there is no store

  std::uint32_t machine_id = 0;        // 2000h:01; 0: any machine's tables
  std::uint8_t controller = 127;       // 2000h:02 node id of the motion controller
  std::uint8_t position_source = 0;    // 2000h:03 0 target (607Ah), 1 actual (6064h)
  std::uint8_t axes = 0;               // 2000h:04 of the active machine
  std::array<char, 8> axis_letters{};  // 2000h:05

  PerAxis<std::uint8_t> drive{};          // 2010h node id, 0: axis not there
  PerAxis<std::int32_t> target{};         // 2011h as 607Ah
  PerAxis<std::uint16_t> control{};       // 2012h as 6040h
  PerAxis<std::int32_t> actual{};         // 2013h as 6064h
  PerAxis<std::uint16_t> drive_status{};  // 2014h as 6041h
  PerAxis<std::uint16_t> probe_status{};  // 2015h as 60B9h
  PerAxis<std::int32_t> held_offset{};    // 2016h as 60B0h, reported by the drive
  PerAxis<std::int32_t> latched{};        // 2017h as 60BAh
  PerAxis<std::uint32_t> latch_time{};    // 2018h as 60D1h, ns since SYNC
  PerAxis<std::uint16_t> edge_count{};    // 2019h as 60D5h
  PerAxis<std::int32_t> offset{};         // 2020h to 60B0h

  PerAxis<std::uint32_t> scale_numerator{1, 1, 1, 1, 1};                 // 2030h run-time units per
  PerAxis<std::uint32_t> scale_denominator{1, 1, 1, 1, 1};               // 2031h drive unit
  PerAxis<std::uint8_t> rotary{};                                        // 2032h
  PerAxis<std::uint16_t> homed_mask{0x100, 0x100, 0x100, 0x100, 0x100};  // 2033h bits of 6041h

  std::uint8_t table_command = 0;                   // 2111h
  std::uint8_t table_state = 0;                     // 2112h:01
  std::uint8_t reason = 0;                          // 2112h:02 Reason of the last refusal
  std::uint8_t where_axis = 0;                      // 2112h:03 letter, 0: does not apply
  std::int16_t where_index = -1;                    // 2112h:04 knot or entry, from 0
  std::int8_t where_channel = -1;                   // 2112h:05 0…5 = EX EY EZ EA EB EC
  std::array<char, kMostReasonText> reason_text{};  // 2112h:06
  std::uint32_t staged_crc = 0;                     // 2110h:02
  std::uint32_t staged_bytes = 0;                   // 2110h:03
  std::uint32_t image_capacity = 0;                 // 2110h:04
  std::uint32_t active_crc = 0;                     // 2112h:07
  std::uint32_t active_sequence = 0;                // 2112h:08

  std::uint32_t ramp_cycles = 100;  // 2200h:01
  std::uint16_t drop_cycles = 10;   // 2200h:02 stale for longer: ramped to zero
  std::uint32_t deadline_us = 0;    // 2200h:03 0: 60 % of 1006h
  std::uint8_t late_cycles = 2;     // 2200h:04 a frame may be late by so many cycles
  std::uint8_t drives_report = 1;   // 2200h:05 drives report 60B0h in a TPDO
  PerAxis<std::int32_t> limit{200'000, 200'000, 200'000, 200'000, 200'000};  // 2201h
  PerAxis<std::int32_t> slew{20'000, 20'000, 20'000, 20'000, 20'000};        // 2202h
  PerAxis<std::int32_t> soft_rate{1'000, 1'000, 1'000, 1'000, 1'000};        // 2203h
  PerAxis<std::int32_t> hysteresis{2'000, 2'000, 2'000, 2'000, 2'000};       // 2204h
  PerAxis<std::int64_t> max_step{};                                          // 2205h 0: unchecked
  PerAxis<std::int32_t> start_offset{};  // 2206h offset a drive holds that cannot report it

  ProbeObjects probe{};                                                          // 2300h…2411h
  std::conditional_t<kWatchesStrokes, StrokeObjects, NoStrokeObjects> stroke{};  // 201Ah, 2500h

  std::uint8_t state = 0;             // 2600h:01 NodeState
  std::uint8_t sync_counter = 0;      // 2600h:02 of the cycle last computed
  std::uint16_t any_status = 0;       // 2600h:03 status bits of all axes together
  std::uint32_t cycles = 0;           // 2600h:04 computed
  std::uint32_t deadline_missed = 0;  // 2600h:05 cycles that were incomplete at the deadline
  std::uint32_t cycles_skipped = 0;   // 2600h:06 SYNC came before the cycle was computed
  std::uint32_t sync_missed = 0;      // 2600h:07
  std::uint32_t sync_foreign = 0;     // 2600h:08
  std::uint32_t activations = 0;      // 2600h:09
  std::uint32_t rejections = 0;       // 2600h:0A
  std::uint8_t stored = 0;            // 2600h:0B StoreResult of the start
  std::uint8_t store_result = 0;      // 2600h:0C StoreResult of the last save or restore, 0: none
  std::uint8_t reset_cause = 0;       // 2600h:0D hal::ResetCause
  std::uint32_t frames_lost = 0;      // 2600h:0E before the node saw them
  PerAxis<std::uint16_t> status{};    // 2601h
  PerAxis<std::int32_t> largest{};    // 2602h
  PerAxis<std::array<std::uint16_t, kStatusBits>> began{};  // 2610h… how often each bit began

  std::conditional_t<kFollowsTemperature, ThermalObjects, NoThermalObjects>
      thermal{};  // 1012h, 2700h
};

[[nodiscard]] canopen::Dictionary node_dictionary();
// The same for tools; images of devices leave it out.
[[nodiscard]] Span<const canopen::NamedEntry> named_node_dictionary();

// Numbers of the PDOs, from 0.
// From the drives: targets, actual values, held offsets, latches, edge counters. From the
// controller: what it grinds, how warm the axes are.
inline constexpr std::size_t kProcessStatePdo = 5 * kNodeAxes;
inline constexpr std::size_t kTemperaturePdo = kProcessStatePdo + 1;  // in every node that has it
inline constexpr std::size_t kReceivePdos =
    kFollowsTemperature ? kTemperaturePdo + 1 : kProcessStatePdo + (kWatchesStrokes ? 1 : 0);
// Those that a cycle is computed from: all but the temperatures.
inline constexpr std::size_t kCycleReceivePdos = kProcessStatePdo + (kWatchesStrokes ? 1 : 0);
// Offsets, node status, the latest point: number and verdict, X and Y, Z and uncertainty.
inline constexpr std::size_t kStatusPdo = kNodeAxes;
inline constexpr std::size_t kFirstPointPdo = kNodeAxes + 1;
inline constexpr std::size_t kPointPdos = 3;
inline constexpr std::size_t kTransmitPdos = kFirstPointPdo + kPointPdos;

// RPDOs with the offsets that the drives hold, one per axis.
inline constexpr std::size_t kFirstHeldPdo = 2 * kNodeAxes;

// Default parameters of the PDOs for the drives of 2010h; those of absent drives are invalid, and
// those of held offsets where drives do not report (2200h:05).
[[nodiscard]] canopen::PdoParameters default_receive_pdo(std::size_t number,
                                                         const NodeObjects& objects);
[[nodiscard]] canopen::PdoParameters default_transmit_pdo(std::size_t number,
                                                          const PerAxis<std::uint8_t>& drives,
                                                          std::uint8_t node_id);

}  // namespace volcomp::node
