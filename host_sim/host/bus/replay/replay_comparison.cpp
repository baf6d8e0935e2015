#include "host_sim/host/bus/replay/replay_comparison.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"

namespace volcomp::host {
namespace {

// For frames that are not process data. An emulated node on a busy computer takes many seconds to
// answer; an answer that never came is found at the next one, too.
constexpr std::uint64_t kPatience_us = 60'000'000;
// Milliseconds of a node behind a pipe, for process data and for all the rest.
constexpr int kCyclicPatience = 3;
constexpr int kServicePatience = 10'000;

}  // namespace

Comparison::Comparison(std::uint8_t node_id, const MakeSubject& make_subject)
    : node_id_(node_id),
      subject_(make_subject([this](std::uint64_t time_us, const hal::CanFrame& frame) {
        replayed(time_us, frame);
      })) {}

void Comparison::start(const LoggedFrame& first) {
  subject_->power_on(first.time_us);
  // A command to reset comes to a node that has been running.
  if (!is_boot_up(first.frame, node_id_)) streams_.clear();
}

bool Comparison::process_data(std::uint16_t id) const {
  return id != canopen::kHeartbeat + node_id_ && id != canopen::kSdoResponse + node_id_ &&
         id != canopen::kEmergency + node_id_;
}

bool Comparison::in_this_process() const {
  return static_cast<const ReplaySubject*>(&node()) == subject_.get();
}

// A status PDO that leaves when its inhibit time allows. Behind a pipe there is always room on the
// bus: without inhibit time, it belongs to its cycle as every other frame does.
bool Comparison::free_status(std::uint16_t id) const {
  return node().is_status(id) && (in_this_process() || !node().status_every_cycle());
}

bool Comparison::could_say(const hal::CanFrame& status) const {
  const auto holds = [&status](const std::vector<hal::CanFrame>& frames) {
    return std::find(frames.begin(), frames.end(), status) != frames.end();
  };
  return holds(status_) || holds(earlier_status_);
}

std::string Comparison::name_of(std::uint16_t id) const {
  if (id == canopen::kSdoResponse + node_id_) return "SDO response";
  if (id == canopen::kEmergency + node_id_) return "emergency message";
  if (id == canopen::kHeartbeat + node_id_) return "heartbeat";
  if (node().is_status(id)) return "status PDO";
  return "process data";
}

ReplayDifference Comparison::difference(const Said& where, const char* what) const {
  ReplayDifference d;
  d.time_us = where.time_us;
  d.line = where.line;
  d.sync_counter = where.counter;
  d.what = fmt::format("{} {:03X}h {}", name_of(where.frame.id), where.frame.id, what);
  return d;
}

void Comparison::differs(const Said& expected, const hal::CanFrame& got, const char* what) {
  if (result_.difference) return;
  result_.difference = difference(expected, what);
  result_.difference->expected = expected.frame;
  result_.difference->got = got;
}

void Comparison::not_sent(const Said& expected) {
  if (result_.difference) return;
  result_.difference = difference(expected, "is not sent");
  result_.difference->expected = expected.frame;
}

// Either the first node did not say it, or it had no power any more: then its boot-up comes next.
void Comparison::not_logged(const Said& got) {
  if (missing_) return;
  missing_ = difference(got, "is not in the log");
  missing_->got = got.frame;
}

void Comparison::had_power() {
  if (missing_ && !result_.difference) result_.difference = missing_;
}

// --- what the replayed node says

void Comparison::replayed(std::uint64_t time_us, const hal::CanFrame& frame) {
  if (is_boot_up(frame, node_id_)) {
    forget_unsent();
  } else if (frame.id == canopen::kHeartbeat + node_id_) {
    return;
  } else if (free_status(frame.id)) {
    const Said said{frame, time_us, result_.cycles, counter_, 0};
    if (!in_this_process() && !could_say(frame)) return differs(said, node().status(), "differs");
    status_.push_back(frame);
    status_due_ = true;
    return;
  } else if (node().is_status(frame.id) && !cycle_begun_) {
    start_status_ = frame;
    return;
  }
  Stream& stream = streams_[frame.id];
  stream.replayed.push_back({frame, time_us, result_.cycles, counter_, 0});
  match(stream);
}

// What was not yet on the bus when the node was reset never came there.
void Comparison::forget_unsent() {
  for (auto& [id, stream] : streams_)
    stream.replayed.clear();
  status_due_ = status_overdue_ = cycle_begun_ = false;
  start_status_.reset();
}

// In order; process data at the latest one cycle after they were made.
void Comparison::match(Stream& stream) {
  while (!stream.logged.empty() && !stream.replayed.empty()) {
    const Said& expected = stream.logged.front();
    const Said& got = stream.replayed.front();
    const bool late = process_data(got.frame.id) && expected.cycle > got.cycle + 1;
    if (late) {
      not_logged(got);
      return had_power();
    }
    if (expected.frame != got.frame) return differs(expected, got.frame, "differs");
    ++result_.compared;
    stream.logged.pop_front();
    stream.replayed.pop_front();
  }
}

// What the node could say now, where only the moment decides whether it does.
void Comparison::observe() {
  states_.insert(static_cast<std::uint8_t>(node().state()));
  const hal::CanFrame status = node().status();
  if (status_.empty() || status_.back() != status) status_.push_back(status);
}

// --- what the log says

void Comparison::take(const LoggedFrame& logged) {
  now_us_ = logged.time_us;
  subject_->advance(logged.time_us);
  observe();
  if (is_boot_up(logged.frame, node_id_)) {
    take_boot_up(logged);
  } else if (node().sends(logged.frame.id)) {
    take_answer(logged);
  } else {
    take_input(logged);
  }
  observe();
}

void Comparison::take_input(const LoggedFrame& logged) {
  if (logged.frame.id == canopen::kSync) {
    subject_->end_cycle();
    counter_ = logged.frame.data[0];
    begin_cycle();
  }
  ++result_.fed;
  const canopen::NmtState before = node().state();
  subject_->receive(logged.frame, logged.time_us);
  if (node().state() != before) cycle_begun_ = false;
}

// Whoever is slower than the node of the log gets the time to say what that has said.
void Comparison::await(std::uint16_t id) {
  const std::deque<Said>& said = streams_[id].replayed;
  const int most = process_data(id) ? kCyclicPatience : kServicePatience;
  for (int i = 0; i < most && said.empty() && subject_->linger(); ++i) {
  }
}

void Comparison::take_answer(const LoggedFrame& logged) {
  had_power();
  subject_->poll(logged.time_us);
  observe();
  const Said said{logged.frame, logged.time_us, result_.cycles, counter_, logged.line};
  if (logged.frame.id == canopen::kHeartbeat + node_id_) return compare_heartbeat(said);
  if (free_status(logged.frame.id)) return compare_status(said);
  if (take_start_status(logged.frame)) return;
  await(logged.frame.id);
  Stream& stream = streams_[logged.frame.id];
  stream.logged.push_back(said);
  match(stream);
}

// One that no command explains: the node has been without power. A node that was reset while its
// first boot-up had not yet left sends two in a row.
void Comparison::take_boot_up(const LoggedFrame& logged) {
  missing_.reset();
  subject_->poll(logged.time_us);
  await(logged.frame.id);
  Stream& stream = streams_[logged.frame.id];
  const bool again = stream.replayed.empty() && result_.compared == compared_at_boot_up_;
  if (stream.replayed.empty() && !again) {
    finish();
    streams_.clear();
    ++result_.power_ups;
    subject_->power_on(logged.time_us);
  }
  if (!again) streams_[logged.frame.id].replayed.pop_front();
  compared_at_boot_up_ = ++result_.compared;
}

void Comparison::compare_heartbeat(const Said& said) {
  const auto state = static_cast<std::uint8_t>(said.frame.data[0] & 0x7FU);
  if (said.frame.size == 1 && states_.count(state) > 0) {
    ++result_.compared;
    states_.clear();
    return;
  }
  const hal::CanFrame got{said.frame.id, 1, {static_cast<std::uint8_t>(node().state())}};
  differs(said, got, "tells another state");
}

void Comparison::compare_status(const Said& said) {
  if (!could_say(said.frame)) return differs(said, node().status(), "differs");
  ++result_.compared;
  (status_overdue_ ? status_overdue_ : status_due_) = false;
}

// The first status after a start belongs to no cycle. Where the command to start and the first SYNC
// came to the node at once, it had nothing to say in between.
bool Comparison::take_start_status(const hal::CanFrame& frame) {
  if (!node().is_status(frame.id) || !start_status_) return false;
  const bool said = *start_status_ == frame && streams_[frame.id].replayed.empty();
  start_status_.reset();
  if (said) ++result_.compared;
  return said;
}

// --- cycles

// A command to start may still wait in the background of a node when the first SYNC comes: that
// cycle then has no status.
void Comparison::begin_cycle() {
  check_age();
  status_overdue_ = status_due_ && !first_cycle_;
  first_cycle_ = !cycle_begun_;
  status_due_ = false;
  earlier_status_ = std::move(status_);
  status_.clear();
  cycle_begun_ = true;
  ++result_.cycles;
}

// Whether something has waited too long for its counterpart.
void Comparison::check_age() {
  const auto too_old = [this](const std::deque<Said>& waiting) {
    if (waiting.empty()) return false;
    const Said& said = waiting.front();
    return process_data(said.frame.id) ? said.cycle < result_.cycles
                                       : now_us_ - said.time_us > kPatience_us;
  };
  for (const auto& [id, stream] : streams_) {
    if (too_old(stream.logged)) return not_sent(stream.logged.front());
    if (too_old(stream.replayed)) return not_logged(stream.replayed.front());
  }
  if (status_overdue_ && node().status_every_cycle())
    not_logged({node().status(), now_us_, result_.cycles, counter_, 0});
}

// The log may end before the last answers do, but it may not hold more than there are.
void Comparison::finish() {
  had_power();
  for (const auto& [id, stream] : streams_) {
    if (!stream.logged.empty()) return not_sent(stream.logged.front());
  }
}

}  // namespace volcomp::host
