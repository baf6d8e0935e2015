#pragma once
// The values behind 201Ah (what the controller grinds) and 2500h (monitor, learning and offsets of
// a helical grinder), with their defaults. The node adds the learned offsets to those of the axis C
// (comp/strokes/stroke_offsets.hpp). docs/papers/internal-helical.md, "What we do".
//
// Lengths in mm and angles in rad unless the name has another unit.

#include <array>
#include <cstdint>

#include "comp/strokes/helix_instances.hpp"
#include "comp/strokes/learning_choice.hpp"
#include "firmware/canopen/named_entry.hpp"

namespace volcomp::node {

// 201Ah:02, of the target positions that the controller sends in the same cycle.
inline constexpr std::uint16_t kInFace = 1U << 0U;          // the wheel is within the face width
inline constexpr std::uint16_t kStrokeEnd = 1U << 1U;       // and turns round here
inline constexpr std::uint16_t kStrokeForward = 1U << 2U;   // Z rises; neither this nor
inline constexpr std::uint16_t kStrokeBackward = 1U << 3U;  // this: the direction is unknown

// 2500h:01.
enum class StrokeCommand : std::uint8_t {
  off = 0,  // strokes are not looked at, nothing is learned, the offset is 0
  on = 1,   // the settings of 2500h…2505h are taken over
};

// 2520h:01. Tables come into force at the end of the next stroke.
enum class LearnCommand : std::uint8_t {
  none = 0,
  learn = 1,       // one step of all tables from what was watched since the last
  forget = 2,      // what was watched since the last step
  start_over = 3,  // tables to zero; what a guard remembers, too
  stop = 4,        // the offset goes to 0 at once; the tables are kept
  resume = 5,      // the tables as they are: after stop, a download or a start
};

// 2524h:01.
enum class StrokeTableState : std::uint8_t {
  none = 0,     // no offset
  waiting = 1,  // for the end of a stroke
  in_force = 2,
};

// What became of a table in the last step: 2521h forward, 2522h backward, 2523h slots.
struct LearnedTable {
  std::uint8_t action = 0;    // :01 GuardAction
  std::uint8_t result = 0;    // :02 LearningResult
  std::uint16_t updated = 0;  // :03 nodes
  std::uint16_t clamped = 0;  // :04 of them, at the largest offset
  std::uint16_t skipped = 0;  // :05 for want of samples or below the dead band
  double flank_rms_um = 0.0;  // :06 before the step
  double weight = 0.0;        // :07 halved by every roll-back
};

inline constexpr std::size_t kStrokeTables = 3;
inline constexpr std::size_t kFigures = 5;  // of a signal: count, mean, peak, deviation, RMS

struct StrokeObjects {
  std::uint16_t slot = 0;          // 201Ah:01
  std::uint16_t flags = 0;         // 201Ah:02
  std::int32_t feed_nm_per_s = 0;  // 201Ah:03 programmed, magnitude

  std::uint8_t command = 0;            // 2500h:01 StrokeCommand
  std::array<std::uint8_t, 3> axis{};  // 2500h:02…04 of X, Z, C, from 1
  std::uint16_t slots = 0;             // 2500h:05 of the gear
  std::uint16_t nodes = 0;             // 2500h:06 along the stroke
  std::uint32_t pitch_nm = 250'000;    // 2500h:07 of the nodes
  std::int64_t first_node_nm = 0;      // 2500h:08
  std::int32_t rate = 20'000;          // 2500h:09 of the offset per cycle, 2^-32 turn
  std::uint16_t stale_cycles = 10;     // 2500h:0A then the offset goes to 0
  std::uint8_t reason = 0;             // 2500h:0B Reason of the last refusal of the settings
  std::array<char, 20> field{};        // 2500h:0C what they were refused for
  std::array<double, 3> gear{};        // 2501h 1/p, r_b cos β_b, |dn| per error of X
  std::array<double, kMostLines> wavelength_mm{};  // 2502h lines along Z, 0: none
  std::array<double, kMostLines> frequency_hz{};   // 2503h lines in time, 0: none
  // 2504h weight, dead band (standard deviations), largest step, largest offset, steepest slope
  // along the stroke (rad/mm), largest difference of two slots
  std::array<double, 6> rules{0.5, 0.0, 1e-3, 2e-3, 1e-3, 1e-4};
  std::array<std::uint32_t, 2> least_samples{8, 2};  // 2505h per node of a stroke, per slot

  std::array<std::uint32_t, kFrameUses> frames{};  // 2510h:01…06 as FrameUse
  std::uint32_t passes_lost = 0;                   // 2510h:07 not collected in time
  std::uint32_t outside = 0;                       // 2510h:08 samples beyond the nodes
  std::uint32_t discarded = 0;                     // 2510h:09 passes with too many bad samples
  std::array<std::uint32_t, 2> passes{};         // 2510h:0A, :0B by direction, since the last step
  std::array<float, kFlankSignals> signal_um{};  // 2511h last sample on the flank: FlankSignal
  // 2512h, 2513h by direction: figures of each signal, µm
  std::array<std::array<double, kFlankSignals * kFigures>, 2> figures{};
  // 2514h, 2515h by direction: amplitudes of the lines along Z, then in time, µm
  std::array<std::array<double, 2 * kMostLines>, 2> lines{};

  std::uint8_t learn = 0;         // 2520h:01 LearnCommand
  std::uint8_t target = 0;        // 2520h:02 LearningTarget: synchronisation or C alone
  std::uint8_t force = 0;         // 2520h:03 1: even if it breaks the helix
  std::uint8_t learn_reason = 0;  // 2520h:04 Reason of the last refusal
  std::array<LearnedTable, kStrokeTables> learned{};  // 2521h…2523h
  std::uint8_t table_state = 0;                       // 2524h:01 StrokeTableState
  std::int32_t table_feed = 0;                        // 2524h:02 nm/s
  std::uint16_t offset_status = 0;                    // 2524h:03 StatusBit, kOtherFeed
  std::int32_t offset = 0;                            // 2524h:04 2^-32 turn
  std::uint32_t out_of_table = 0;                     // 2524h:05
  std::uint32_t stale = 0;                            // 2524h:06
  std::array<float, 3> prediction_um{};  // 2525h on the flank: lag of Z, of C, of both together
  std::uint8_t image_reason = 0;         // 2526h:02 Reason of the last refusal of a download
};

// Nothing of it, on nodes that do not watch strokes.
struct NoStrokeObjects {};

// 2526h:01, the learned tables, little-endian: "VCSTROKE", machine id (u32), nodes and slots (u16),
// first node in nm (i64), pitch in nm (u32), feed in nm/s (i32), offsets in rad (f32: forward,
// backward, slots), CRC-32 of all that.
inline constexpr std::size_t kLearnedHeader = 32;
inline constexpr std::size_t kMostLearnedBytes =
    kLearnedHeader + 4 * (2 * kStrokeNodes + kGearSlots) + 4;

}  // namespace volcomp::node
