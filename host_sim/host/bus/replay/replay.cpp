#include "host_sim/host/bus/replay/replay.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/tables/image.hpp"
#include "firmware/canopen/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/replay/replay_comparison.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

using canopen::NmtCommand;

namespace {

bool is_reset(const hal::CanFrame& frame, std::uint8_t node_id) {
  return frame.id == canopen::kNmt && frame.size == 2 &&
         frame.data[0] == static_cast<std::uint8_t>(NmtCommand::reset_node) &&
         (frame.data[1] == 0 || frame.data[1] == node_id);
}

// Nothing the node did before it started anew matters afterwards.
std::size_t find_start(const std::vector<LoggedFrame>& log, std::uint8_t node_id) {
  const auto start = std::find_if(log.begin(), log.end(), [node_id](const LoggedFrame& logged) {
    return is_boot_up(logged.frame, node_id) || is_reset(logged.frame, node_id);
  });
  if (start == log.end())
    throw UserError(fmt::format(
        "the log holds no start of node {}: neither its boot-up nor a command to reset it",
        node_id));
  return static_cast<std::size_t>(start - log.begin());
}

MakeSubject in_this_process(std::uint8_t node_id, const std::vector<std::uint8_t>& image) {
  return [node_id, image](ReplaySubject::OnSent on_sent) {
    return std::make_unique<ReplayedNode>(node_id, image, std::move(on_sent));
  };
}

// The first status frame tells with which tables the node began.
void check_tables(const std::vector<LoggedFrame>& log, std::size_t start, std::uint8_t node_id,
                  const std::vector<std::uint8_t>& image) {
  Comparison trial(node_id, in_this_process(node_id, image));
  trial.start(log[start]);
  for (std::size_t i = start; i < log.size(); ++i) {
    trial.take(log[i]);
    if (!trial.node().is_status(log[i].frame.id)) continue;
    const auto had = static_cast<std::uint32_t>(canopen::load_le(log[i].frame.data.data(), 4));
    if (trial.node().active_crc() == had) return;
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
}

std::string hex(const std::optional<hal::CanFrame>& frame) {
  if (!frame) return "nothing";
  std::vector<std::string> bytes;
  for (std::size_t i = 0; i < frame->size; ++i)
    bytes.push_back(fmt::format("{:02X}", frame->data[i]));
  return fmt::format("{}", fmt::join(bytes, " "));
}

ReplayResult compare(const std::vector<LoggedFrame>& log, std::size_t start, std::uint8_t node_id,
                     const MakeSubject& make_subject) {
  Comparison comparison(node_id, make_subject);
  comparison.start(log[start]);
  for (std::size_t i = start; i < log.size() && comparison.result().equal(); ++i)
    comparison.take(log[i]);
  comparison.finish();
  ReplayResult result = comparison.result();
  result.skipped = start;
  return result;
}

}  // namespace

ReplayResult replay(const std::vector<LoggedFrame>& log, std::uint8_t node_id,
                    const std::vector<std::uint8_t>& image) {
  const std::size_t start = find_start(log, node_id);
  check_tables(log, start, node_id, image);
  return compare(log, start, node_id, in_this_process(node_id, image));
}

ReplayResult replay_over_pipe(const std::vector<LoggedFrame>& log, std::uint8_t node_id,
                              const PipedNode::Start& start) {
  const std::size_t first = find_start(log, node_id);
  check_tables(log, first, node_id, {});
  return compare(log, first, node_id, [node_id, &start](ReplaySubject::OnSent on_sent) {
    return std::make_unique<PipedNode>(node_id, start, std::move(on_sent));
  });
}

std::string describe(const ReplayResult& result) {
  std::string text;
  if (result.skipped > 0)
    text += fmt::format("{} frames before the start of the node were left out\n", result.skipped);
  text += fmt::format("{} cycles, {} frames fed, {} frames of the node equal\n", result.cycles,
                      result.fed, result.compared);
  if (result.power_ups > 0)
    text += fmt::format("the node was without power {} times\n", result.power_ups);
  if (result.equal()) return text + "the node did the same again\n";
  const ReplayDifference& d = *result.difference;
  text += fmt::format("first difference at {}.{:06} s, SYNC counter {}{}: {}\n",
                      d.time_us / 1'000'000U, d.time_us % 1'000'000U, d.sync_counter,
                      d.line == 0 ? "" : fmt::format(", line {}", d.line), d.what);
  text += fmt::format("  in the log: {}\n  replayed:   {}\n", hex(d.expected), hex(d.got));
  return text;
}

}  // namespace volcomp::host
