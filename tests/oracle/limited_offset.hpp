#pragma once
// The definition of a limited offset, written for reading: sums and searches in 64 bits. Shares
// nothing with comp but the settings and the status bits.
//
// S_a(d): way to standstill of an offset that moves by d and then brakes by a per tick, the step d
// included. D_a(x): the largest step from which it can stop within x.

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "comp/tick/offset_limiter.hpp"

namespace volcomp::test {

using Int = std::int64_t;

inline Int way_of(Int d, Int a) {
  Int sum = 0;
  for (; d > 0; d -= a)
    sum += d;
  return sum;
}
// The way after the step d.
inline Int way_after(Int d, Int a) { return way_of(d - a, a); }

inline Int step_within(Int x, Int a) {
  Int d = 0;
  while (way_of(d + 1, a) <= x)
    ++d;
  return d;
}
// The same with n full steps of a below it: S(n·a) ≤ x < S((n + 1)·a).
inline Int step_within_by_division(Int x, Int a) {
  Int n = 0;
  while (a * (n + 1) * (n + 2) / 2 <= x)
    ++n;
  return (x + a * n * (n + 1) / 2) / (n + 1);
}

// Of two numbers with one sign the smaller in size, else 0.
inline Int smaller_of_one_sign(Int x, Int y) {
  if (x > 0 && y > 0) return std::min(x, y);
  if (x < 0 && y < 0) return std::max(x, y);
  return 0;
}

// Limits as a tick uses them.
struct UsedLimits {
  explicit UsedLimits(const OffsetLimits& l)
      : limit(l.limit),
        rate(l.rate),
        soft_rate(l.soft_rate),
        acceleration(2 * Int{l.rate}),
        followed(l.limit),
        none(l.acceleration == 0 || l.acceleration >= 2 * Int{l.rate}) {
    if (none) return;
    acceleration = l.acceleration;
    rate = std::min(rate, acceleration + step_within_by_division(limit / 2, acceleration));
    soft_rate = std::min(soft_rate, rate);
    const Int n = (rate + acceleration - 1) / acceleration;
    followed -= n * rate - acceleration * n * (n - 1) / 2 - rate;  // less the way after such a step
  }
  // Whether an offset that moves by d and stands at o can stop before the limit.
  [[nodiscard]] bool can_stop(Int o, Int d) const {
    if (std::abs(o) > limit) return false;
    if (none) return true;
    const Int left = std::abs(d) - acceleration;
    const Int n = left > 0 ? (left - 1) / acceleration + 1 : 0;
    const Int way = n * left - acceleration * n * (n - 1) / 2;
    return (d > 0 ? o : -o) + way <= limit;
  }

  Int limit;
  Int rate;
  Int soft_rate;
  Int acceleration;  // none: 2·rate
  Int followed;      // targets up to here are followed at their own speed
  bool none;
};

// Limits in force, and new ones that wait until the step of the offset fits into them.
class LimitsInForce {
 public:
  explicit LimitsInForce(const OffsetLimits& limits) : now_(limits), next_(limits) {}

  void change(const OffsetLimits& limits) {
    next_ = UsedLimits(limits);
    waiting_ = true;
  }
  void take() {
    now_ = next_;
    waiting_ = false;
  }
  // At the beginning of a tick. Whether they are taken in it.
  bool take_if_slow_enough(Int step) {
    const bool wider = next_.limit >= now_.limit && next_.rate >= now_.rate &&
                       next_.acceleration >= now_.acceleration;
    const bool slow = std::abs(step) <= std::min(next_.rate, next_.acceleration);
    if (!waiting_ || !(slow || wider || (next_.none && now_.none))) return false;
    take();
    return true;
  }
  [[nodiscard]] bool waiting() const { return waiting_; }
  [[nodiscard]] const UsedLimits& now() const { return now_; }
  [[nodiscard]] const UsedLimits& newest() const { return next_; }

 private:
  UsedLimits now_;
  UsedLimits next_;
  bool waiting_ = false;
};

class LimitedOffset {
 public:
  explicit LimitedOffset(const OffsetLimits& limits) : limits_(limits) {}

