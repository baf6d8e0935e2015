#include "firmware/node/offset_gate.hpp"

#include <algorithm>
#include <cstring>

namespace volcomp::node {
namespace {

std::int32_t between(std::int32_t low, std::int32_t value, std::int32_t high) {
  return std::max(low, std::min(high, value));
}

// Larger numbers than offsets of compensators have, and still none of a limiter overflows.
constexpr std::int32_t kMostLimited = 1 << 28;

constexpr std::size_t kBoundsWords = sizeof(GateBounds) / sizeof(std::uint32_t);
static_assert(sizeof(GateBounds) % sizeof(std::uint32_t) == 0);

std::uint32_t word_of(const GateBounds& bounds, std::size_t i) {
  std::uint32_t word = 0;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&bounds);
  std::memcpy(&word, bytes + i * sizeof word, sizeof word);
  return word;
}

// A single flipped bit changes it.
std::uint32_t sum_of(const GateBounds& bounds) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < kBoundsWords; ++i)
    sum += word_of(bounds, i);
  return sum;
}

std::int32_t size(std::int32_t value) { return value < 0 ? -value : value; }

// Of the way back; without acceleration that of the slew.
OffsetBounds bounds_of_way(const GateBounds& b) {
  const bool none = b.acceleration == 0;
  OffsetLimits l;
  l.limit = between(1, b.limit, kMostLimited);
  l.rate = between(1, none ? b.slew : std::min(b.rate, b.slew), kMostLimited);
  l.soft_rate = none ? l.rate : between(1, b.soft, l.rate);
  l.acceleration = std::min(b.acceleration, 2 * l.rate);
  return OffsetBounds(l);
}

}  // namespace

void OffsetGate::configure(const GateBounds& bounds) {
  copy_ = bounds;
  copy_.limit = std::min(bounds.limit, kMostHeld);
  copy_.slew = std::min(bounds.slew, kMostHeld);
  copy_.soft = std::min(bounds.soft, kMostHeld);
  copy_.rate = std::min(bounds.rate, kMostHeld);
  copy_.acceleration = std::min(bounds.acceleration, kMostHeld);
  copy_.late = std::min(bounds.late, kMostLate);
  std::memcpy(&bounds_, &copy_, sizeof bounds_);  // what is between the members, too
  sum_ = sum_of(copy_);
  way_ = {};
  way_.change(bounds_of_way(copy_));
  way_.start(0);
  tripped_ = refused_ = false;
  known_ = 0;
  forget();
}

// Compares words: a bool that a flipped bit has made neither true nor false must not be read as
// one.
bool OffsetGate::intact() const {
  std::uint32_t differ = 0;
  for (std::size_t i = 0; i < kBoundsWords; ++i)
    differ |= word_of(bounds_, i) ^ word_of(copy_, i);
  return differ == 0;
}

// Of two copies that differ, the one with the sum of the configured bounds is right. Without an
// acceleration the smaller of two slews is right or too small, and the longest memory is never too
// short.
void OffsetGate::trip() {
  const std::int32_t least = std::min(bounds_.slew, copy_.slew);
  const bool first = sum_of(bounds_) == sum_;
  const bool second = sum_of(copy_) == sum_;
  if (!first && second) std::memcpy(&bounds_, &copy_, sizeof bounds_);
  const bool known = first || second;
  if (!known || bounds_.acceleration == 0) {
    bounds_.slew = std::max<std::int32_t>(1, least);
    bounds_.soft = bounds_.slew;
    bounds_.late = kMostLate;
    if (!known) bounds_.acceleration |= copy_.acceleration;
  }
  std::memcpy(&copy_, &bounds_, sizeof copy_);
  tripped_ = approaching_ = true;
}

void OffsetGate::forget() {
  open_ = false;
  reported_ = false;
  same_ = 0;
  unreported_ = 0;
}

void OffsetGate::start_at(std::int32_t held) {
  sent_.fill(held);
  held_ = last_ = held;
  step_ = 0;
  unreported_ = 0;
  open_ = held >= -kMostHeld && held <= kMostHeld;
  approaching_ = apart_ = true;
  met_ = false;
}

bool OffsetGate::sent_recently(std::int32_t value) const {
  return any_sent([value](std::int32_t sent) { return sent == value; });
}

void OffsetGate::report(std::int32_t held) {
  if (bounds_.reports == 0) return;
  const bool expected = open_ && (held == held_ || sent_recently(held));
  if (open_ && !expected) forget();
  if (!open_) {
    same_ = held == held_ && same_ > 0 ? same_ : std::uint8_t{0};
    if (!reported_ && same_ < UINT8_MAX) ++same_;
  }
  held_ = held;
  reported_ = true;
}

