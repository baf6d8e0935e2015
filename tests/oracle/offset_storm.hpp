#pragma once
// A limiter in a storm: targets meant to break its promises, limits of every size that change in
// motion, soft ticks, holds and restarts. Every tick is judged, every 16th compared with the
// definition.

#include <string>

#include "tests/oracle/limited_offset.hpp"

namespace volcomp::test {

// xorshift64: 10^9 ticks are to take a minute.
class QuickRandom {
 public:
  explicit QuickRandom(std::uint64_t seed) : state_(seed * 2 + 1) {}

  std::uint32_t bits() {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 7U;
    state_ ^= state_ << 17U;
    return static_cast<std::uint32_t>(state_ >> 32U);
  }
  // 0…n − 1
  std::int32_t below(Int n) {
    return static_cast<std::int32_t>((std::uint64_t{bits()} * static_cast<std::uint64_t>(n)) >>
                                     32U);
  }
  bool once_in(Int n) { return below(n) == 0; }
  std::int32_t within(Int most) { return static_cast<std::int32_t>(below(2 * most + 1) - most); }
  // 1…most, of every length in bits alike.
  std::int32_t any_size(std::int32_t most) {
    int lengths = 1;
    while (lengths < 30 && (Int{1} << lengths) <= most)
      ++lengths;
    const Int top = Int{1} << (1 + below(lengths));
    return 1 + below(std::min<Int>(top, most));
  }

 private:
  std::uint64_t state_;
};

inline OffsetLimits any_limits(QuickRandom& random) {
  OffsetLimits l;
  l.limit = random.any_size(kMostOffsetLimit);
  l.rate = random.any_size(random.once_in(8) ? kMostOffsetRate : 1 << 22);
  l.soft_rate = random.any_size(l.rate);
  const std::int32_t most = std::min(kMostOffsetAcceleration, l.rate);
  l.acceleration = random.once_in(6) ? 0 : random.any_size(most);
  return l;
}

// Some of them narrower.
inline OffsetLimits changed_limits(const OffsetLimits& limits, QuickRandom& random) {
  OffsetLimits l = random.once_in(2) ? any_limits(random) : limits;
  if (random.once_in(2)) l.limit = 1 + random.below(l.limit);
  if (random.once_in(2)) l.rate = 1 + random.below(l.rate);
  const bool none = l.acceleration == 0;
  if (random.once_in(2))
    l.acceleration = none ? random.any_size(std::min<std::int32_t>(l.rate, 1 << 20))
                          : 1 + random.below(l.acceleration);
  l.soft_rate = std::min(l.soft_rate, l.rate);
  return l;
}

// Where a target goes: a while in one manner, then in another.
class HostileTargets {
 public:
  static constexpr int kManners = 9;

  void begin(Int target) { target_ = target; }
  void next_manner(Int rate, QuickRandom& random) {
    manner_ = random.below(kManners);
    speed_ = random.within(std::min<Int>(rate, kMostOffsetLimit));
  }
  std::int32_t next(Int offset, Int step, Int limit, QuickRandom& random) {
    switch (manner_) {
      case 0:  // stands
        break;
      case 1:
        target_ += speed_;
        break;
      case 2:
        target_ += speed_ + random.within(2);
        break;
      case 3:
        target_ = random.within(limit);
        break;
      case 4:  // from end to end
        target_ = target_ > 0 ? -limit : limit;
        break;
      case 5:  // ahead of the offset
        target_ = offset + 3 * step;
        break;
      case 6:  // away from it
        target_ = step >= 0 ? limit : -limit;
        break;
      case 7:  // around it
        target_ = offset + random.within(3) * step + random.within(4);
        break;
      default:  // jumps now and then
        if (random.once_in(20)) target_ = random.within(limit);
    }
    target_ = std::clamp(target_, -limit, limit);
    return static_cast<std::int32_t>(target_);
  }

 private:
  int manner_ = 0;
  Int speed_ = 0;
  Int target_ = 0;
};

struct StormCounts {
  std::uint64_t ticks = 0;
  std::uint64_t limited = 0;   // by rate or acceleration
  std::uint64_t changes = 0;   // of limits
  std::uint64_t waiting = 0;   // ticks
  std::uint64_t outside = 0;   // ticks that began beyond the limit
  std::uint64_t compared = 0;  // with the definition
};

template <class Limiter>
class OffsetStorm {
 public:
  explicit OffsetStorm(std::uint64_t seed) : random_(seed) {}

