#pragma once
// The rows of the object dictionary behind StrokeObjects.

#include <cstddef>

#include "firmware/node/row_lists.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"

namespace volcomp::node {

namespace detail {

using canopen::Access;
using canopen::DataType;
using canopen::NamedEntry;

#define VOLCOMP_AT(member) static_cast<std::uint16_t>(offsetof(StrokeObjects, member))

constexpr std::array<NamedEntry, 7> learned_rows(std::size_t table) {
  constexpr DataType kU8 = DataType::unsigned8;
  constexpr DataType kU16 = DataType::unsigned16;
  constexpr Access kRead = Access::read_only;
  const auto index = static_cast<std::uint16_t>(0x2521U + table);
  const auto at = [table](std::size_t offset) {
    return static_cast<std::uint16_t>(VOLCOMP_AT(learned) + table * sizeof(LearnedTable) + offset);
  };
  return {{
      {index, 1, 1, kU8, kRead, canopen::kPlain, at(offsetof(LearnedTable, action)), 0,
       "Learned: 0 kept, 1 held, 2 rolled back"},
      {index, 2, 2, kU8, kRead, canopen::kPlain, at(offsetof(LearnedTable, result)), 0,
       "Learned: 0 ok, 1 not finite, 2 no data, 3 slope"},
      {index, 3, 3, kU16, kRead, canopen::kPlain, at(offsetof(LearnedTable, updated)), 0,
       "Learned: nodes changed"},
      {index, 4, 4, kU16, kRead, canopen::kPlain, at(offsetof(LearnedTable, clamped)), 0,
       "Learned: nodes at the largest offset"},
      {index, 5, 5, kU16, kRead, canopen::kPlain, at(offsetof(LearnedTable, skipped)), 0,
       "Learned: nodes left alone"},
      {index, 6, 6, DataType::real64, kRead, canopen::kPlain,
       at(offsetof(LearnedTable, flank_rms_um)), 0, "Learned: RMS on the flank before, um"},
      {index, 7, 7, DataType::real64, kRead, canopen::kPlain, at(offsetof(LearnedTable, weight)), 0,
       "Learned: weight"},
  }};
}

// The process state stands with the other process data.
inline constexpr std::array<NamedEntry, 3> kProcessStateRows{{
    {0x201A, 1, 1, DataType::unsigned16, Access::read_write, canopen::kReceive, VOLCOMP_AT(slot), 0,
     "Slot that is ground, from 0"},
    {0x201A, 2, 2, DataType::unsigned16, Access::read_write, canopen::kReceive, VOLCOMP_AT(flags),
     0, "In face 1, stroke end 2, forward 4, backward 8"},
    {0x201A, 3, 3, DataType::integer32, Access::read_write, canopen::kReceive,
     VOLCOMP_AT(feed_nm_per_s), 0, "Feed of the stroke, nm/s"},
}};

inline constexpr std::array<NamedEntry, 30> kWatchRows{{
    {0x2500, 1, 1, DataType::unsigned8, Access::read_write, canopen::kStored, VOLCOMP_AT(command),
     0, "Strokes: 0 off, 1 on with these settings", 0, 1},
    {0x2500, 2, 4, DataType::unsigned8, Access::read_write, canopen::kStored, VOLCOMP_AT(axis), 0,
     "Axis X, Z, C of the grinder, from 1", 0, 5},
    {0x2500, 5, 5, DataType::unsigned16, Access::read_write, canopen::kStored, VOLCOMP_AT(slots), 0,
     "Slots of the gear"},
    {0x2500, 6, 6, DataType::unsigned16, Access::read_write, canopen::kStored, VOLCOMP_AT(nodes), 0,
     "Nodes along the stroke"},
    {0x2500, 7, 7, DataType::unsigned32, Access::read_write, canopen::kStored, VOLCOMP_AT(pitch_nm),
     0, "Distance of the nodes, nm", 1, 1000000000},
    {0x2500, 8, 8, DataType::integer64, Access::read_write, canopen::kStored,
     VOLCOMP_AT(first_node_nm), 0, "First node, nm"},
    {0x2500, 9, 9, DataType::integer32, Access::read_write, canopen::kStored, VOLCOMP_AT(rate), 0,
     "Largest change of the learned offset per cycle", 1, 4194303},
    {0x2500, 10, 10, DataType::unsigned16, Access::read_write, canopen::kStored,
     VOLCOMP_AT(stale_cycles), 0, "Cycles without process data, then no offset", 1, 65534},
    {0x2500, 11, 11, DataType::unsigned8, Access::read_only, canopen::kPlain, VOLCOMP_AT(reason), 0,
     "Reason of the last refusal of these settings"},
    {0x2500, 12, 12, DataType::visible_string, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(field), 20, "Setting that was refused"},
    {0x2501, 1, 3, DataType::real64, Access::read_write, canopen::kStored, VOLCOMP_AT(gear), 0,
     "Helical gear: 1/p, r_b cos beta_b, dn per X"},
    {0x2502, 1, kMostLines, DataType::real64, Access::read_write, canopen::kStored,
     VOLCOMP_AT(wavelength_mm), 0, "Line along Z: wavelength, mm"},
    {0x2503, 1, kMostLines, DataType::real64, Access::read_write, canopen::kStored,
     VOLCOMP_AT(frequency_hz), 0, "Line in time: frequency, Hz"},
    {0x2504, 1, 6, DataType::real64, Access::read_write, canopen::kStored, VOLCOMP_AT(rules), 0,
     "Learning: weight and limits"},
    {0x2505, 1, 2, DataType::unsigned32, Access::read_write, canopen::kStored,
     VOLCOMP_AT(least_samples), 0, "Learning: least samples of a node, of a slot"},
    {0x2510, 1, kFrameUses, DataType::unsigned32, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(frames), 0, "Samples by what became of them"},
    {0x2510, 7, 7, DataType::unsigned32, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(passes_lost), 0, "Passes not collected in time"},
    {0x2510, 8, 8, DataType::unsigned32, Access::read_only, canopen::kPlain, VOLCOMP_AT(outside), 0,
     "Samples beyond the nodes"},
    {0x2510, 9, 9, DataType::unsigned32, Access::read_only, canopen::kPlain, VOLCOMP_AT(discarded),
     0, "Passes with too many bad samples"},
    {0x2510, 10, 11, DataType::unsigned32, Access::read_only, canopen::kPlain, VOLCOMP_AT(passes),
     0, "Passes since the last step, by direction"},
    {0x2511, 1, kFlankSignals, DataType::real32, Access::read_only, canopen::kTransmit,
     VOLCOMP_AT(signal_um), 0, "On the flank now: sync, lag of C, X, um"},
    {0x2512, 1, kFlankSignals* kFigures, DataType::real64, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(figures), 0, "Forward: count, mean, peak, deviation, RMS"},
    {0x2513, 1, kFlankSignals* kFigures, DataType::real64, Access::read_only, canopen::kPlain,
     static_cast<std::uint16_t>(VOLCOMP_AT(figures) + sizeof(double) * kFlankSignals * kFigures), 0,
     "Backward: count, mean, peak, deviation, RMS"},
    {0x2514, 1, 2 * kMostLines, DataType::real64, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(lines), 0, "Forward: amplitude of a line, um"},
    {0x2515, 1, 2 * kMostLines, DataType::real64, Access::read_only, canopen::kPlain,
     static_cast<std::uint16_t>(VOLCOMP_AT(lines) + sizeof(double) * 2 * kMostLines), 0,
     "Backward: amplitude of a line, um"},
    {0x2516, 1, kStrokeTables, DataType::domain, Access::read_only, canopen::kPlain, 0, 0,
     "Means by node, rad: forward, backward, slots"},
    {0x2520, 1, 1, DataType::unsigned8, Access::read_write, canopen::kPlain, VOLCOMP_AT(learn), 0,
     "Learning command", 0, 5},
    {0x2520, 2, 2, DataType::unsigned8, Access::read_write, canopen::kStored, VOLCOMP_AT(target), 0,
     "Learn from: 0 synchronisation, 3 C alone", 0, 3},
    {0x2520, 3, 3, DataType::unsigned8, Access::read_write, canopen::kPlain, VOLCOMP_AT(force), 0,
     "1: learn even what breaks the helix", 0, 1},
    {0x2520, 4, 4, DataType::unsigned8, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(learn_reason), 0, "Reason of the last refusal to learn"},
}};

inline constexpr std::array<NamedEntry, 9> kOffsetRows{{
    {0x2524, 1, 1, DataType::unsigned8, Access::read_only, canopen::kTransmit,
     VOLCOMP_AT(table_state), 0, "Learned tables: 0 none, 1 waiting, 2 in force"},
    {0x2524, 2, 2, DataType::integer32, Access::read_only, canopen::kPlain, VOLCOMP_AT(table_feed),
     0, "Learned tables: their feed, nm/s"},
    {0x2524, 3, 3, DataType::unsigned16, Access::read_only, canopen::kTransmit,
     VOLCOMP_AT(offset_status), 0, "Learned offset: status bits"},
    {0x2524, 4, 4, DataType::integer32, Access::read_only, canopen::kTransmit, VOLCOMP_AT(offset),
     0, "Learned offset, 2^-32 turn"},
    {0x2524, 5, 5, DataType::unsigned32, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(out_of_table), 0, "Cycles beyond the learned tables"},
    {0x2524, 6, 6, DataType::unsigned32, Access::read_only, canopen::kPlain, VOLCOMP_AT(stale), 0,
     "Cycles without process data"},
    {0x2525, 1, 3, DataType::real32, Access::read_only, canopen::kPlain, VOLCOMP_AT(prediction_um),
     0, "On the flank: lag of Z, of C, of both, um"},
    {0x2526, 1, 1, DataType::domain, Access::read_write, canopen::kPlain, 0, 0, "Learned tables"},
    {0x2526, 2, 2, DataType::unsigned8, Access::read_only, canopen::kPlain,
     VOLCOMP_AT(image_reason), 0, "Reason of the last refusal of tables"},
}};

#undef VOLCOMP_AT

}  // namespace detail

// Rows of a StrokeObjects at `offset` of the node's values; sorted. Empty where there is none.
template <bool there>
constexpr auto process_state_rows(std::size_t offset) {
  if constexpr (there)
    return detail::moved_by(offset, detail::kProcessStateRows);
  else
    return std::array<canopen::NamedEntry, 0>{};
}

template <bool there>
constexpr auto stroke_rows(std::size_t offset) {
  using detail::joined;
  if constexpr (there) {
    const auto learned =
        joined(joined(detail::learned_rows(0), detail::learned_rows(1)), detail::learned_rows(2));
    return detail::moved_by(offset,
                            joined(joined(detail::kWatchRows, learned), detail::kOffsetRows));
  } else {
    return std::array<canopen::NamedEntry, 0>{};
  }
}

}  // namespace volcomp::node
