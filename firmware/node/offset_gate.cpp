#include "firmware/node/offset_gate.hpp"

#include <algorithm>

namespace volcomp::node {

void OffsetGate::configure(std::int32_t slew, std::uint8_t late, bool reports) {
  slew_ = slew;
  late_ = std::min(late, kMostLate);
  reports_ = reports;
  forget();
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
  at_ = 0;
  unreported_ = 0;
  open_ = true;
}

bool OffsetGate::sent_recently(std::int32_t value) const {
  for (int i = 0; i < 2 * late_ + 2; ++i) {
    if (sent_[static_cast<std::size_t>(i)] == value) return true;
  }
  return false;
}

void OffsetGate::report(std::int32_t held) {
  const bool expected = open_ && (held == held_ || sent_recently(held));
  if (open_ && !expected) forget();
  if (!open_) {
    same_ = held == held_ && same_ > 0 ? same_ : std::uint8_t{0};
    if (!reported_ && same_ < UINT8_MAX) ++same_;
  }
  held_ = held;
  reported_ = true;
}

std::int32_t OffsetGate::limited(std::int32_t wanted) const {
  std::int32_t lowest = held_;
  std::int32_t highest = held_;
  for (int i = 0; i < 2 * late_ + 2; ++i) {
    lowest = std::min(lowest, sent_[static_cast<std::size_t>(i)]);
    highest = std::max(highest, sent_[static_cast<std::size_t>(i)]);
  }
  // 64 bits: an offset may stand anywhere in int32.
  const std::int64_t least = std::int64_t{highest} - slew_;
  const std::int64_t most = std::int64_t{lowest} + slew_;
  return static_cast<std::int32_t>(
      std::max(least, std::min<std::int64_t>(most, std::int64_t{wanted})));
}

void OffsetGate::remember(std::int32_t value) {
  sent_[at_] = value;
  at_ = static_cast<std::uint8_t>((at_ + 1) % (2 * late_ + 2));
  last_ = value;
}

void OffsetGate::begin_cycle() {
  fresh_ = reported_ || (open_ && !reports_);
  reported_ = false;
  if (!reports_) held_ = last_;
  if (fresh_) {
    unreported_ = 0;
  } else if (unreported_ < UINT8_MAX) {
    ++unreported_;
  }
  if (open_ && unreported_ > late_ + 1) forget();
  if (open_) return;
  if (!fresh_) {
    same_ = 0;
  } else if (same_ > 2 * late_ + 1) {
    start_at(held_);
  }
}

bool OffsetGate::next(std::int32_t wanted, std::int32_t& value) {
  if (!open_) return false;
  value = fresh_ ? limited(wanted) : last_;
  remember(value);
  return true;
}

}  // namespace volcomp::node
