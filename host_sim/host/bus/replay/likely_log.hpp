#pragma once
// Likely orders of the frames of a log that does not replay as written.

#include <vector>

#include "host_sim/host/bus/can_log.hpp"

namespace volcomp::host {

// Whether the frame is so near to a SYNC that it may belong to its other side.
[[nodiscard]] bool beside_sync(const std::vector<LoggedFrame>& log, std::size_t at);

// Process data moved over a SYNC they stand beside, as few as possible, where that spreads those of
// one identifier over the cycles: one each.
[[nodiscard]] std::vector<LoggedFrame> one_per_cycle(const std::vector<LoggedFrame>& log);

// Shortens every gap of more than two cycles, or of half a second before the first cycle, to the
// spacing of the last frames.
[[nodiscard]] std::vector<LoggedFrame> without_silence(std::vector<LoggedFrame> log);

// Moves the last NMT command before that time over the SYNC it stands beside. False where there is
// none.
[[nodiscard]] bool move_command(std::vector<LoggedFrame>& log, std::uint64_t before_us);

}  // namespace volcomp::host
