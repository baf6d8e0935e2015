#include "comp/tick/touch.hpp"

namespace volcomp {
namespace {

struct Entry {
  const char* code;
  const char* sentence;
};

// By number.
constexpr std::array<Entry, kTouchVerdicts> kEntries{{
    {"point", "The point is corrected."},
    {"centre", "The feature has no normal: this is the centre of the ball, corrected."},
    {"uncertified", "An axis stood outside its table: corrected as at the end of the table."},
    {"uncorrected", "No tables are active: the errors of the machine are not corrected."},
    {"bounce", "The edge came too soon after the one before: the probe bounces."},
    {"double_edge", "Several edges within one cycle: which one was latched is unknown."},
    {"axis_missing", "An axis has not reported the edge."},
    {"no_position", "A drive has counted the edge, but its latched position did not arrive."},
    {"stale_latch", "A drive has reported a latched position, but has counted no edge."},
    {"late_latch", "The latch is older than a cycle."},
    {"skew", "The axes have not latched the same edge: their times differ."},
    {"no_velocity", "The speed of an axis at the edge is unknown: a position was missing."},
    {"not_homed", "An axis is not referenced."},
    {"retracting", "The ball was moving away from the part."},
    {"no_machine", "The machine is unknown: no tables have been active since the start."},
}};
static_assert(static_cast<std::size_t>(TouchVerdict::no_machine) + 1 == kEntries.size());

}  // namespace

const char* code(TouchVerdict verdict) { return kEntries[static_cast<std::size_t>(verdict)].code; }

const char* sentence(TouchVerdict verdict) {
  return kEntries[static_cast<std::size_t>(verdict)].sentence;
}

}  // namespace volcomp
