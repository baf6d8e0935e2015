#include "host_sim/host/bus/replay/likely_log.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kBeside = 3;  // lines

constexpr bool is_process_data(std::uint16_t id) {
  return id > canopen::kTpdo1 && id < canopen::kSdoResponse;
}

// A frame of the log, and the cycles that it may belong to: one beside its own, over a SYNC it
// stands beside.
struct Choice {
  std::size_t at = 0;  // in the log
  std::size_t first = 0;
  std::size_t written = 0;
  std::size_t last = 0;
  std::size_t chosen = 0;
};

// Moves every frame that shares the cycle of the one before it to the next cycle.
void move_on(std::vector<Choice>& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i)
    frames[i].chosen =
        std::min(std::max(frames[i].chosen, frames[i - 1].chosen + 1), frames[i].last);
}

void move_back(std::vector<Choice>& frames) {
  for (std::size_t i = frames.size(); i-- > 1;)
    frames[i - 1].chosen =
        std::max(std::min(frames[i - 1].chosen + 1, frames[i].chosen) - 1, frames[i - 1].first);
}

// Cycles with two frames, then moves.
std::pair<std::size_t, std::size_t> cost_of(const std::vector<Choice>& frames) {
  std::pair<std::size_t, std::size_t> cost{0, 0};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0 && frames[i].chosen <= frames[i - 1].chosen) ++cost.first;
    if (frames[i].chosen != frames[i].written) ++cost.second;
  }
  return cost;
}

// All frames of one identifier, which stands before the SYNC or behind it: one of the two ways
// takes more moves.
std::vector<Choice> spread(const std::vector<Choice>& frames) {
  std::vector<Choice> on = frames;
  move_on(on);
  move_back(on);
  std::vector<Choice> back = frames;
  move_back(back);
  move_on(back);
  return cost_of(on) < cost_of(back) ? on : back;
}

}  // namespace

bool beside_sync(const std::vector<LoggedFrame>& log, std::size_t at) {
  const std::size_t end = std::min(at + kBeside + 1, log.size());
  for (std::size_t i = at - std::min(at, kBeside); i < end; ++i) {
    if (log[i].frame.id == canopen::kSync) return true;
  }
  return false;
}

std::vector<LoggedFrame> one_per_cycle(const std::vector<LoggedFrame>& log) {
  std::vector<std::size_t> syncs;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (log[i].frame.id == canopen::kSync) syncs.push_back(i);
  }
  std::map<std::uint16_t, std::vector<Choice>> frames;
  std::vector<std::pair<std::size_t, std::size_t>> order;  // twice the place, and where it stood
  for (std::size_t i = 0, cycle = 0; i < log.size(); ++i) {
    order.emplace_back(2 * i + 1, i);
    if (log[i].frame.id == canopen::kSync) ++cycle;
    if (!is_process_data(log[i].frame.id)) continue;
    const bool after = cycle > 0 && i - syncs[cycle - 1] <= kBeside;
    const bool before = cycle < syncs.size() && syncs[cycle] - i <= kBeside;
    frames[log[i].frame.id].push_back(
        {i, cycle - (after ? 1 : 0), cycle, cycle + (before ? 1 : 0), cycle});
  }
  for (const auto& [id, choices] : frames) {
    for (const Choice& f : spread(choices)) {
      if (f.chosen < f.written) order[f.at].first = 2 * syncs[f.written - 1];
      if (f.chosen > f.written) order[f.at].first = 2 * syncs[f.written] + 2;
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<LoggedFrame> result;
  result.reserve(log.size());
  for (const auto& [place, i] : order) {
    result.push_back(log[i]);
    if (result.size() > 1)
      result.back().time_us = std::max(log[i].time_us, result[result.size() - 2].time_us);
  }
  return result;
}

std::vector<LoggedFrame> without_silence(std::vector<LoggedFrame> log) {
  constexpr std::uint64_t kNoSync_us = 250'000;  // twice that lets no SDO transfer time out
  std::uint64_t sync_us = 0;
  std::uint64_t period_us = kNoSync_us;
  std::uint64_t shift_us = 0;
  std::uint64_t spacing_us = 0;
  std::uint64_t last_us = log.empty() ? 0 : log.front().time_us;
  for (LoggedFrame& logged : log) {
    const std::uint64_t gap_us = logged.time_us - shift_us - last_us;
    if (gap_us > 2 * period_us) {
      shift_us += gap_us - spacing_us;
      logged.clock_set_us += static_cast<std::int64_t>(gap_us - spacing_us);
    } else {
      spacing_us = gap_us;
    }
    logged.time_us -= shift_us;
    last_us = logged.time_us;
    if (logged.frame.id != canopen::kSync) continue;
    if (sync_us != 0) period_us = logged.time_us - sync_us;
    sync_us = logged.time_us;
  }
  return log;
}

bool move_command(std::vector<LoggedFrame>& log, std::uint64_t before_us) {
  const auto is = [&log](std::size_t at, std::uint16_t id) {
    return at < log.size() && log[at].frame.id == id;
  };
  for (std::size_t i = log.size(); i-- > 0;) {
    if (!is(i, canopen::kNmt) || log[i].time_us >= before_us) continue;
    for (std::size_t d = 1; d <= kBeside; ++d) {
      const auto at = log.begin() + static_cast<std::ptrdiff_t>(i);
      const auto distance = static_cast<std::ptrdiff_t>(d);
      const bool after = is(i + d, canopen::kSync);
      if (!after && (i < d || !is(i - d, canopen::kSync))) continue;
      std::rotate(after ? at : at - distance, after ? at + 1 : at,
                  after ? at + distance + 1 : at + 1);
      return true;
    }
  }
  return false;
}

}  // namespace volcomp::host
