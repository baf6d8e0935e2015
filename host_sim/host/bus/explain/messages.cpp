// Messages of a running node: status bits, emergency codes, verdicts on touches.

#include <algorithm>
#include <array>

#include "host_sim/host/bus/explain/explanation.hpp"
#include "host_sim/host/bus/explain/reason_rows.hpp"

namespace volcomp::host {
namespace {

using canopen::ErrorCode;

template <class Key>
struct Row {
  Key key;
  Explanation text;
};

constexpr std::array<Row<StatusBit>, kStatusBits> kBits{{
    {kValid, {"The axis runs as configured.", "Nothing."}},
    {kNotHomed,
     {"The drive is not in operation enabled, or its status word does not say that it is "
      "referenced (2033h). Before that, positions mean nothing.",
      "Enable the drive and let it home."}},
    {kStale,
     {"The process data of this cycle did not come before the deadline.",
      "Look at the bus load, the cables and 2200h:03; some such cycles are harmless."}},
    {kDropped,
     {"Data have been missing for more cycles than 2200h:02 allows.",
      "Find out why the drive is silent. It comes back by itself with the soft rate."}},
    {kImplausible,
     {"From one cycle to the next the position moved farther than 2205h: a lost bit, a changed "
      "reference, or a limit below the speed of the machine.",
      "Compare 2205h with the rapid traverse; reference the axis again."}},
    {kOutOfRange,
     {"The axis stands where nothing was measured; the value of the end is used.",
      "Measure the whole travel if you work there."}},
    {kFarOutOfRange,
     {"More than half a pitch beyond the end the value of the end means little.",
      "Measure the whole travel, or look for a shifted reference point."}},
    {kClamped,
     {"The correction asked for is larger than 2201h.",
      "Look for a wrong unit in the tables; raise 2201h only if the error is real."}},
    {kRateLimited,
     {"The correction has to change faster than its share of 2202h, a (2 x 2200h:04 + 3)th, as "
      "after a reversal or near a step "
      "in a table.",
      "Nothing during a moment; if it stays, raise 2202h or look for a kink in the table."}},
    {kDirectionUnknown,
     {"Reversal is known only after the first motion.",
      "Nothing: any motion beyond half of 2204h ends it."}},
    {kRamping, {"Tables, tool or state have just changed.", "Wait for 2200h:01 cycles."}},
    {kNoAuthority,
     {"In this pose the correcting axes cannot produce the motion.",
      "See the reason no_authority."}},
    {kNoTables,
     {"No tables have been activated since the start, or they were deactivated.",
      "Download tables, or store them with 1010h so that they are there after power-on."}},
    {kTableDamaged,
     {"The checksum over the tables in memory changed: a bit flipped.",
      "Activate tables again. If it comes back, the memory is bad."}},
}};

const std::vector<Row<ErrorCode>>& error_rows() {
  static const std::vector<Row<ErrorCode>> rows{
      {ErrorCode::none, {"The error whose code stands in bytes 4 and 5 has gone.", "Nothing."}},
      {ErrorCode::temperature_held,
       {"An axis of the active tables grows by the input in byte 3, counted from 1; byte 4: 2 "
        "nothing came for 2702h:02 seconds, 3 the latest value cannot be true. Corrections go on "
        "with the last good temperature.",
        "Look at the sensor, its wire and the sender of 2700h. It ends with a plausible value."}},
      {ErrorCode::memory_damaged,
       {"A bit of the settings, the chain of the machine or the limits and the scale of an axis "
        "(byte 3; 0: not of one axis) changed in memory.",
        "Stop and start the node, then activate the tables again; for byte 3 = 0 reset the node. "
        "If it comes back, the memory is bad."}},
      {ErrorCode::program_damaged,
       {"The checksum of code and constants is no longer what it was after the start.",
        "Reset the node. If it comes back, write the firmware again; then the memory is bad."}},
      {ErrorCode::store_failed,
       {"The memory refused to be written or read back differently; 2600h:0C has the reason.",
        "Try again; if it stays, replace the memory. What was stored before is still there."}},
      {ErrorCode::unexpected_reset,
       {"Watchdog (2) or a processor fault (3), byte 3 of the message says which.",
        "Read 2600h:0D and the console of the board; report it with a log of the bus."}},
      {ErrorCode::background_overdue,
       {"The background did not show for 100 ms (5 s in announced work). The interrupt went on and "
        "took the corrections back.",
        "The watchdog restarts the node by itself. Report it with a log of the bus."}},
      {ErrorCode::parameters_lost,
       {"Power failed while saving, or the memory is worn.",
        "2600h:0B says whether the record before was used. Check the settings, store again."}},
      {ErrorCode::can_overrun,
       {"Frames came faster than the node fetched them.",
        "Lower the load of the bus; volcomp bus-load says which cycle rates fit."}},
      {ErrorCode::can_passive,
       {"More than 127 errors were counted while sending or receiving.",
        "Look at the cables, the two terminating resistors, the bit rate of every device, and "
        "whether anybody else is on the bus."}},
      {ErrorCode::heartbeat,
       {"The node whose id is in byte 3 has not sent its heartbeat within 1016h.",
        "Look at that device, its cable and its 1017h."}},
      {ErrorCode::bus_off_recovered,
       {"More than 255 errors were counted while sending; the controller left the bus and joined "
        "it "
        "again. Told afterwards, as nothing can be sent meanwhile.",
        "As with 8120h. Corrections come back by themselves."}},
      {ErrorCode::sync_length,
       {"1019h of node and SYNC producer differ.",
        "Set 1019h alike in all devices (240, or 0 for no counter)."}},
      {ErrorCode::rpdo_length,
       {"A frame has fewer bytes than are mapped; byte 3 is the PDO.",
        "Compare the mapping of the sender with 1600h and the following."}},
      {ErrorCode::rpdo_timeout,
       {"Frames of the axis in byte 3 were missing at the deadline.",
        "Look at the drive, the bus load and 2200h:03. The other axes go on."}},
      {ErrorCode::axis_not_referenced,
       {"See the status bit not_homed.", "Enable the drive and let it home."}},
      {ErrorCode::axis_implausible,
       {"See the status bit implausible.",
        "Compare 2205h with the rapid traverse; reference again."}},
      {ErrorCode::axis_clamped,
       {"See the status bit clamped.",
        "Look for a wrong unit in the tables before raising 2201h."}},
      {ErrorCode::axis_out_of_range,
       {"See the status bit far_out_of_range.",
        "Measure the whole travel, or look for a shifted reference point."}},
      {ErrorCode::no_authority,
       {"See the reason no_authority.", "Keep away from this pose or declare other axes."}},
      {ErrorCode::table_refused,
       {"Validation found something; byte 4 is the reason, byte 3 the letter of the axis, 2112h "
        "says more.",
        "Look the reason up (volcomp explain), mend it, download again. The tables before go on."}},
      {ErrorCode::table_damaged, {"See the status bit table_damaged.", "Activate tables again."}},
      {ErrorCode::tables_expired,
       {"2704h:02 has passed. Nothing is switched off in the middle of the work, but the same "
        "tables are refused when they are activated again.",
        "Measure the machine again. A wrong date of the node shows in 2704h:01."}},
      {ErrorCode::time_doubted,
       {"A TIME was more than two hours off the date of the node, which is kept: what one frame "
        "says "
        "must not make tables expire. The third TIME in a row that goes on like the one before is "
        "believed.",
        "Find out who else sends TIME (100h). A date that is wrong for good is written to "
        "2704h:01."}},
      {ErrorCode::foreign_sync,
       {"The counter of a SYNC does not continue the sequence, or the node produced SYNC (1005h "
        "bit 30) and heard another: it then stops producing. Without counter (1019h = 0) a node "
        "that listens cannot notice.",
        "Clear bit 30 of 1005h in all but one device."}},
      {ErrorCode::offset_not_confirmed,
       {"Without that report the node cannot promise that no offset jumps; it sends nothing to the "
        "drive.",
        "Map 60B0h into a TPDO of the drive; if it has none, see 2200h:05 and 2206h."}},
      {ErrorCode::touch_rejected,
       {"Byte 3 is the verdict; it is told once until the next good point.",
        "Look the verdict up below."}},
      {ErrorCode::point_lost,
       {"32 points waited and nobody released them.",
        "Let the controller read 2410h and write the number to 2411h."}},
  };
  return rows;
}

constexpr std::array<Row<TouchVerdict>, kTouchVerdicts> kVerdicts{{
    {TouchVerdict::point, {"Everything was there.", "Nothing."}},
    {TouchVerdict::centre,
     {"The normal of 2310h is 0, so no radius was taken off.",
      "Write the normal if you want the point of contact."}},
    {TouchVerdict::uncertified,
     {"The machine was not measured there.",
      "Measure the whole travel, or use the point with care."}},
    {TouchVerdict::uncorrected,
     {"Tables are deactivated or were never activated.", "Activate tables."}},
    {TouchVerdict::bounce,
     {"The switch of a probe closes several times.", "Nothing; 2300h:03 sets the shortest time."}},
    {TouchVerdict::double_edge,
     {"A drive keeps one latch per cycle.",
      "Approach more slowly, or look for noise on the input of the probe."}},
    {TouchVerdict::axis_missing,
     {"The touch probe function of that drive (60B8h) is not armed, or its frame was lost.",
      "Arm all drives, look at the bus load. 2401h:03 names the axis."}},
    {TouchVerdict::no_position,
     {"The frame with 60BAh was lost, or is not mapped.",
      "Map 60BAh and 60D1h, look at the bus load."}},
    {TouchVerdict::stale_latch,
     {"The frame with 60D5h was lost, or the drive sends latches that nobody asked for.",
      "Map 60D5h, arm the probe once per touch."}},
    {TouchVerdict::late_latch,
     {"The drive reported a latch from an earlier cycle.",
      "Look at the type of its TPDO (0: at the SYNC after the edge)."}},
    {TouchVerdict::skew,
     {"The times of the latches differ by more than 2300h:04, corrected for the delays of 2301h.",
      "Measure the delays of the inputs, or look for a drive that triggers on the other edge."}},
    {TouchVerdict::no_velocity,
     {"Without a speed the delay cannot be turned into a distance.",
      "Look for lost frames before the touch."}},
    {TouchVerdict::not_homed, {"Positions mean nothing before homing.", "Reference the axis."}},
    {TouchVerdict::retracting,
     {"The speed points out of the part: the probe opened, or the normal is reversed.",
      "Check the sign of the normal in 2310h."}},
    {TouchVerdict::no_machine,
     {"The chain comes with the tables.", "Activate tables; zero ones will do."}},
}};

template <class Rows, class Key>
Explanation find(const Rows& rows, Key key) {
  const auto row =
      std::find_if(rows.begin(), rows.end(), [key](const auto& r) { return r.key == key; });
  return row == rows.end() ? Explanation{} : row->text;
}

Explanation find_reason(const std::vector<ReasonRow>& rows, Reason reason) {
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [reason](const ReasonRow& r) { return r.reason == reason; });
  return row == rows.end() ? Explanation{} : Explanation{row->why, row->remedy};
}

}  // namespace

Explanation explain(Reason reason) {
  const Explanation found = find_reason(loading_reasons(), reason);
  return *found.why != '\0' ? found : find_reason(measuring_reasons(), reason);
}

Explanation explain(ErrorCode code) { return find(error_rows(), code); }

Explanation explain(TouchVerdict verdict) { return find(kVerdicts, verdict); }

Explanation explain(StatusBit bit) { return find(kBits, bit); }

}  // namespace volcomp::host
