#include "firmware/node/node_objects.hpp"

#include <cstddef>

#include "firmware/canopen/pdo.hpp"
#include "firmware/node/arrivals.hpp"
#include "firmware/node/strokes/stroke_rows.hpp"
#include "firmware/node/thermal/thermal_rows.hpp"

namespace volcomp::node {
namespace {

using canopen::Access;
using canopen::DataType;
using canopen::kPlain;
using canopen::kReceive;
using canopen::kStored;
using canopen::kTransmit;
using canopen::NamedEntry;
using detail::joined;

#define VOLCOMP_AT(member) static_cast<std::uint16_t>(offsetof(NodeObjects, member))

constexpr std::uint16_t at_began(std::size_t axis) {
  return static_cast<std::uint16_t>(VOLCOMP_AT(began) +
                                    axis * sizeof(std::array<std::uint16_t, kStatusBits>));
}

constexpr std::array<NamedEntry, 2> kStoreRows{{
    {0x1010, 1, 1, DataType::unsigned32, Access::read_write, kPlain, VOLCOMP_AT(store), 0,
     "Save all parameters"},
    {0x1011, 1, 1, DataType::unsigned32, Access::read_write, kPlain, VOLCOMP_AT(restore), 0,
     "Restore all default parameters"},
}};

// Up to the process data that come in.
constexpr std::array<NamedEntry, 15> kReceivedRows{{
    {0x2000, 1, 1, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(machine_id), 0,
     "Machine id"},
    {0x2000, 2, 2, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(controller), 0,
     "Node id of the motion controller", 1, 127},
    {0x2000, 3, 3, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(position_source), 0,
     "Position source: 0 target, 1 actual", 0, 1},
    {0x2000, 4, 4, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(axes), 0,
     "Axes of the active machine"},
    {0x2000, 5, 5, DataType::visible_string, Access::read_only, kPlain, VOLCOMP_AT(axis_letters), 8,
     "Axis letters"},
    {0x2010, 1, kNodeAxes, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(drive), 0,
     "Node id of the drive", 0, 127},
    {0x2011, 1, kNodeAxes, DataType::integer32, Access::read_write, kReceive, VOLCOMP_AT(target), 0,
     "Target position"},
    {0x2012, 1, kNodeAxes, DataType::unsigned16, Access::read_write, kReceive, VOLCOMP_AT(control),
     0, "Control word"},
    {0x2013, 1, kNodeAxes, DataType::integer32, Access::read_write, kReceive, VOLCOMP_AT(actual), 0,
     "Actual position"},
    {0x2014, 1, kNodeAxes, DataType::unsigned16, Access::read_write, kReceive,
     VOLCOMP_AT(drive_status), 0, "Status word of the drive"},
    {0x2015, 1, kNodeAxes, DataType::unsigned16, Access::read_write, kReceive,
     VOLCOMP_AT(probe_status), 0, "Touch probe status of the drive"},
    {0x2016, 1, kNodeAxes, DataType::integer32, Access::read_write, kReceive,
     VOLCOMP_AT(held_offset), 0, "Offset the drive holds"},
    {0x2017, 1, kNodeAxes, DataType::integer32, Access::read_write, kReceive, VOLCOMP_AT(latched),
     0, "Latched position"},
    {0x2018, 1, kNodeAxes, DataType::unsigned32, Access::read_write, kReceive,
     VOLCOMP_AT(latch_time), 0, "Time of the latch since SYNC, ns"},
    {0x2019, 1, kNodeAxes, DataType::unsigned16, Access::read_write, kReceive,
     VOLCOMP_AT(edge_count), 0, "Edges the drive has latched"},
}};

constexpr std::array<NamedEntry, 72> kServiceRows{{
    {0x2020, 1, kNodeAxes, DataType::integer32, Access::read_only, kTransmit, VOLCOMP_AT(offset), 0,
     "Offset to the drive"},
    {0x2030, 1, kNodeAxes, DataType::unsigned32, Access::read_write, kStored,
     VOLCOMP_AT(scale_numerator), 0, "Run-time units per drive unit, numerator", 1, 1048576},
    {0x2031, 1, kNodeAxes, DataType::unsigned32, Access::read_write, kStored,
     VOLCOMP_AT(scale_denominator), 0, "Run-time units per drive unit, denominator", 1, 1048576},
    {0x2032, 1, kNodeAxes, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(rotary), 0,
     "Kind of axis: 0 linear, 1 rotary", 0, 1},
    {0x2033, 1, kNodeAxes, DataType::unsigned16, Access::read_write, kStored,
     VOLCOMP_AT(homed_mask), 0, "Bits of the drive status that mean referenced"},
    {0x2110, 1, 1, DataType::domain, Access::read_write, kPlain, 0, 0, "Table image"},
    {0x2110, 2, 2, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(staged_crc), 0,
     "CRC-32 of the staged image"},
    {0x2110, 3, 3, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(staged_bytes), 0,
     "Bytes of the staged image"},
    {0x2110, 4, 4, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(image_capacity), 0,
     "Largest image in bytes"},
    {0x2111, 0, 0, DataType::unsigned8, Access::read_write, kPlain, VOLCOMP_AT(table_command), 0,
     "Table command", 0, 5},
    {0x2112, 1, 1, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(table_state), 0,
     "Table state"},
    {0x2112, 2, 2, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(reason), 0,
     "Reason of the last refusal"},
    {0x2112, 3, 3, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(where_axis), 0,
     "Refused at axis (letter)"},
    {0x2112, 4, 4, DataType::integer16, Access::read_only, kPlain, VOLCOMP_AT(where_index), 0,
     "Refused at knot or entry"},
    {0x2112, 5, 5, DataType::integer8, Access::read_only, kPlain, VOLCOMP_AT(where_channel), 0,
     "Refused at channel"},
    {0x2112, 6, 6, DataType::visible_string, Access::read_only, kPlain, VOLCOMP_AT(reason_text),
     160, "Reason in words"},
    {0x2112, 7, 7, DataType::unsigned32, Access::read_only, kTransmit, VOLCOMP_AT(active_crc), 0,
     "CRC-32 of the active image"},
    {0x2112, 8, 8, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(active_sequence), 0,
     "Sequence number of the active image"},
    {0x2200, 1, 1, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(ramp_cycles), 0,
     "Ramp of every change, cycles", 1, 16777216},
    {0x2200, 2, 2, DataType::unsigned16, Access::read_write, kStored, VOLCOMP_AT(drop_cycles), 0,
     "Stale for more cycles: ramped to zero", 1, 65534},
    {0x2200, 3, 3, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(deadline_us), 0,
     "Deadline after SYNC, us; 0: 60 % of the period", 0, 60000000},
    {0x2200, 4, 4, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(late_cycles), 0,
     "Cycles a frame may be late", 0, 7},
    {0x2200, 5, 5, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(drives_report), 0,
     "Drives report their offset", 0, 1},
    {0x2201, 1, kNodeAxes, DataType::integer32, Access::read_write, kStored, VOLCOMP_AT(limit), 0,
     "Largest offset", 1, 4194303},
    {0x2202, 1, kNodeAxes, DataType::integer32, Access::read_write, kStored, VOLCOMP_AT(slew), 0,
     "Largest step of an offset per cycle", 1, 1000000000},
    {0x2203, 1, kNodeAxes, DataType::integer32, Access::read_write, kStored, VOLCOMP_AT(soft_rate),
     0, "Step per cycle of an axis going or coming back", 1, 1000000000},
    {0x2204, 1, kNodeAxes, DataType::integer32, Access::read_write, kStored, VOLCOMP_AT(hysteresis),
     0, "Hysteresis of the direction", 0, 4194303},
    {0x2205, 1, kNodeAxes, DataType::integer64, Access::read_write, kStored, VOLCOMP_AT(max_step),
     0, "Largest plausible step of a position; 0: unchecked", 0, 1152921504606846976},
    {0x2206, 1, kNodeAxes, DataType::integer32, Access::read_write, kPlain,
     VOLCOMP_AT(start_offset), 0, "Offset held by a drive that cannot report it", -1073741824,
     1073741824},
    {0x2300, 1, 1, DataType::unsigned8, Access::read_write, kStored, VOLCOMP_AT(probe.command), 0,
     "Probe: 0 off, 1 on with these settings", 0, 1},
    {0x2300, 2, 2, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(probe.delay_ns), 0,
     "Delay from contact to edge, ns", 0, 10000000},
    {0x2300, 3, 3, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(probe.bounce_us),
     0, "Shortest time between two touches, us", 0, 10000000},
    {0x2300, 4, 4, DataType::unsigned32, Access::read_write, kStored, VOLCOMP_AT(probe.skew_ns), 0,
     "Longest time between the edges of two axes, ns", 0, 10000000},
    {0x2300, 5, 5, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(probe.reason), 0,
     "Reason of the last refusal of these settings"},
    {0x2301, 1, kNodeAxes, DataType::unsigned32, Access::read_write, kStored,
     VOLCOMP_AT(probe.latch_delay_ns), 0, "Delay from edge to latch, ns", 0, 10000000},
    {0x2302, 1, kLobingTerms, DataType::real64, Access::read_write, kStored,
     VOLCOMP_AT(probe.lobing), 0, "Effective radius by direction, nm"},
    {0x2303, 1, 12, DataType::real64, Access::read_write, kStored, VOLCOMP_AT(probe.workpiece), 0,
     "Workpiece frame: rotation by rows, origin in nm"},
    {0x2304, 1, 7, DataType::real64, Access::read_write, kStored, VOLCOMP_AT(probe.uncertainty), 0,
     "Standard uncertainties of the probe"},
    {0x2305, 1, kNodeAxes, DataType::real64, Access::read_write, kStored,
     VOLCOMP_AT(probe.position_uncertainty), 0, "Standard uncertainty of a latched position"},
    {0x2306, 1, kNodeAxes, DataType::real64, Access::read_write, kStored,
     VOLCOMP_AT(probe.latch_delay_uncertainty_ns), 0, "Standard uncertainty of the delay, ns"},
    {0x2310, 1, 1, DataType::unsigned32, Access::read_write, kPlain, VOLCOMP_AT(probe.feature), 0,
     "Feature to be touched next; takes its normal over"},
    {0x2310, 2, 4, DataType::real64, Access::read_write, kPlain, VOLCOMP_AT(probe.normal), 0,
     "Normal out of the part, or 0"},
    {0x2310, 5, 5, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(probe.flank_reason),
     0, "Reason of the last refusal of the flank"},
    {0x2310, 6, 6, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(probe.flank_field), 0,
     "Sub-index of 2313h it was refused for"},
    {0x2311, 1, 1, DataType::unsigned32, Access::read_write, kPlain, VOLCOMP_AT(probe.gear), 0,
     "Face gear in force; takes its numbers over; 0: none"},
    {0x2311, 2, 2, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(probe.gear_reason), 0,
     "Reason of the last refusal of the gear"},
    {0x2311, 3, 3, DataType::visible_string, Access::read_only, kPlain,
     VOLCOMP_AT(probe.gear_field), 16, "Number the gear was refused for"},
    {0x2312, 1, 11, DataType::real64, Access::read_write, kPlain, VOLCOMP_AT(probe.gear_number), 0,
     "Face gear: teeth, mm, rad, modules"},
    {0x2313, 1, 1, DataType::unsigned32, Access::read_write, kPlain, VOLCOMP_AT(probe.flank.gear),
     0, "Gear of the flank to be touched; 0: no flank"},
    {0x2313, 2, 2, DataType::integer8, Access::read_write, kPlain, VOLCOMP_AT(probe.flank.side), 0,
     "Side of the slot, 1 or -1"},
    {0x2313, 3, 3, DataType::unsigned16, Access::read_write, kPlain, VOLCOMP_AT(probe.flank.slot),
     0, "Slot, from 0"},
    {0x2313, 4, 4, DataType::unsigned8, Access::read_write, kPlain, VOLCOMP_AT(probe.flank.row), 0,
     "Row of the measuring grid, from 0"},
    {0x2313, 5, 5, DataType::unsigned8, Access::read_write, kPlain, VOLCOMP_AT(probe.flank.column),
     0, "Column of the measuring grid, from 0"},
    {0x2313, 6, 6, DataType::unsigned32, Access::read_write, kPlain,
     VOLCOMP_AT(probe.flank.radius_nm), 0, "Radius of the ball, nm"},
    {0x2313, 7, 7, DataType::unsigned32, Access::read_write, kPlain,
     VOLCOMP_AT(probe.flank.gate_nm), 0, "Touched within this distance of the flank, nm"},
    {0x2400, 1, 1, DataType::unsigned16, Access::read_only, kTransmit, VOLCOMP_AT(probe.waiting), 0,
     "Points that wait"},
    {0x2400, 2, 2, DataType::unsigned32, Access::read_only, kTransmit, VOLCOMP_AT(probe.lost), 0,
     "Points that found no room"},
    {0x2400, 3, 3, DataType::unsigned32, Access::read_only, kTransmit, VOLCOMP_AT(probe.touches), 0,
     "Touches"},
    {0x2400, 4, 4, DataType::unsigned32, Access::read_only, kTransmit, VOLCOMP_AT(probe.rejected),
     0, "Rejected touches"},
    {0x2401, 1, 1, DataType::unsigned32, Access::read_only, kTransmit, VOLCOMP_AT(probe.sequence),
     0, "Latest point: number"},
    {0x2401, 2, 2, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(probe.verdict), 0,
     "Latest point: verdict"},
    {0x2401, 3, 3, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(probe.axis), 0,
     "Latest point: axis of the verdict"},
    {0x2401, 4, 4, DataType::unsigned16, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.feature_low), 0, "Latest point: feature, low half"},
    {0x2401, 5, 7, DataType::integer32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.workpiece_nm), 0, "Latest point: workpiece coordinate, nm"},
    {0x2401, 8, 8, DataType::unsigned32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.uncertainty_nm), 0, "Latest point: largest standard uncertainty, nm"},
    {0x2401, 9, 11, DataType::integer64, Access::read_only, kPlain, VOLCOMP_AT(probe.machine_nm), 0,
     "Latest point: machine coordinate, nm"},
    {0x2401, 12, 12, DataType::integer32, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.distance_nm), 0, "Judged point: distance from the flank, nm"},
    {0x2401, 13, 13, DataType::unsigned8, Access::read_only, kTransmit,
     VOLCOMP_AT(probe.flank_verdict), 0, "Judged point: verdict on the flank"},
    {0x2401, 14, 14, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(probe.foot), 0,
     "Judged point: verdict on its foot"},
    {0x2401, 15, 15, DataType::unsigned32, Access::read_only, kTransmit, VOLCOMP_AT(probe.judged),
     0, "Judged point: number"},
    {0x2410, 1, 1, DataType::domain, Access::read_only, kPlain, 0, 0, "Oldest point that waits"},
    {0x2411, 0, 0, DataType::unsigned32, Access::read_write, kPlain, VOLCOMP_AT(probe.release), 0,
     "Number of the oldest point: it has been read"},
}};

