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

constexpr OffsetLimiter<true>::InForce::InForce(const OffsetBounds& b)
    : reach(b.none() ? INT32_MAX : b.acceleration),
      rate(b.rate),
      watch(b.free < b.limit ? b.free : b.limit - 1),
      most(watch),
      free(b.none() ? kNoneFree : b.free),
      soft_rate(b.soft_rate),
      limit(b.limit) {}

constexpr bool OffsetLimiter<true>::InForce::same_bounds(const InForce& other) const {
  return reach == other.reach && rate == other.rate && most == other.most && free == other.free &&
         soft_rate == other.soft_rate && limit == other.limit;
}

OffsetBounds OffsetLimiter<true>::settings() const {
  OffsetBounds b;
  b.rate = next_.rate;
  b.free = next_.none() ? next_.limit : next_.free;
  b.soft_rate = next_.soft_rate;
  b.acceleration = next_.none() ? 2 * next_.rate : next_.reach;
  b.limit = next_.limit;
  return b;
}

// A state that is safe within those in force is safe within `next`.
constexpr bool OffsetLimiter<true>::InForce::contained_in(const OffsetBounds& next) const {
  if (next.limit < limit || next.rate < rate) return none() && next.none();
  return none() ? next.none() : next.acceleration >= reach;
}

void OffsetLimiter<true>::resume(std::int32_t offset, std::int32_t step, std::int32_t target) {
  if (waiting()) take_bounds();
  offset_ = offset;
  step_ = step;
  lag_ = target - offset;
  now_.span = now_.none() || lag_ == 0 ? span_at_target() : 0U;
}

void OffsetLimiter<true>::change(const OffsetBounds& bounds) {
  slow_enough_ = bounds.rate < bounds.acceleration ? bounds.rate : bounds.acceleration;
  if (now_.contained_in(bounds)) slow_enough_ = INT32_MAX;
  next_ = InForce(bounds);
  now_.span = 0;
  now_.free = kNoneFree;
  mode_.set(Mode::waiting);
}

bool OffsetLimiter<true>::intact() const {
  if (waiting()) return true;  // a tick in the middle of this may take them: judged afterwards
  return now_.same_bounds(next_) && now_.watch <= now_.most;
}

// Keeps the largest offset. Adds that it is beyond the limit.
VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::keep_largest(std::uint32_t status) {
  if (!beyond(offset_, now_.watch)) return status;
  const std::int32_t out = size(offset_);
  if (out > largest_.own()) {
    largest_.set(out);
    now_.watch = out < now_.most ? out : now_.most;
  }
  return out > now_.limit ? status | kSettling : status;
}

bool OffsetLimiter<true>::may_take_bounds() const { return size(step_) <= slow_enough_; }

void OffsetLimiter<true>::take_bounds() {
  now_ = next_;
  if (largest_.own() < now_.watch) now_.watch = largest_.own();
  mode_.release(now_.none() ? Mode::free : Mode::bounded);
}

std::uint32_t OffsetLimiter<true>::brake() {
  step_ -= between(-now_.reach, now_.reach, step_);
  offset_ += step_;
  lag_ = 0;
  now_.span = span_at_target();
  if (!waiting()) return keep_largest(0);
  now_.span = 0;
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
  return approach(target, now_.soft_rate, kNoneFree);
}

// Where bounds wait.
std::uint32_t OffsetLimiter<true>::approach_waiting(std::int32_t target, bool softly) {
  if (!may_take_bounds()) return brake();
  take_bounds();
  lag_ = target - offset_;  // not taken to move
  return softly ? approach(target, now_.soft_rate, kNoneFree) : approach(target);
}

std::uint32_t OffsetLimiter<true>::approach(std::int32_t target, std::int32_t rate,
                                            std::int32_t free) {
  const std::int32_t a = now_.reach;
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
  if (lag == 0) {
    now_.span = span_at_target();
    status = 0;
  } else {
    now_.span = 0;
    if (size(lag) > largest_lag_.own()) largest_lag_.set(size(lag));
  }
  return keep_largest(status);
}

// The change of the change has no bound.
VOLCOMP_INLINE std::uint32_t OffsetLimiter<true>::approach_free(std::int32_t target,
                                                                std::int32_t rate) {
  const std::int32_t e = target - offset_;
  step_ = between(-rate, rate, e);
  offset_ += step_;
  now_.span = UINT32_MAX;
  const std::int32_t lag = size(e - step_);
  if (VOLCOMP_UNLIKELY(lag > largest_lag_.own())) largest_lag_.set(lag);
  return keep_largest(lag != 0 ? std::uint32_t{kRateLimited} : 0U);
}

}  // namespace volcomp
