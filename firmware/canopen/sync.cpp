#include "firmware/canopen/sync.hpp"

namespace volcomp::canopen {

// How many counts lie between two counter values, 1…overflow.
std::uint8_t Sync::steps(std::uint8_t from, std::uint8_t to) const {
  const unsigned period = objects_.sync_counter_overflow;
  const unsigned distance = (to + period - from) % period;
  return static_cast<std::uint8_t>(distance == 0 ? period : distance);
}

SyncVerdict Sync::received(const hal::CanFrame& frame) {
  const std::uint8_t overflow = objects_.sync_counter_overflow;
  if (frame.size != (overflow == 0 ? 0 : 1)) return SyncVerdict::wrong_length;
  if (overflow == 0) {  // a count of our own: whoever is told it sees that cycles go on
    counter_ = static_cast<std::uint8_t>(counter_ % kMostCount + 1);
    return SyncVerdict::good;
  }
  const std::uint8_t count = frame.data[0];
  if (count == 0 || count > overflow) return SyncVerdict::wrong_length;
  const std::uint8_t ahead = steps(counter_, count);
  const bool again = ahead == overflow;  // rather the same message twice than a whole round lost
  if (!started_ || (ahead <= kMostMissed + 1 && !again)) {
    if (started_) missed_ += ahead - 1U;
    started_ = true;
    counter_ = count;
    refused_in_sequence_ = 0;
    return SyncVerdict::good;
  }
  ++foreign_;
  const bool counts_on = refused_in_sequence_ > 0 && steps(refused_counter_, count) == 1;
  refused_in_sequence_ = static_cast<std::uint8_t>(counts_on ? refused_in_sequence_ + 1 : 1);
  refused_counter_ = count;
  if (refused_in_sequence_ >= kRestart) {
    refused_in_sequence_ = 0;
    counter_ = count;
    return SyncVerdict::good;
  }
  return SyncVerdict::foreign;
}

bool Sync::due(std::uint64_t now_us, hal::CanFrame& frame) {
  if (!producing() || objects_.cycle_period_us == 0) {
    producer_started_ = false;
    return false;
  }
  if (!producer_started_) {
    producer_started_ = true;
    next_us_ = now_us;
    counter_ = 0;
  }
  if (now_us < next_us_) return false;
  next_us_ += objects_.cycle_period_us;
  if (next_us_ <= now_us) next_us_ = now_us + objects_.cycle_period_us;  // late: no burst
  frame = {};
  frame.id = id();
  if (objects_.sync_counter_overflow == 0) return true;
  counter_ = static_cast<std::uint8_t>(counter_ % objects_.sync_counter_overflow + 1);
  frame.size = 1;
  frame.data[0] = counter_;
  return true;
}

void Sync::reset() {
  started_ = false;
  producer_started_ = false;
  counter_ = 0;
  refused_in_sequence_ = 0;
}

}  // namespace volcomp::canopen
