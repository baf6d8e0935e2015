#include "comp/tick/offset_limiter.hpp"

namespace volcomp {
namespace {

constexpr std::uint32_t word(std::int32_t x) { return static_cast<std::uint32_t>(x); }

constexpr std::int32_t between(std::int32_t low, std::int32_t high, std::int32_t x) {
  return x < low ? low : x > high ? high : x;
}

// The largest r ≤ most, as far as r ≥ most − 2a, from which stopping within x is possible; x ≥ 0.
// n full steps of a lie below r; at most two shorter n are tried (design of the limiter, section
// 3).
VOLCOMP_INLINE std::int32_t stopping_step_below(std::int32_t most, std::int32_t a, std::int32_t x) {
  if (most <= 0) return most;
  const std::uint32_t c = word(most);
  const std::uint32_t u = word(a);
  std::uint32_t n = (c - 1U) / u;
  std::uint32_t way = u * ((n * n + n) / 2U);  // S(n·a); S(c) = (n + 1)·c − way
  std::uint32_t sum = word(x) + way;
  if (n * c + c <= sum) return most;
  std::int32_t left = x - static_cast<std::int32_t>(way);
  if (left >= 0) return static_cast<std::int32_t>(sum / (n + 1U));
  way = u * n;
  sum -= way;
  left += static_cast<std::int32_t>(way);
  if (left < 0) {
    sum -= way - u;
    --n;
  }
  return static_cast<std::int32_t>(sum / n);
}

}  // namespace

void OffsetLimiter<true>::resume(std::int32_t offset, std::int32_t step, std::int32_t target) {
  if (waiting()) take_bounds();
  offset_ = offset;
  step_ = step;
  target_ = target;
  prepare();
}

void OffsetLimiter<true>::change(const OffsetBounds& bounds) {
  next_ = bounds;
  mode_.set(Mode::waiting);
  prepare();
}

std::int32_t OffsetLimiter<true>::unclamped() const {
  return bounds_.free < bounds_.limit ? bounds_.free : bounds_.limit - 1;
}

// What reach() compares with.
void OffsetLimiter<true>::prepare() {
  rate_ = bounds_.rate;
  most_ = unclamped();
  watch_ = largest_.own() < most_ ? largest_.own() : most_;
  reach_ = bounds_.none() ? INT32_MAX : bounds_.acceleration;
  span_ = target_ == offset_ ? 2U * word(bounds_.acceleration) + 1U : 0U;
  if (bounds_.none()) span_ = UINT32_MAX;
  if (waiting()) span_ = 0;
}

bool OffsetLimiter<true>::intact() const {
  if (waiting()) return true;  // a tick in the middle of this may take them: judged afterwards
  const OffsetBounds& b = bounds_;
  return b == next_ && rate_ == b.rate && most_ == unclamped() && watch_ <= most_ &&
         reach_ == (b.none() ? INT32_MAX : b.acceleration);
}

// Keeps the largest offset. Adds that it is beyond the limit.
VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::keep_largest(std::uint32_t status) {
  const std::int32_t out = size(offset_);
  if (VOLCOMP_UNLIKELY(out > largest_.own())) {
    largest_.set(out);
    watch_ = out < most_ ? out : most_;
  }
  return out > bounds_.limit ? status | kSettling : status;
}

bool OffsetLimiter<true>::may_take_bounds() const {
  if (next_.contain(bounds_) || (next_.none() && bounds_.none())) return true;
  const std::int32_t least = next_.rate < next_.acceleration ? next_.rate : next_.acceleration;
  return size(step_) <= least;
}

void OffsetLimiter<true>::take_bounds() {
  bounds_ = next_;
  mode_.release(bounds_.none() ? Mode::free : Mode::bounded);
  prepare();
  span_ = 0;
}

std::int32_t OffsetLimiter<true>::braked() const {
  const std::int32_t way = stopping_way(size(step_) - bounds_.acceleration, bounds_.acceleration);
  return step_ < 0 ? offset_ - way : offset_ + way;
}

std::uint32_t OffsetLimiter<true>::brake() {
  step_ -= between(-reach_, reach_, step_);
  target_ = offset_ += step_;
  span_ = bounds_.none() ? UINT32_MAX : 2U * word(bounds_.acceleration) + 1U;
  if (!waiting()) return keep_largest(0);
  span_ = 0;
  return keep_largest(kSettling);
}

std::uint32_t OffsetLimiter<true>::hold() {
  if (VOLCOMP_UNLIKELY(waiting() && may_take_bounds())) take_bounds();
  const std::uint32_t status = brake();
  return step_ != 0 ? status | kAccelerationLimited : status;
}

std::uint32_t OffsetLimiter<true>::approach(std::int32_t target, bool softly) {
  if (VOLCOMP_UNLIKELY(waiting())) {
    if (!may_take_bounds()) return brake();
    take_bounds();
    target_ = target;  // not taken to move
  }
  const std::int32_t rate = softly ? bounds_.soft_rate : bounds_.rate;
  if (VOLCOMP_UNLIKELY(mode_.own() == Mode::free)) return approach_free(target, rate);
  return approach_bounded(target, rate, softly ? kNoneFree : bounds_.free);
}

VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::approach_bounded(std::int32_t target,
                                                                   std::int32_t rate,
                                                                   std::int32_t free) {
  const std::int32_t a = bounds_.acceleration;
  const std::int32_t before = step_;
  const std::int32_t e = target - offset_;
  // How fast the target is taken to move: as it did, but not beyond what the offset does.
  std::int32_t u = 0;
  if (!beyond(target, free)) {
    const std::int32_t moved = span_ != 0 ? e : target - target_;
    const std::int32_t sign = -static_cast<std::int32_t>(word(before) >> 31U);
    u = between(before & sign, before & ~sign, moved);
  }
  target_ = target;
  const std::int32_t left = e - u;
  const std::int32_t most = rate;
  std::int32_t d = 0;
  std::uint32_t status = kAccelerationLimited;
  if (left >= 0) {
    const std::int32_t top = before + a < most ? before + a : most;
    d = u + stopping_step_below(top - u, a, left);
    if (d < before - a) d = before - a;
    if (d == most) status = kRateLimited;
  } else {
    const std::int32_t top = before - a > -most ? before - a : -most;
    d = u - stopping_step_below(u - top, a, -left);
    if (d > before + a) d = before + a;
    if (d == -most) status = kRateLimited;
  }
  step_ = d;
  offset_ += d;
  const std::int32_t lag = e - d;
  span_ = 0;
  if (lag == 0) {
    span_ = 2U * word(a) + 1U;
    status = 0;
  }
  if (VOLCOMP_UNLIKELY(beyond(lag, largest_lag_.own()))) largest_lag_.set(size(lag));
  return keep_largest(status);
}

// The change of the change has no bound.
VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::approach_free(std::int32_t target,
                                                                std::int32_t rate) {
  const std::int32_t e = target - offset_;
  step_ = between(-rate, rate, e);
  offset_ += step_;
  span_ = UINT32_MAX;
  const std::int32_t lag = size(e - step_);
  if (VOLCOMP_UNLIKELY(lag > largest_lag_.own())) largest_lag_.set(lag);
  return keep_largest(lag != 0 ? std::uint32_t{kRateLimited} : 0U);
}

}  // namespace volcomp
