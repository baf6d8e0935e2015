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
#include "firmware/canopen/object_lines.hpp"

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

// 2504h: weight, dead band (standard deviations), largest step, largest offset, steepest slope
// along the stroke (rad/mm), largest difference of two slots.
inline constexpr std::array<double, 6> kLearningRules{0.5, 0.0, 1e-3, 2e-3, 1e-3, 1e-4};
// 2505h: of a node of a stroke, of a slot.
inline constexpr std::array<std::uint32_t, 2> kLeastSamples{8, 2};

struct StrokeObjects {
#define STROKE OBJECT_MEMBER
#include "firmware/node/objects.def"
  // By direction: figures of each signal (2512h, 2513h), amplitudes of the lines along Z, then in
  // time (2514h, 2515h), um.
  std::array<std::array<double, kFlankSignals * kFigures>, 2> figures{};
  std::array<std::array<double, 2 * kMostLines>, 2> lines{};
  std::array<LearnedTable, kStrokeTables> learned{};  // 2521h…2523h
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