constexpr std::array<NamedEntry, 21> kDiagnosisRows{{
    {0x2600, 1, 1, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(state), 0,
     "State of the node"},
    {0x2600, 2, 2, DataType::unsigned8, Access::read_only, kTransmit, VOLCOMP_AT(sync_counter), 0,
     "SYNC counter of the last cycle"},
    {0x2600, 3, 3, DataType::unsigned16, Access::read_only, kTransmit, VOLCOMP_AT(any_status), 0,
     "Status bits of all axes"},
    {0x2600, 4, 4, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(cycles), 0,
     "Cycles computed"},
    {0x2600, 5, 5, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(deadline_missed), 0,
     "Cycles incomplete at the deadline"},
    {0x2600, 6, 6, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(cycles_skipped), 0,
     "Cycles cut short by the next SYNC"},
    {0x2600, 7, 7, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(sync_missed), 0,
     "SYNC messages missed"},
    {0x2600, 8, 8, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(sync_foreign), 0,
     "SYNC messages of another producer"},
    {0x2600, 9, 9, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(activations), 0,
     "Tables activated"},
    {0x2600, 10, 10, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(rejections), 0,
     "Tables refused"},
    {0x2600, 11, 11, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(stored), 0,
     "Result of reading the stored parameters"},
    {0x2600, 12, 12, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(store_result), 0,
     "Result of the last save or restore"},
    {0x2600, 13, 13, DataType::unsigned8, Access::read_only, kPlain, VOLCOMP_AT(reset_cause), 0,
     "Why the processor started"},
    {0x2600, 14, 14, DataType::unsigned32, Access::read_only, kPlain, VOLCOMP_AT(frames_lost), 0,
     "Received frames lost"},
    {0x2601, 1, kNodeAxes, DataType::unsigned16, Access::read_only, kTransmit, VOLCOMP_AT(status),
     0, "Status word of the axis"},
    {0x2602, 1, kNodeAxes, DataType::integer32, Access::read_only, kPlain, VOLCOMP_AT(largest), 0,
     "Largest offset put out"},
    {0x2610, 1, kStatusBits, DataType::unsigned16, Access::read_only, kPlain, at_began(0), 0,
     "Times each status bit of axis 1 began"},
    {0x2611, 1, kStatusBits, DataType::unsigned16, Access::read_only, kPlain, at_began(1), 0,
     "Times each status bit of axis 2 began"},
    {0x2612, 1, kStatusBits, DataType::unsigned16, Access::read_only, kPlain, at_began(2), 0,
     "Times each status bit of axis 3 began"},
    {0x2613, 1, kStatusBits, DataType::unsigned16, Access::read_only, kPlain, at_began(3), 0,
     "Times each status bit of axis 4 began"},
    {0x2614, 1, kStatusBits, DataType::unsigned16, Access::read_only, kPlain, at_began(4), 0,
     "Times each status bit of axis 5 began"},
}};