  // Ends at the first tick that breaks something.
  bool run(std::uint64_t ticks) {
    while (counts_.ticks < ticks && broken_.empty()) {
      begin_epoch();
      const std::uint64_t end = std::min(ticks, counts_.ticks + kEpoch);
      while (counts_.ticks < end && broken_.empty()) {
        something_happens();
        tick();
      }
    }
    return broken_.empty();
  }
  [[nodiscard]] const StormCounts& counts() const { return counts_; }
  // What, when and where.
  [[nodiscard]] const std::string& broken() const { return broken_; }

 private:
  static constexpr std::uint64_t kEpoch = 3'000;

  void begin_epoch() {
    limits_ = any_limits(random_);
    if (!Limiter::kAccelerates) limits_.acceleration = 0;
    limiter_ = Limiter{};
    limiter_.change(OffsetBounds(limits_));
    promise_ = LimitedPromise(limits_);
    steady_ = random_.once_in(3);
    start(random_.once_in(3) ? limits_.limit : 0);
    if (random_.once_in(20)) start(kMostHeldOffset);
  }
  void start(std::int32_t most) {
    const std::int32_t held = random_.within(most);
    limiter_.start(held);
    promise_.started(held);
    targets_.begin(held);
    last_target_ = held;
  }
  void something_happens() {
    if (random_.once_in(60)) targets_.next_manner(promise_.limits().now().rate, random_);
    if (random_.once_in(5'000)) start(limits_.limit);
    if (steady_ || !random_.once_in(400)) return;
    OffsetLimits next = changed_limits(limits_, random_);
    if (!Limiter::kAccelerates) next.acceleration = 0;
    if (refused_field(next) != nullptr) return;
    limits_ = next;
    limiter_.change(OffsetBounds(limits_));
    promise_.changed(limits_);
    ++counts_.changes;
  }

  void tick() {
    const Int offset = promise_.offset();
    const Int step = promise_.step();
    const bool waited = promise_.limits().waiting();
    const std::int32_t target = targets_.next(offset, step, limits_.limit, random_);
    const bool soft = random_.once_in(50);
    const bool hold = random_.once_in(40);
    const std::uint32_t status = hold   ? limiter_.hold()
                                 : soft ? limiter_.follow_softly(target)
                                        : limiter_.follow(target);
    ++counts_.ticks;
    judge(promise_.broken_by(limiter_.offset(), soft && !hold));
    const LimitsInForce& now = promise_.limits();
    const bool outside = std::abs(Int{limiter_.offset()}) > now.now().limit;
    const bool settles = now.waiting() || outside;
    const bool says_so = (status & kSettling) != 0;
    if (settles != says_so && (Limiter::kAccelerates || !hold)) judge("does not show settling");
    if (!hold && !waited && counts_.ticks % 16 == 0) compare(offset, step, target, soft, status);
    last_target_ = hold || now.waiting() ? limiter_.offset() : target;
    if ((status & (kRateLimited | kAccelerationLimited)) != 0) ++counts_.limited;
    if (now.waiting()) ++counts_.waiting;
    if (std::abs(offset) > now.now().limit) ++counts_.outside;
  }
  void compare(Int offset, Int step, std::int32_t target, bool soft, std::uint32_t status) {
    LimitedOffset definition(limits_);
    definition.put(offset, step, last_target_);
    const std::uint32_t defined = definition.follow(target, soft);
    ++counts_.compared;
    if (definition.offset() != limiter_.offset()) judge("is not where it is defined to be");
    if (defined != status) judge("status");
  }
  void judge(const char* broken) {
    if (broken == nullptr || !broken_.empty()) return;
    const auto text = [](Int n) { return std::to_string(n) + ' '; };
    const UsedLimits& l = promise_.limits().now();
    broken_ = std::string(broken) + ": tick " + std::to_string(counts_.ticks) + " limit " +
              text(l.limit) + "rate " + text(l.rate) + "soft " + text(l.soft_rate) +
              "acceleration " + text(l.acceleration) + "offset " + text(promise_.offset()) +
              "after a step of " + text(promise_.step());
  }

  QuickRandom random_;
  Limiter limiter_;
  LimitedPromise promise_;
  HostileTargets targets_;
  OffsetLimits limits_{};
  bool steady_ = false;  // no change of limits in this epoch
  Int last_target_ = 0;
  StormCounts counts_;
  std::string broken_;
};

}  // namespace volcomp::test
