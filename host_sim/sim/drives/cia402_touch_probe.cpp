#include "host_sim/sim/drives/cia402_touch_probe.hpp"

namespace volcomp::sim {
namespace {

// Bits of 60B8h for probe 1; those of probe 2 lie 8 higher.
constexpr unsigned kEnable = 1U << 0U;
constexpr unsigned kContinuous = 1U << 1U;
constexpr unsigned kPositiveEdge = 1U << 4U;
constexpr unsigned kNegativeEdge = 1U << 5U;

// Bits of 60B9h.
constexpr unsigned kEnabled = 1U << 0U;
constexpr unsigned kPositiveStored = 1U << 1U;
constexpr unsigned kNegativeStored = 1U << 2U;
constexpr unsigned kStatusOfOne = kEnabled | kPositiveStored | kNegativeStored;

}  // namespace

void apply_function(host::TouchProbeObjects& probe) {
  unsigned status = probe.status;
  for (unsigned shift = 0; shift <= 8; shift += 8) {
    if ((probe.function & (kEnable << shift)) == 0)
      status &= ~(kStatusOfOne << shift);
    else
      status |= kEnabled << shift;
  }
  probe.status = static_cast<std::uint16_t>(status);
}

bool latch(host::TouchProbeObjects& probe, bool rising, std::int32_t position,
           std::uint32_t time_ns) {
  const unsigned wanted = kEnable | (rising ? kPositiveEdge : kNegativeEdge);
  if ((probe.function & wanted) != wanted) return false;
  const unsigned stored = rising ? kPositiveStored : kNegativeStored;
  if ((probe.status & stored) != 0 && (probe.function & kContinuous) == 0) return false;
  host::TouchProbeLatch& edge = rising ? probe.positive_1 : probe.negative_1;
  edge.position = position;
  edge.time_ns = time_ns;
  ++edge.edge_count;
  probe.status = static_cast<std::uint16_t>(probe.status | stored);
  return true;
}

}  // namespace volcomp::sim
