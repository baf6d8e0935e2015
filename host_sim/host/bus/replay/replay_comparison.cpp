#include "host_sim/host/bus/replay/replay_comparison.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/emergency.hpp"

namespace volcomp::host {
namespace {

// Whether the first byte of an SDO response marks an upload of at most four bytes (CiA 301,
// 7.2.4.3.6).
constexpr bool is_short_upload(std::uint8_t command) { return (command & 0xE2U) == 0x42U; }

// The value of an object changes with time, and the log does not show before or after which
// neighbour the request was served.
bool same_answer(const hal::CanFrame& a, const hal::CanFrame& b) {
  const bool of_the_moment = is_short_upload(a.data[0]) && is_short_upload(b.data[0]);
  return a == b || (a.size == b.size && of_the_moment &&
                    std::equal(a.data.begin(), a.data.begin() + 4, b.data.begin()));
}

std::pair<std::uint16_t, std::vector<std::uint8_t>> content_of(const hal::CanFrame& frame) {
  return {frame.id, {frame.data.begin(), frame.data.begin() + frame.size}};
}

}  // namespace

Comparison::Comparison(std::uint8_t node_id, const MakeNode& make_node)
    : node_id_(node_id), node_(make_node([this](const hal::CanFrame& f) { replayed(f); })) {}

void Comparison::start(const LoggedFrame& first) {
  now_ = {first.time_us, first.line, 0, 0};
  node_->power_on(first.time_us);
  // A command to reset comes to a node that has been running.
  if (!is_boot_up(first.frame, node_id_)) boot_ups_ = 0;
}

// --- differences

void Comparison::differs(const Said& where, const std::string& what,
                         const std::optional<hal::CanFrame>& expected,
                         const std::optional<hal::CanFrame>& got) {
  if (result_.difference) return;
  const std::uint16_t id = where.frame.id;
  const char* const name = id == canopen::kSdoResponse + node_id_ ? "SDO response"
                           : node_->is_status(id)                 ? "status PDO"
                                                                  : "process data";
  result_.difference = {where.place, fmt::format("{} {:03X}h {}", name, id, what), expected, got};
  // What the log lacked in an earlier cycle explains nothing any more.
  if (lacks_until_cycle_ < where.place.cycle) result_.lacks.clear();
}

void Comparison::lacks(const std::string& what, std::uint64_t until_cycle) {
  if (until_cycle < lacks_until_cycle_) return;
  result_.lacks = fmt::format("line {}: {}", now_.line, what);
  lacks_until_cycle_ = until_cycle;
}

// --- frames of the replayed node

void Comparison::replayed(const hal::CanFrame& frame) {
  if (is_boot_up(frame, node_id_)) {
    ++boot_ups_;
    for (auto& [id, stream] : streams_) {
      for (Said& said : stream.replayed)
        said.may_be_lost = true;
    }
    return;
  }
  if (frame.id == canopen::kHeartbeat + node_id_ || frame.id == canopen::kEmergency + node_id_)
    return;
  Said said{frame, now_, false, false};
  said.place.line = 0;
  if (node_->is_timed(frame.id)) return take_timed(said);
  Stream& stream = streams_[frame.id];
  stream.replayed.push_back(said);
  match(stream);
}

// In order, and process data in the same cycle.
void Comparison::match(Stream& stream) {
  while (!stream.logged.empty() && !stream.replayed.empty()) {
    const Said& expected = stream.logged.front();
    const Said& got = stream.replayed.front();
    const bool in_cycle = expected.frame.id != canopen::kSdoResponse + node_id_;
    const std::uint64_t e = expected.place.cycle;
    const std::uint64_t g = got.place.cycle;
    const bool together =
        !in_cycle || e == g || (expected.beside_sync && std::max(e, g) - std::min(e, g) == 1);
    const bool same =
        in_cycle ? expected.frame == got.frame : same_answer(expected.frame, got.frame);
    if (got.may_be_lost && !(together && same)) {
      stream.replayed.pop_front();
      continue;
    }
    if (!together && e < g) return not_sent(expected);
    if (!together) return not_logged(got);
    if (!same) return differs(expected, "differs", expected.frame, got.frame);
    ++result_.compared;
    fresh_ = false;
    stream.logged.pop_front();
    stream.replayed.pop_front();
  }
}

// --- frames of the log

void Comparison::take(const LoggedFrame& logged, bool beside_sync) {
  now_.time_us = logged.time_us;
  now_.line = logged.line;
  if (is_boot_up(logged.frame, node_id_)) {
    take_boot_up(logged);
  } else if (node_->sends(logged.frame.id)) {
    take_answer(logged, beside_sync);
  } else {
    take_input(logged);
  }
}

// The first offset of a cycle shows that the node has computed it. What comes later came too late;
// the very next frame may have come before.
void Comparison::take_input(const LoggedFrame& logged) {
  const bool sync = logged.frame.id == canopen::kSync;
  if (offset_line_ != 0 && (sync || logged.line > offset_line_ + 1)) end_cycle();
  if (sync) begin_cycle(logged.frame);
  if (node_->awaits(logged.frame.id)) heard_.insert(logged.frame.id);
  ++result_.fed;
  node_->receive(logged.frame, logged.time_us);
  observe_timed();
}

void Comparison::take_answer(const LoggedFrame& logged, bool beside_sync) {
  const std::uint16_t id = logged.frame.id;
  last_cycle_ = now_.cycle;
  if (id == canopen::kEmergency + node_id_ && logged.frame.size == 8 &&
      load_le(logged.frame.data.data(), 2) ==
          static_cast<std::uint64_t>(canopen::ErrorCode::can_overrun))
    lacks("the node had not seen all frames that are in the log", UINT64_MAX);
  if (id == canopen::kHeartbeat + node_id_ || id == canopen::kEmergency + node_id_) return;
  const Said said{logged.frame, now_, beside_sync, false};
  if (node_->is_status(id)) look_at_tables(logged.frame);
  if (node_->is_timed(id)) return take_timed(said);
  Stream& stream = streams_[id];
  const bool of_open_cycle = node_->cycle_open() && stream.replayed.empty();
  if (offset_line_ == 0 && of_open_cycle && node_->is_offset(id)) offset_line_ = logged.line;
  stream.logged.push_back(said);
  match(stream);
}

// One that no command explains: the node has been without power. A node that was reset while its
// first boot-up had not yet left sends two in a row.
void Comparison::take_boot_up(const LoggedFrame& logged) {
  if (boot_ups_ == 0 && !fresh_) {
    end_cycle();
    judge_unmatched();
    streams_.clear();
    ++result_.power_ups;
    node_->power_on(logged.time_us);
  }
  boot_ups_ -= std::min<std::size_t>(boot_ups_, 1);
  fresh_ = true;
  offset_line_ = 0;
  ++result_.compared;
}

// --- cycles

void Comparison::begin_cycle(const hal::CanFrame& sync) {
  look_for_gaps(sync);
  now_.sync_counter = sync.data[0];
  now_.cycle = ++result_.cycles;
  heard_earlier_ = std::exchange(heard_, {});
}

void Comparison::end_cycle() {
  if (offset_line_ != 0) node_->pass_deadline();
  offset_line_ = 0;
  observe_timed();
}

// Frames that were on the bus, and candump did not see them: what the node saw is not known.
void Comparison::look_for_gaps(const hal::CanFrame& sync) {
  const std::uint8_t counter = sync.data[0];
  if (sync.size == 1 && result_.cycles != 0 && counter > 1 && counter != now_.sync_counter + 1)
    lacks(fmt::format("SYNC counter {} follows {}", counter, now_.sync_counter), UINT64_MAX);
  for (const std::uint16_t id : heard_earlier_) {
    if (heard_.count(id) == 0)
      lacks(fmt::format("the cycle before it has no {:03X}h", id), now_.cycle + 1);
  }
}

// --- process data whose time depends on the node's clock

void Comparison::observe_timed() {
  for (const hal::CanFrame& frame : node_->timed())
    true_once_.insert(content_of(frame));
}

// The first status frame shows the tables with which the node began.
void Comparison::look_at_tables(const hal::CanFrame& status) {
  const auto had = static_cast<std::uint32_t>(load_le(status.data.data(), 4));
  if (!status_seen_ && node_->active_crc() != had) result_.other_tables = had;
  status_seen_ = true;
}

void Comparison::take_timed(const Said& said) {
  const std::vector<hal::CanFrame> now = node_->timed();
  const auto other = std::find_if(
      now.begin(), now.end(), [&said](const hal::CanFrame& f) { return f.id == said.frame.id; });
  timed_.emplace_back(said, other == now.end() ? std::optional<hal::CanFrame>() : *other);
}

void Comparison::judge_timed() {
  for (const auto& [said, other] : timed_) {
    const bool logged = said.place.line != 0;
    if (true_once_.count(content_of(said.frame)) != 0) {
      result_.compared += logged ? 1U : 0U;
    } else {
      differs(said, "differs", logged ? said.frame : other, logged ? other : said.frame);
    }
  }
}

// The log, or the power of the first node, may end before the last answers do.
void Comparison::judge_unmatched() {
  for (auto& [id, stream] : streams_) {
    std::deque<Said>& sent = stream.replayed;
    while (!sent.empty() && sent.front().may_be_lost)
      sent.pop_front();
    if (!stream.logged.empty()) not_sent(stream.logged.front());
    const bool of_cycle = id != canopen::kSdoResponse + node_id_;
    if (of_cycle && !sent.empty() && sent.front().place.cycle + 2 < last_cycle_)
      not_logged(sent.front());
  }
}

void Comparison::finish() {
  end_cycle();
  judge_unmatched();
  judge_timed();
}

}  // namespace volcomp::host