// Beyond the limit only on the way back, and never further than it is.
std::int32_t OffsetGate::furthest() const { return std::max(bounds_.limit, size(last_)); }

std::int32_t OffsetGate::within_window(std::int32_t value) const {
  std::int32_t lowest = held_;
  std::int32_t highest = held_;
  any_sent([&](std::int32_t sent) {
    lowest = std::min(lowest, sent);
    highest = std::max(highest, sent);
    return false;
  });
  const std::int32_t from = highest - bounds_.slew;
  const std::int32_t to = lowest + bounds_.slew;
  if (from > to) return last_;  // a smaller slew than these were sent with
  const std::int32_t most = furthest();
  return between(from, between(-most, value, most), to);
}

std::int32_t OffsetGate::limited(std::int32_t wanted) const {
  if (approaching_) wanted = between(last_ - bounds_.soft, wanted, last_ + bounds_.soft);
  return within_window(wanted);
}

// Whether the wanted value keeps limit, rate and acceleration.
bool OffsetGate::accept(std::int32_t wanted) {
  const std::int64_t step = known_ > 0 ? std::int64_t{wanted} - given_ : 0;
  const std::int64_t change = known_ > 1 ? step - given_step_ : 0;
  const std::int64_t most = known_ > 0 ? std::max(bounds_.limit, size(given_)) : bounds_.limit;
  const auto beyond = [](std::int64_t value, std::int64_t bound) {
    return value > bound || value < -bound;
  };
  if (beyond(wanted, most) || beyond(step, bounds_.rate) || beyond(change, bounds_.acceleration))
    return false;
  given_ = wanted;
  given_step_ = static_cast<std::int32_t>(step);
  if (known_ < 2) ++known_;
  return true;
}

// With a bound on acceleration: what is wanted, or on the way to it. `before`: wanted in the last
// cycle.
std::int32_t OffsetGate::moved(std::int32_t wanted, std::int32_t before) {
  if (!apart_) {
    const std::int32_t value = within_window(wanted);
    if (fresh_ && !goes_home() && last_ == before && value == wanted) return value;
    apart_ = true;
    met_ = false;
    way_.resume(last_, step_, last_);
  }
  // A value that was not handed over, or that of a drive which was restarted.
  if (way_.offset() != last_) way_.resume(last_, step_, last_);
  const std::int32_t limit = way_.settings().limit;
  wanted = between(-limit, wanted, limit);
  if (!fresh_) {
    way_.hold();
  } else if (approaching_) {
    way_.follow_softly(wanted);
  } else {
    way_.follow(wanted);
  }
  // What was given may have left no room to stop: here the limit goes first.
  const std::int32_t most = furthest();
  if (size(way_.offset()) > most) way_.start(way_.offset() < 0 ? -most : most);
  const std::int32_t value = within_window(way_.offset());
  if (value != way_.offset()) way_.resume(value, value - last_, value);
  return value;
}

void OffsetGate::begin_cycle() {
  if (!handed_) step_ = 0;
  handed_ = false;
  fresh_ = reported_ || (open_ && bounds_.reports == 0);
  reported_ = false;
  if (bounds_.reports == 0) held_ = last_;
  if (fresh_) {
    unreported_ = 0;
  } else if (unreported_ < UINT8_MAX) {
    ++unreported_;
  }
  if (open_ && unreported_ > bounds_.late + 1) forget();
  if (open_) return;
  if (!fresh_) {
    same_ = 0;
  } else if (same_ > 2 * bounds_.late + 1) {
    start_at(held_);
  }
}

bool OffsetGate::next(std::int32_t wanted, std::int32_t& value) {
  static_cast<void>(check());
  const std::int32_t before = given_;
  if (bounds_.acceleration != 0 && !goes_home() && !accept(wanted)) refused_ = approaching_ = true;
  if (!open_) return false;
  if (goes_home()) wanted = 0;
  if (bounds_.acceleration != 0) {
    value = moved(wanted, before);
  } else {
    value = fresh_ ? limited(wanted) : last_;
  }
  meets_ = value == wanted;
  return true;
}

void OffsetGate::handed_over(std::int32_t value) {
  at_ = static_cast<std::uint8_t>(at_ + 1U < kMemory ? at_ + 1U : 0U);
  step_ = value - last_;
  handed_ = true;
  sent_[at_] = last_ = value;
  // Met twice, it moves as what is wanted does.
  if (meets_ && (met_ || bounds_.acceleration == 0)) approaching_ = apart_ = false;
  met_ = meets_;
}

}  // namespace volcomp::node
