#pragma once
// Does the node do the same again? A log of a bus with a node is fed to a fresh one, and what that
// sends is compared with what the log says the first one sent.
//
// Compared bit for bit: offsets and other process data, each in its SYNC cycle; SDO responses,
// emergency messages and boot-ups in their order. The status PDO leaves when its inhibit time
// allows and says what is true at that moment: it has to be what the node said in this cycle or in
// the one before; where it has no inhibit time, no cycle may lack it. That of the start, before the
// first cycle, may be missing in the log. Heartbeats are compared by the state they tell, since
// their moment is a matter of each node's clock.
//
// What the node does depends on time only through the deadline 2200h:03, inhibit times and
// timeouts, for which the log's clock stands. In a log in lock step (volcomp run --can) none of
// them matters. Elsewhere a frame that came within some 100 µs of the deadline may have been judged
// otherwise by the node's own clock, and on a bus without room process data replace each other.

#include <optional>
#include <string>
#include <vector>

#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/host/bus/replay/piped_node.hpp"

namespace volcomp::host {

struct ReplayDifference {
  std::uint64_t time_us = 0;              // the log's clock
  std::size_t line = 0;                   // in the log; 0: a frame the log lacks
  std::uint8_t sync_counter = 0;          // of the cycle; 0 where SYNC carries none
  std::string what;                       // which frame, in words
  std::optional<hal::CanFrame> expected;  // in the log
  std::optional<hal::CanFrame> got;       // sent by the replayed node
};

struct ReplayResult {
  std::size_t skipped = 0;                     // frames before the node's start
  std::uint64_t cycles = 0;                    // SYNC messages
  std::size_t fed = 0;                         // frames given to the node
  std::size_t compared = 0;                    // frames of the node found equal
  std::size_t power_ups = 0;                   // of the node, without a command to reset
  std::optional<ReplayDifference> difference;  // the first; the replay ends there

  [[nodiscard]] bool equal() const { return !difference; }
};

// `image`: tables the node had stored before the log began, empty for none. Throws UserError when
// the log does not hold the start of the node, or when the node had tables at its start which are
// neither in the log nor given.
[[nodiscard]] ReplayResult replay(const std::vector<LoggedFrame>& log, std::uint8_t node_id,
                                  const std::vector<std::uint8_t>& image);

// The same with a node behind a frame pipe. Every start of the node in the log without a command to
// reset is a fresh one here. Throws what starting it or its link throws, too.
[[nodiscard]] ReplayResult replay_over_pipe(const std::vector<LoggedFrame>& log,
                                            std::uint8_t node_id, const PipedNode::Start& start);

// Several lines for a person.
[[nodiscard]] std::string describe(const ReplayResult& result);

}  // namespace volcomp::host
