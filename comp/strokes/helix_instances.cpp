// The monitor and the offsets of a helical grinder, compiled once; what the build inspects to prove
// that their ticks need no library.

#include "comp/strokes/helix_instances.hpp"

namespace volcomp {

template class HelixMonitor<kStrokeNodes, kGearSlots>;
template class StrokeOffsets<kStrokeNodes, kGearSlots>;

}  // namespace volcomp