constexpr auto kStart =
    joined(joined(kStoreRows, time_rows<kFollowsTemperature>(VOLCOMP_AT(thermal))), kReceivedRows);
constexpr auto kServices =
    joined(joined(process_state_rows<kWatchesStrokes>(VOLCOMP_AT(stroke)), kServiceRows),
           stroke_rows<kWatchesStrokes>(VOLCOMP_AT(stroke)));
constexpr auto kOwn =
    joined(joined(kStart, kServices),
           joined(kDiagnosisRows, thermal_rows<kFollowsTemperature>(VOLCOMP_AT(thermal))));

#undef VOLCOMP_AT

constexpr auto kNamed = canopen::with_communication(kOwn);

}  // namespace

canopen::Dictionary node_dictionary() {
  canopen::Dictionary dictionary = canopen::DictionaryOf<kNamed>::value;
  dictionary.arrival = arrival_of;
  return dictionary;
}

std::uint32_t arrival_of(canopen::ObjectId object) {
  const unsigned element = object.sub - 1U;  // axis or input
  switch (object.index) {
    case 0x2011:
      return bit(Arrival::kTarget + element);
    case 0x2014:
      return bit(Arrival::kActual + element);
    case 0x2016:
      return bit(Arrival::kHeld + element);
    case 0x2017:
      return bit(Arrival::kLatched + element);
    case 0x2019:
      return bit(Arrival::kCounted + element);
    case 0x201A:
      return bit(Arrival::kProcessState);
    case kTemperatureObject:
      return bit(Arrival::kTemperature + element);
    default:
      return 0;
  }
}

Span<const NamedEntry> named_node_dictionary() { return kNamed; }

}  // namespace volcomp::node
