#include "comp/tick/offset_limiter.hpp"

namespace volcomp {
namespace {

constexpr std::uint32_t word(std::int32_t x) { return static_cast<std::uint32_t>(x); }

// Two selections, no branch: low ≤ high.
constexpr std::int32_t between(std::int32_t low, std::int32_t high, std::int32_t x) {
  const std::int32_t raised = x < low ? low : x;
  return raised > high ? high : raised;
}

// Of one sign: the smaller in size. Else 0.
VOLCOMP_INLINE std::int32_t smaller(std::int32_t x, std::int32_t y) {
  const std::int32_t sign = -static_cast<std::int32_t>(word(y) >> 31U);
  return between(y & sign, y & ~sign, x);
}

// The largest r ≤ most, as far as r ≥ most − 2a, from which stopping within x is possible; x ≥ 0.
// n full steps of a lie below r; at most two shorter n are tried (design of the limiter, section
// 3).
VOLCOMP_INLINE std::int32_t stopping_step_below(std::int32_t most, std::int32_t a, std::int32_t x) {
  if (most <= 0) return most;
  const std::uint32_t u = word(a);
  std::uint32_t n = (word(most) - 1U) / u;
  const std::uint32_t way = u * (n * (n + 1U) / 2U);  // S(n·a)
  std::uint32_t sum = word(x) + way;
  if ((n + 1U) * word(most) <= sum) return most;  // S(most) = (n + 1)·most − way
  if (word(x) >= way) return static_cast<std::int32_t>(sum / (n + 1U));
  const std::uint32_t lower = u * n;
  sum -= lower;
  if (word(x) + lower < way) {
    sum -= lower - u;
    --n;
  }
  return static_cast<std::int32_t>(sum / n);
}

}  // namespace

void OffsetLimiter<true>::resume(std::int32_t offset, std::int32_t step, std::int32_t target) {
  if (waiting()) take_bounds();
  offset_ = offset;
  step_ = step;
  lag_ = target - offset;
  prepare();
}

void OffsetLimiter<true>::change(const OffsetBounds& bounds) {
  next_ = bounds;
  slow_enough_ = next_.rate < next_.acceleration ? next_.rate : next_.acceleration;
  if (next_.contain(bounds_) || (next_.none() && bounds_.none())) slow_enough_ = INT32_MAX;
  mode_.set(Mode::waiting);
  prepare();
}

std::int32_t OffsetLimiter<true>::unclamped() const {
  return bounds_.free < bounds_.limit ? bounds_.free : bounds_.limit - 1;
}

// What reach() compares with: in force, and nothing reached yet.
VOLCOMP_INLINE void OffsetLimiter<true>::derive() {
  const bool none = bounds_.none();
  rate_ = bounds_.rate;
  most_ = unclamped();
  watch_ = largest_.own() < most_ ? largest_.own() : most_;
  reach_ = none ? INT32_MAX : bounds_.acceleration;
  free_ = none ? kNoneFree : bounds_.free;
  span_ = 0;
}

// The same, whatever is in force or waits.
void OffsetLimiter<true>::prepare() {
  derive();
  if (waiting()) {
    free_ = kNoneFree;
  } else if (bounds_.none()) {
    span_ = UINT32_MAX;
  } else if (lag_ == 0) {
    span_ = 2U * word(bounds_.acceleration) + 1U;
  }
}

bool OffsetLimiter<true>::intact() const {
  if (waiting()) return true;  // a tick in the middle of this may take them: judged afterwards
  const OffsetBounds& b = bounds_;
  return b == next_ && rate_ == b.rate && most_ == unclamped() && watch_ <= most_ &&
         reach_ == (b.none() ? INT32_MAX : b.acceleration) &&
         free_ == (b.none() ? kNoneFree : b.free);
}

// Keeps the largest offset. Adds that it is beyond the limit.
VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::keep_largest(std::uint32_t status) {
  return VOLCOMP_UNLIKELY(beyond(offset_, watch_)) ? keep_unusual(status) : status;
}

VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::keep_unusual(std::uint32_t status) {
  const std::int32_t out = size(offset_);
  if (out > largest_.own()) {
    largest_.set(out);
    watch_ = out < most_ ? out : most_;
  }
  return out > bounds_.limit ? status | kSettling : status;
}

bool OffsetLimiter<true>::may_take_bounds() const { return size(step_) <= slow_enough_; }

void OffsetLimiter<true>::take_bounds() {
  bounds_ = next_;
  mode_.release(bounds_.none() ? Mode::free : Mode::bounded);
  derive();
}

std::uint32_t OffsetLimiter<true>::brake() {
  step_ -= between(-reach_, reach_, step_);
  offset_ += step_;
  lag_ = 0;
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

std::uint32_t OffsetLimiter<true>::follow(std::int32_t target) {
  if (VOLCOMP_UNLIKELY(waiting())) return approach_waiting(target, false);
  return reach(target) ? 0U : approach(target);
}

std::uint32_t OffsetLimiter<true>::follow_softly(std::int32_t target) {
  if (VOLCOMP_UNLIKELY(waiting())) return approach_waiting(target, true);
  return approach(target, bounds_.soft_rate, kNoneFree);
}

// Where bounds wait.
std::uint32_t OffsetLimiter<true>::approach_waiting(std::int32_t target, bool softly) {
  if (!may_take_bounds()) return brake();
  take_bounds();
  lag_ = target - offset_;  // not taken to move
  return softly ? approach(target, bounds_.soft_rate, kNoneFree) : approach(target);
}

std::uint32_t OffsetLimiter<true>::approach(std::int32_t target, std::int32_t rate,
                                            std::int32_t free) {
  const std::int32_t a = reach_;
  const std::int32_t before = step_;
  const std::int32_t e = target - offset_;
  // How fast the target is taken to move: as it did, but not beyond what the offset does.
  std::int32_t u = 0;
  if (!beyond(target, free)) {
    u = smaller(e - lag_, before);
  } else if (VOLCOMP_UNLIKELY(mode_.own() != Mode::bounded)) {
    return waiting() ? brake() : approach_free(target, rate);
  }
  const std::int32_t left = e - u;
  std::int32_t d = 0;
  std::uint32_t status = kAccelerationLimited;
  if (left >= 0) {
    const std::int32_t top = before + a < rate ? before + a : rate;
    d = u + stopping_step_below(top - u, a, left);
    if (d < before - a) d = before - a;
    if (d == rate) status = kRateLimited;
  } else {
    const std::int32_t top = before - a > -rate ? before - a : -rate;
    d = u - stopping_step_below(u - top, a, -left);
    if (d > before + a) d = before + a;
    if (d == -rate) status = kRateLimited;
  }
  step_ = d;
  offset_ += d;
  const std::int32_t lag = e - d;
  lag_ = lag;
  span_ = 0;
  if (VOLCOMP_UNLIKELY(lag == 0)) {
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
