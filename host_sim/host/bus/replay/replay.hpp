#pragma once
// Replays a log of a bus with a node into a fresh node and compares what that sends with what the
// log holds of the first.
//
// Compared bit for bit: offsets and other process data, by identifier, each in the cycle of its
// SYNC; SDO responses in their order, but for values of up to four bytes, which are those of the
// moment. What leaves by the node's clock, the status PDO above all, has to be what the replayed
// node had to send at some time; the status names its cycle. Heartbeats, emergency messages and the
// time of a frame are not compared.
//
// A log holds what was on the bus, but not the exact order in which the node received it:
// - A frame within three lines of a SYNC may belong to the cycle on its other side. It does where
//   that gives every cycle one frame of that identifier, and the log is not equal otherwise. So may
//   a command of NMT.
// - A cycle ended at its deadline when offsets stand two lines or more before a frame it waits for.
// - A clock that is set is noted; time goes on with the spacing there was. So it does after a
//   silence of more than two cycles, where the log is not equal otherwise.
// Real deviations of that kind are therefore not found: a frame that the node assigned to the cycle
// beside its own, and a deadline that it missed.
//
// Where the log lacks a frame that the node received, a difference does not count.

#include <optional>
#include <string>
#include <vector>

#include "host_sim/host/bus/can_log.hpp"
#include "host_sim/host/bus/replay/piped_node.hpp"

namespace volcomp::host {

struct ReplayPlace {
  std::uint64_t time_us = 0;      // the log's clock
  std::size_t line = 0;           // in the log; 0: a frame the log lacks
  std::uint64_t cycle = 0;        // SYNC messages since the node's start
  std::uint8_t sync_counter = 0;  // of the cycle; 0 where SYNC carries none
};

struct ReplayDifference : ReplayPlace {
  std::string what;                       // which frame, as text
  std::optional<hal::CanFrame> expected;  // in the log
  std::optional<hal::CanFrame> got;       // sent by the replayed node
};

// The clock of the log was set before this line.
struct ClockSet {
  std::size_t line = 0;
  std::int64_t by_us = 0;
};

struct ReplayResult {
  std::size_t skipped = 0;                     // frames before the node's start
  std::uint64_t cycles = 0;                    // SYNC messages
  std::size_t fed = 0;                         // frames given to the node
  std::size_t compared = 0;                    // frames of the node found equal
  std::size_t power_ups = 0;                   // of the node, without a command to reset
  std::vector<ClockSet> clock_set;             // by a millisecond or more
  std::optional<ReplayDifference> difference;  // the first; the replay ends there
  std::string lacks;  // line and reason, where the log lacks what the node may have seen
  // CRC-32 of the tables the node began with, where the replayed one began with others.
  std::optional<std::uint32_t> other_tables;

  [[nodiscard]] bool equal() const { return !difference; }
};

// `image`: tables the node had stored before the log began, empty for none. Throws UserError where
// the log cannot be judged: it does not hold the start of the node; the node had tables at its
// start which are neither in the log nor given; it differs where the log lacks frames.
[[nodiscard]] ReplayResult replay(const std::vector<LoggedFrame>& log, std::uint8_t node_id,
                                  const std::vector<std::uint8_t>& image);

// The same with a node behind a frame pipe. Every start of the node in the log without a command to
// reset is a fresh one here. Throws what starting it or its link throws, too.
[[nodiscard]] ReplayResult replay_over_pipe(const std::vector<LoggedFrame>& log,
                                            std::uint8_t node_id, const PipedNode::Start& start);

// Several lines for a person.
[[nodiscard]] std::string describe(const ReplayResult& result);

}  // namespace volcomp::host
