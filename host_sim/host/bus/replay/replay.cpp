#include "host_sim/host/bus/replay/replay.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "comp/tables/image.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/replay/likely_log.hpp"
#include "host_sim/host/bus/replay/replay_comparison.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using canopen::NmtCommand;

namespace {

using Log = std::vector<LoggedFrame>;

bool is_reset(const hal::CanFrame& frame, std::uint8_t node_id) {
  return frame.id == canopen::kNmt && frame.size == 2 &&
         frame.data[0] == static_cast<std::uint8_t>(NmtCommand::reset_node) &&
         (frame.data[1] == 0 || frame.data[1] == node_id);
}

// Nothing the node did before it started anew matters afterwards.
std::size_t find_start(const Log& log, std::uint8_t node_id) {
  const auto start = std::find_if(log.begin(), log.end(), [node_id](const LoggedFrame& logged) {
    return is_boot_up(logged.frame, node_id) || is_reset(logged.frame, node_id);
  });
  if (start == log.end())
    throw UserError(fmt::format(
        "the log holds no start of node {}: neither its boot-up nor a command to reset it",
        node_id));
  return static_cast<std::size_t>(start - log.begin());
}

MakeNode in_this_process(std::uint8_t node_id, const std::vector<std::uint8_t>& image) {
  return [node_id, image](ReplayedNode::OnSent on_sent) {
    return std::make_unique<ReplayedNode>(node_id, image, std::move(on_sent));
  };
}

void refuse_other_tables(std::uint8_t node_id, std::uint32_t had,
                         const std::vector<std::uint8_t>& image) {
  if (image.empty())
    throw UserError(
        fmt::format("node {} began with tables of CRC-32 {:08X} that the log does not contain: "
                    "give them with --image",
                    node_id, had));
  throw UserError(fmt::format(
      "node {} began {}, the image given has CRC-32 {:08X}", node_id,
      had == 0 ? std::string("without tables") : fmt::format("with tables of CRC-32 {:08X}", had),
      image_crc({image.data(), image.size()})));
}

ReplayResult compare(const Log& log, std::uint8_t node_id, const MakeNode& make_node) {
  Comparison comparison(node_id, make_node);
  const std::size_t start = find_start(log, node_id);
  comparison.start(log[start]);
  for (std::size_t i = start; i < log.size() && comparison.result().equal(); ++i)
    comparison.take(log[i], beside_sync(log, i));
  comparison.finish();
  ReplayResult result = comparison.result();
  result.skipped = start;
  return result;
}

using Judged = std::pair<Log, ReplayResult>;

bool is_better(const ReplayResult& a, const ReplayResult& b) {
  return a.equal() || (!b.equal() && a.difference->cycle > b.difference->cycle);
}

// Moves the commands beside a SYNC to its other side where that gets farther.
Judged try_commands(const Log& log, std::uint8_t node_id, const MakeNode& make_node) {
  Judged best{log, compare(log, node_id, make_node)};
  for (Log other = log; !best.second.equal();) {
    if (!move_command(other, best.second.difference->time_us)) break;
    const ReplayResult result = compare(other, node_id, make_node);
    if (!is_better(result, best.second)) break;
    best = {other, result};
  }
  return best;
}

// Tries the likely orders of the log, the written one first, and returns the one that is equal or
// gets farthest.
Judged most_likely(const Log& log, std::uint8_t node_id, const std::vector<std::uint8_t>& image) {
  const MakeNode make_node = in_this_process(node_id, image);
  Judged best = try_commands(log, node_id, make_node);
  const Log even = without_silence(log);
  for (int i = 0; i < 3 && !best.second.equal(); ++i) {
    Judged likely =
        try_commands(i == 1 ? even : one_per_cycle(i == 0 ? log : even), node_id, make_node);
    if (is_better(likely.second, best.second)) best = std::move(likely);
  }
  const std::optional<std::uint32_t> other_tables = best.second.other_tables;
  if (!best.second.equal() && other_tables) refuse_other_tables(node_id, *other_tables, image);
  return best;
}

// Adds the settings of the clock to the result. A short gap is none.
ReplayResult judged(ReplayResult result, const Log& log) {
  constexpr std::int64_t kLeastBack_us = 1000;
  constexpr std::int64_t kLeastForward_us = 1'000'000;
  if (result.difference && !result.lacks.empty())
    throw UserError(result.lacks +
                    ": the log lacks what the node may have seen and cannot be judged");
  for (const LoggedFrame& logged : without_silence(log)) {
    const std::int64_t by_us = logged.clock_set_us;
    if (by_us <= -kLeastBack_us || by_us >= kLeastForward_us)
      result.clock_set.push_back({logged.line, by_us});
  }
  return result;
}

std::string hex(const std::optional<hal::CanFrame>& frame) {
  if (!frame) return "nothing";
  std::vector<std::string> bytes;
  for (std::size_t i = 0; i < frame->size; ++i)
    bytes.push_back(fmt::format("{:02X}", frame->data[i]));
  return fmt::format("{}", fmt::join(bytes, " "));
}

}  // namespace

ReplayResult replay(const Log& log, std::uint8_t node_id, const std::vector<std::uint8_t>& image) {
  return judged(most_likely(log, node_id, image).second, log);
}

ReplayResult replay_over_pipe(const Log& log, std::uint8_t node_id, const PipedNode::Start& start) {
  const auto [likely, in_process] = most_likely(log, node_id, {});
  return judged(compare(in_process.equal() ? likely : log, node_id,
                        [node_id, &start](ReplayedNode::OnSent on_sent) {
                          return std::make_unique<PipedNode>(node_id, start, std::move(on_sent));
                        }),
                log);
}

std::string describe(const ReplayResult& result) {
  std::string text;
  if (result.skipped > 0)
    text += fmt::format("{} frames before the start of the node were left out\n", result.skipped);
  for (const ClockSet& set : result.clock_set)
    text += fmt::format("line {}: the clock of the log was set {} by {:.6f} s{}\n", set.line,
                        set.by_us < 0 ? "back" : "forward",
                        1e-6 * static_cast<double>(std::abs(set.by_us)),
                        set.by_us < 0 ? "" : ", or the bus was silent");
  text += fmt::format("{} cycles, {} frames fed, {} frames of the node equal\n", result.cycles,
                      result.fed, result.compared);
  if (result.power_ups > 0)
    text += fmt::format("the node was without power {} times\n", result.power_ups);
  if (result.equal()) return text + "the node did the same again\n";
  const ReplayDifference& d = *result.difference;
  text += fmt::format("first difference at {}.{:06} s, cycle {}, SYNC counter {}{}: {}\n",
                      d.time_us / 1'000'000U, d.time_us % 1'000'000U, d.cycle, d.sync_counter,
                      d.line == 0 ? "" : fmt::format(", line {}", d.line), d.what);
  text += fmt::format("  in the log: {}\n  replayed:   {}\n", hex(d.expected), hex(d.got));
  return text;
}

}  // namespace volcomp::host
