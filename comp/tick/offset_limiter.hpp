#pragma once
// The last step of a correction before its drive: |o| ≤ limit, |d| ≤ rate, |d − d before| ≤
// acceleration, where o is the offset and d its change per tick, whatever the targets are. Integers
// only, no root, every loop bounded; the same bits on every target.
//
// A tick takes the fastest step from which, seen from the moving target, the offset can still stop
// at it: a target at rest is reached in the least number of ticks, one that moves at a constant
// speed is followed without lag.
//
// One context calls follow() and hold(); everything else is called between two ticks.

#include "comp/core/inline.hpp"
#include "comp/core/published.hpp"
#include "comp/tick/limiter.hpp"
#include "comp/tick/offset_bounds.hpp"
#include "comp/tick/tick_types.hpp"

namespace volcomp {

// What follow() and hold() return: kRateLimited, kAccelerationLimited, and this: new bounds wait,
// or the offset is beyond its limit and on its way back.
inline constexpr std::uint32_t kSettling = 1U << 15U;

// Without acceleration: rate and limit alone, and nothing is kept for the rest.
template <bool kAccelerates>
class OffsetLimiter;

template <>
class OffsetLimiter<true> {
 public:
  static constexpr bool kAccelerates = true;
  using Settings = OffsetBounds;

  // The drive stands still at `held`, |held| ≤ kMostHeldOffset. Bounds that wait are taken.
  void start(std::int32_t held) { resume(held, 0, held); }
  // Goes on from another's offset, step and last target.
  [[gnu::cold]] void resume(std::int32_t offset, std::int32_t step, std::int32_t target);
  // From the next tick on, or as soon as the offset is slow enough for them. A later change
  // replaces one that waits.
  [[gnu::cold]] void change(const OffsetBounds& bounds);

  // --- interrupt; |target| ≤ the limit of the newest bounds

  // Reaches the target if it was reached in the last tick, too, and the bounds do not act. If not,
  // nothing has happened. False for every number beyond the limit.
  VOLCOMP_INLINE bool reach(std::int32_t target) {
    const std::uint32_t e = word(target) - word(offset_);
    // No bit pattern is less than a span of 0.
    if (VOLCOMP_UNLIKELY(e + word(now_.rate) > 2U * word(now_.rate) ||
                         e - word(step_) + word(now_.reach) >= now_.span))
      return false;
    if (VOLCOMP_UNLIKELY(beyond(target, now_.watch))) {
      const std::int32_t out = size(target);
      if (out > now_.most) return false;
      largest_.set(out);
      now_.watch = out;
    }
    step_ = static_cast<std::int32_t>(e);
    offset_ = target;
    return true;
  }
  // These return why offset() is not the target.
  std::uint32_t follow(std::int32_t target);
  // The same without the shortcut; while bounds wait it brakes, without looking at the target.
  std::uint32_t approach(std::int32_t target) { return approach(target, now_.rate, now_.free); }
  // At the soft rate.
  std::uint32_t follow_softly(std::int32_t target);
  // Comes to rest as soon as the acceleration allows.
  std::uint32_t hold();

  [[nodiscard]] std::int32_t offset() const { return offset_; }
  [[nodiscard]] std::int32_t step() const { return step_; }
  // Of the newest bounds.
  [[nodiscard]] std::int32_t limit() const { return next_.limit; }
  // Where the offset comes to rest if it brakes from now on.
  [[nodiscard]] VOLCOMP_INLINE std::int32_t standstill() const {
    return VOLCOMP_UNLIKELY(beyond(step_, now_.reach)) ? braked() : offset_;
  }
  [[nodiscard]] bool waiting() const { return mode_.get() == Mode::waiting; }

  // --- background

  // The newest bounds: in force, or waiting.
  [[nodiscard, gnu::cold]] Settings settings() const;
  // Unless bounds wait: whether those in force are the newest, and what the tick compares with
  // belongs to them.
  [[nodiscard, gnu::cold]] bool intact() const;
  // Largest |offset|, and largest |target − offset| that the bounds left at the end of a tick.
  [[nodiscard]] std::int32_t largest() const { return largest_.get(); }
  [[nodiscard]] std::int32_t largest_lag() const { return largest_lag_.get(); }

 private:
  enum class Mode : std::uint32_t {
    bounded,
    free,     // the change of the change has no bound
    waiting,  // for bounds
  };

  // No target is within: none is followed at its own speed.
  static constexpr std::int32_t kNoneFree = INT32_MIN;

  static constexpr std::uint32_t word(std::int32_t x) { return static_cast<std::uint32_t>(x); }
  static constexpr std::int32_t size(std::int32_t x) { return x < 0 ? -x : x; }
  static constexpr bool beyond(std::int32_t x, std::int32_t most) {
    return word(x) + word(most) > 2U * word(most);
  }

