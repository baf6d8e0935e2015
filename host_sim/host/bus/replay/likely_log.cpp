#include "host_sim/host/bus/replay/likely_log.hpp"

#include <algorithm>
#include <array>
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

// One frame: in its cycle, or in the one before or after, each with the least that it costs.
struct Choice {
  std::size_t at = 0;  // in the log
  std::uint64_t cycle = 0;
  std::array<std::uint64_t, 3> cost{};
  std::array<std::size_t, 3> from{};  // choice of the frame before
};

constexpr std::uint64_t kImpossible = UINT64_MAX / 4;
constexpr std::uint64_t kTwoInACycle = 1'000'000'000;
constexpr std::uint64_t kFromExpectedSide = 1000;
constexpr std::size_t kStay = 1;

class Cycles {
 public:
  explicit Cycles(const std::vector<LoggedFrame>& log) {
    for (std::size_t i = 0; i < log.size(); ++i) {
      if (log[i].frame.id == canopen::kSync) syncs_.push_back(i);
    }
  }
  // The number of SYNC messages before it.
  [[nodiscard]] std::size_t cycle(std::size_t at) const {
    return static_cast<std::size_t>(std::upper_bound(syncs_.begin(), syncs_.end(), at) -
                                    syncs_.begin());
  }
  // Where the SYNC stands over which `choice` moves a frame; the frame itself where it may not.
  [[nodiscard]] std::size_t over(std::size_t at, std::size_t choice) const {
    const std::size_t c = cycle(at);
    if (choice == 0 && c > 0 && at - syncs_[c - 1] <= kBeside) return syncs_[c - 1];
    if (choice == 2 && c < syncs_.size() && syncs_[c] - at <= kBeside) return syncs_[c];
    return at;
  }

 private:
  std::vector<std::size_t> syncs_;
};

// The cheapest choice for all frames of one identifier: two in a cycle cost most, then moves from
// the side of the SYNC on which this identifier usually stands.
void choose(std::vector<Choice>& frames, const Cycles& cycles) {
  const auto movable = [&](std::size_t c) {
    return std::count_if(frames.begin(), frames.end(),
                         [&](const Choice& f) { return cycles.over(f.at, c) != f.at; });
  };
  const std::size_t usual = movable(0) > movable(2) ? 0 : 2;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      Choice& f = frames[i];
      const bool possible = c == kStay || cycles.over(f.at, c) != f.at;
      f.cost[c] = !possible ? kImpossible : c == kStay ? 0 : c == usual ? kFromExpectedSide : 1;
      if (i == 0 || !possible) continue;
      const Choice& before = frames[i - 1];
      std::uint64_t least = kImpossible;
      for (std::size_t b = 0; b < 3; ++b) {
        if (before.cycle + b > f.cycle + c) continue;
        const bool two = before.cycle + b == f.cycle + c;
        const std::uint64_t cost = before.cost[b] + (two ? kTwoInACycle : 0);
        if (cost < least) f.from[c] = b;
        least = std::min(least, cost);
      }
      f.cost[c] += least;
    }
  }
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
  const Cycles cycles(log);
  std::map<std::uint16_t, std::vector<Choice>> frames;
  std::vector<std::pair<std::size_t, std::size_t>> order;  // twice the place, and where it stood
  for (std::size_t i = 0; i < log.size(); ++i) {
    order.emplace_back(2 * i + 1, i);
    if (is_process_data(log[i].frame.id))
      frames[log[i].frame.id].push_back({i, cycles.cycle(i), {}, {}});
  }
  for (auto& [id, choices] : frames) {
    choose(choices, cycles);
    const auto& last = choices.back().cost;
    auto c = static_cast<std::size_t>(std::min_element(last.begin(), last.end()) - last.begin());
    for (auto f = choices.rbegin(); f != choices.rend(); c = f->from[c], ++f) {
      if (c != kStay) order[f->at].first = 2 * cycles.over(f->at, c) + c;
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
