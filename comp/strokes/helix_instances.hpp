#pragma once

#include "comp/strokes/helix_monitor.hpp"
#include "comp/strokes/stroke_offsets.hpp"

namespace volcomp {

// 65 mm of stroke in steps of 0.25 mm, a tenth of Z's ripple of 2.5 mm
// (docs/papers/internal-helical.md), and gears of up to 128 teeth: 33 KB and 5 KB.
inline constexpr std::size_t kStrokeNodes = 261;
inline constexpr std::size_t kGearSlots = 128;

using GrinderMonitor = HelixMonitor<kStrokeNodes, kGearSlots>;
using GrinderOffsets = StrokeOffsets<kStrokeNodes, kGearSlots>;

extern template class HelixMonitor<kStrokeNodes, kGearSlots>;
extern template class StrokeOffsets<kStrokeNodes, kGearSlots>;

}  // namespace volcomp