  std::uint32_t approach(std::int32_t target, std::int32_t rate, std::int32_t free);
  std::uint32_t approach_waiting(std::int32_t target, bool softly);
  std::uint32_t approach_free(std::int32_t target, std::int32_t rate);
  std::uint32_t brake();
  // Faster than one step of the acceleration: S(|step| − a) further on.
  [[nodiscard]] VOLCOMP_INLINE std::int32_t braked() const {
    const std::uint32_t a = word(now_.reach);
    const std::uint32_t d = word(size(step_)) - a;
    const std::uint32_t n = (d - 1U) / a;
    const std::uint32_t way = (n + 1U) * d - a * ((n + 1U) * n / 2U);
    return static_cast<std::int32_t>(step_ < 0 ? word(offset_) - way : word(offset_) + way);
  }
  // All of a `reach` without bound.
  [[nodiscard]] std::uint32_t span_at_target() const { return 2U * word(now_.reach) + 1U; }
  [[nodiscard]] bool may_take_bounds() const;
  void take_bounds();
  void prepare();
  std::uint32_t keep_largest(std::uint32_t status);

  // Bounds as a tick compares with them.
  struct InForce {
    std::int32_t reach = 0;  // −reach ≤ change of the step < span − reach: reached at once
    std::uint32_t span = 0;  // 0: nothing is
    std::int32_t rate = 0;
    std::int32_t watch = 0;  // the largest offset, or `most`: further out is not usual
    std::int32_t most = 0;   // up to here targets are followed at their own speed and not clamped
    std::int32_t free = 0;   // targets within are followed at their own speed, if bounded
    std::int32_t soft_rate = 0;
    std::int32_t limit = 0;

    constexpr InForce() = default;
    // As taken: nothing is reached yet, no offset has been larger than `most`.
    constexpr explicit InForce(const OffsetBounds& b);
    // Before any are stated: no offset but 0 is usual, and nothing is followed.
    static constexpr InForce unstated() {
      InForce none;
      none.reach = INT32_MAX;
      none.span = UINT32_MAX;
      none.rate = 1;
      none.free = kNoneFree;
      return none;
    }

    // The change of the change has no bound.
    [[nodiscard]] constexpr bool none() const { return reach == INT32_MAX; }
    [[nodiscard]] constexpr bool same_bounds(const InForce& other) const;
    [[nodiscard]] constexpr bool contained_in(const OffsetBounds& next) const;
  };

  // what reach() reads and writes comes first
  std::int32_t offset_ = 0;
  std::int32_t step_ = 0;
  InForce now_ = InForce::unstated();

  std::int32_t lag_ = 0;               // target − offset of the last tick, if bounded
  Published<Mode> mode_ = Mode::free;  // released after now_
  Published<std::int32_t> largest_ = 0;
  Published<std::int32_t> largest_lag_ = 0;
  InForce next_{};                // of the newest bounds
  std::int32_t slow_enough_ = 0;  // they are taken at steps of at most this
};

template <>
class OffsetLimiter<false> {
 public:
  static constexpr bool kAccelerates = false;
  struct Settings {
    std::int32_t rate = 1;
    std::int32_t soft_rate = 1;
    std::int32_t limit = 0;
  };

  void start(std::int32_t held) { offset_ = held; }
  // From the next tick on.
  void change(const OffsetBounds& bounds) {
    set_ = {bounds.rate, bounds.soft_rate, bounds.limit};
    watch_ = watched();
  }

  VOLCOMP_INLINE bool reach(std::int32_t target) {
    if (VOLCOMP_UNLIKELY(further(target, offset_, set_.rate))) return false;
    if (VOLCOMP_UNLIKELY(further(target, 0, watch_))) {
      const std::int32_t out = target < 0 ? -target : target;
      if (out >= set_.limit) return false;
      largest_.set(out);
      watch_ = out;
    }
    offset_ = target;
    return true;
  }
  std::uint32_t follow(std::int32_t target) { return slew(target, set_.rate); }
  std::uint32_t approach(std::int32_t target) { return slew(target, set_.rate); }
  std::uint32_t follow_softly(std::int32_t target) { return slew(target, set_.soft_rate); }
  std::uint32_t hold() { return slew(offset_, set_.rate); }

  [[nodiscard]] std::int32_t offset() const { return offset_; }
  [[nodiscard]] std::int32_t standstill() const { return offset_; }
  [[nodiscard]] std::int32_t limit() const { return set_.limit; }
  [[nodiscard]] const Settings& settings() const { return set_; }
  [[nodiscard]] static bool intact() { return true; }
  [[nodiscard]] std::int32_t largest() const { return largest_.get(); }
  [[nodiscard]] static std::int32_t largest_lag() { return 0; }  // not kept

 private:
  // The largest offset, but less than the limit: targets there are clamped.
  [[nodiscard]] std::int32_t watched() const {
    return largest_.own() < set_.limit ? largest_.own() : set_.limit - 1;
  }
  [[gnu::noinline]] std::uint32_t slew(std::int32_t target, std::int32_t rate) {
    std::uint32_t status = 0;
    if (further(target, offset_, rate)) {
      target = target < offset_ ? offset_ - rate : offset_ + rate;
      status = kRateLimited;
    }
    offset_ = target;
    const std::int32_t out = target < 0 ? -target : target;
    if (out > largest_.own()) {
      largest_.set(out);
      watch_ = watched();
    }
    return out > set_.limit ? status | kSettling : status;
  }

  std::int32_t offset_ = 0;
  Settings set_{};
  std::int32_t watch_ = 0;
  Published<std::int32_t> largest_ = 0;
};

}  // namespace volcomp
