#include "firmware/node/offset_gate.hpp"

#include <algorithm>
#include <cstring>

namespace volcomp::node {
namespace {

std::int32_t between(std::int32_t low, std::int32_t value, std::int32_t high) {
  return std::max(low, std::min(high, value));
}

}  // namespace

void OffsetGate::configure(const GateBounds& bounds) {
  copy_ = bounds;
  copy_.limit = std::min(bounds.limit, kMostHeld);
  copy_.slew = std::min(bounds.slew, kMostHeld);
  copy_.soft = std::min(bounds.soft, kMostHeld);
  copy_.late = std::min(bounds.late, kMostLate);
  std::memcpy(&bounds_, &copy_, sizeof bounds_);  // what is between the members, too
  tripped_ = false;
  forget();
}

// Compares words: a bool that a flipped bit has made neither true nor false must not be read as
// one.
bool OffsetGate::intact() const {
  static_assert(sizeof(GateBounds) % sizeof(std::uint32_t) == 0);
  const auto* const bounds = reinterpret_cast<const unsigned char*>(&bounds_);
  const auto* const copy = reinterpret_cast<const unsigned char*>(&copy_);
  std::uint32_t differ = 0;
  for (std::size_t at = 0; at < sizeof bounds_; at += sizeof differ) {
    std::uint32_t one = 0;
    std::uint32_t other = 0;
    std::memcpy(&one, bounds + at, sizeof one);
    std::memcpy(&other, copy + at, sizeof other);
    differ |= one ^ other;
  }
  return differ == 0;
}

// The smaller of two slews is right or too small, and the longest memory is never too short.
void OffsetGate::trip() {
  bounds_.slew = std::max<std::int32_t>(1, std::min(bounds_.slew, copy_.slew));
  bounds_.soft = bounds_.slew;
  bounds_.late = kMostLate;
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
  unreported_ = 0;
  open_ = held >= -kMostHeld && held <= kMostHeld;
  approaching_ = true;
}

bool OffsetGate::sent_recently(std::int32_t value) const {
  for (std::size_t i = 0; i < window(); ++i) {
    if (sent_[i] == value) return true;
  }
  return false;
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
std::int32_t OffsetGate::limited(std::int32_t wanted) const {
  std::int32_t lowest = held_;
  std::int32_t highest = held_;
  for (std::size_t i = 0; i < window(); ++i) {
    lowest = std::min(lowest, sent_[i]);
    highest = std::max(highest, sent_[i]);
  }
  const std::int32_t from = highest - bounds_.slew;
  const std::int32_t to = lowest + bounds_.slew;
  if (from > to) return last_;  // a smaller slew than these were sent with
  const std::int32_t most = std::max(bounds_.limit, last_ < 0 ? -last_ : last_);
  if (approaching_) wanted = between(last_ - bounds_.soft, wanted, last_ + bounds_.soft);
  return between(from, between(-most, wanted, most), to);
}

void OffsetGate::begin_cycle() {
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
  if (!open_) return false;
  if (tripped_) wanted = 0;
  value = fresh_ ? limited(wanted) : last_;
  meets_ = value == wanted;
  return true;
}

void OffsetGate::handed_over(std::int32_t value) {
  at_ = static_cast<std::uint8_t>((at_ + 1U) % window());
  sent_[at_] = last_ = value;
  if (meets_) approaching_ = false;
}

}  // namespace volcomp::node