  void start(Int held) { put(held, 0, held); }
  // In the middle of things.
  void put(Int offset, Int step, Int target) {
    offset_ = offset;
    step_ = step;
    target_ = target;
    limits_.take();
  }
  void change(const OffsetLimits& limits) { limits_.change(limits); }

  std::uint32_t follow(Int target, bool soft) {
    Int moved = target - target_;
    if (limits_.take_if_slow_enough(step_)) moved = 0;
    if (limits_.waiting()) return brake();
    const UsedLimits& l = limits_.now();
    target_ = target;
    const Int rate = soft ? l.soft_rate : l.rate;
    const bool follows = !soft && !l.none && std::abs(target) <= l.followed;
    const Int u = follows ? smaller_of_one_sign(moved, step_) : 0;
    const Int left = target - offset_ - u;
    const Int size = std::abs(left);
    const Int reach = l.none ? size : step_within_by_division(size, l.acceleration);
    const Int wanted = std::clamp(u + (left < 0 ? -reach : reach), -rate, rate);
    const Int a = l.none ? std::abs(wanted - step_) : l.acceleration;
    step_ = std::clamp(wanted, step_ - a, step_ + a);
    offset_ += step_;
    if (offset_ == target) return outside();
    const bool fastest = l.none || (left < 0 ? -step_ : step_) == rate;
    return outside() | (fastest ? kRateLimited : kAccelerationLimited);
  }

  std::uint32_t hold() {
    limits_.take_if_slow_enough(step_);
    const std::uint32_t status = brake();
    return step_ != 0 ? status | kAccelerationLimited : status;
  }

  [[nodiscard]] Int offset() const { return offset_; }
  [[nodiscard]] Int step() const { return step_; }
  [[nodiscard]] const LimitsInForce& limits() const { return limits_; }

 private:
  std::uint32_t brake() {
    const Int a = limits_.now().none ? std::abs(step_) : limits_.now().acceleration;
    step_ -= std::clamp(step_, -a, a);
    offset_ += step_;
    target_ = offset_;
    return outside() | (limits_.waiting() ? kSettling : 0U);
  }
  [[nodiscard]] std::uint32_t outside() const {
    return std::abs(offset_) > limits_.now().limit ? kSettling : 0U;
  }

  LimitsInForce limits_;
  Int offset_ = 0;
  Int step_ = 0;
  Int target_ = 0;
};

// What is promised of every tick, judged from offsets alone: limit, rate and acceleration that are
// in force, whatever was wanted.
class LimitedPromise {
 public:
  LimitedPromise() : LimitedPromise(OffsetLimits{}) {}
  explicit LimitedPromise(const OffsetLimits& limits) : limits_(limits) {}

  void started(Int held) {
    offset_ = held;
    step_ = 0;
    limits_.take();
  }
  void changed(const OffsetLimits& limits) { limits_.change(limits); }

  // After a tick: what is broken, or nullptr.
  const char* broken_by(Int offset, bool soft = false) {
    const Int before = step_;
    const Int from = offset_;
    const bool were_free = limits_.now().none;  // of any bound on the change of the step
    limits_.take_if_slow_enough(step_);
    const UsedLimits& l = limits_.now();
    step_ = offset - offset_;
    offset_ = offset;
    if (!(were_free && l.none) && std::abs(step_ - before) > l.acceleration) return "acceleration";
    if (limits_.waiting()) {
      if (std::abs(step_) >= std::abs(before)) return "does not brake for new limits";
    } else {
      if (std::abs(step_) > l.rate) return "rate";
      const Int softest = std::max(l.soft_rate, std::abs(before) - l.acceleration);
      if (soft && std::abs(step_) > softest) return "soft rate";
    }
    if (std::abs(from) > l.limit)
      return std::abs(offset) > std::abs(from) ? "further beyond the limit" : nullptr;
    return l.can_stop(offset, step_) ? nullptr : "limit";
  }

  [[nodiscard]] Int offset() const { return offset_; }
  [[nodiscard]] Int step() const { return step_; }
  [[nodiscard]] const LimitsInForce& limits() const { return limits_; }

 private:
  LimitsInForce limits_;
  Int offset_ = 0;
  Int step_ = 0;
};

}  // namespace volcomp::test
