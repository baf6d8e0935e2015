// The limiter against its definition and its promises, in every state of a small range.

#include <gtest/gtest.h>

#include <string>

#include "tests/oracle/limited_offset.hpp"

namespace volcomp::test {
namespace {

#if defined(VOLCOMP_GTEST_SUBSET) || !defined(NDEBUG)
constexpr std::int32_t kMostLimit = 5;  // an emulated board, or an instrumented build
#else
constexpr std::int32_t kMostLimit = 12;
#endif
constexpr std::int32_t kMostRate = 6;
constexpr std::int32_t kMostAcceleration = 4;

OffsetLimiter<true> limiter_with(const OffsetLimits& limits) {
  OffsetLimiter<true> limiter;
  limiter.change(OffsetBounds(limits));
  limiter.start(0);
  return limiter;
}

template <class Visit>
void for_each_limits(std::int32_t most_limit, const Visit& visit) {
  for (std::int32_t limit = 1; limit <= most_limit; ++limit)
    for (std::int32_t rate = 1; rate <= kMostRate; ++rate)
      for (std::int32_t acceleration = 1; acceleration <= kMostAcceleration; ++acceleration)
        visit(OffsetLimits{limit, rate, (rate + 1) / 2, acceleration});
}

// visit(offset, step) for every state from which the offset can stop before the limit.
template <class Visit>
void for_each_safe_state(const UsedLimits& l, const Visit& visit) {
  for (Int d = -l.rate; d <= l.rate; ++d) {
    for (Int o = -l.limit; o <= l.limit; ++o) {
      if (l.can_stop(o, d)) visit(static_cast<std::int32_t>(o), static_cast<std::int32_t>(d));
    }
  }
}

std::string text_of(const OffsetLimits& l) {
  return "limit " + std::to_string(l.limit) + " rate " + std::to_string(l.rate) + " soft " +
         std::to_string(l.soft_rate) + " acceleration " + std::to_string(l.acceleration);
}

// One tick of the limiter and of its definition from the same state. Empty, or how they differ.
class EveryTick {
 public:
  explicit EveryTick(const OffsetLimits& limits)
      : limiter_(limiter_with(limits)), definition_(limits), limits_(limits) {}

  void from(std::int32_t offset, std::int32_t step, std::int32_t last, std::int32_t target,
            bool soft) {
    limiter_.resume(offset, step, last);
    definition_.put(offset, step, last);
    const std::uint32_t status = soft ? limiter_.follow_softly(target) : limiter_.follow(target);
    judge(status, definition_.follow(target, soft), offset, step, soft);
  }
  void held_from(std::int32_t offset, std::int32_t step) {
    limiter_.resume(offset, step, offset);
    definition_.put(offset, step, offset);
    const std::uint32_t status = limiter_.hold();
    judge(status, definition_.hold(), offset, step, false);
  }
  [[nodiscard]] const std::string& broken() const { return broken_; }
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }

 private:
  void judge(std::uint32_t status, std::uint32_t defined, Int offset, Int step, bool soft) {
    ++ticks_;
    const UsedLimits& l = definition_.limits().now();
    const Int d = limiter_.step();
    const Int most = soft ? l.soft_rate : l.rate;
    const bool same = limiter_.offset() == definition_.offset() && d == definition_.step() &&
                      limiter_.offset() == offset + d && status == defined;
    const bool kept = std::abs(d - step) <= l.acceleration &&
                      std::abs(d) <= std::max(most, std::abs(step) - l.acceleration) &&
                      l.can_stop(limiter_.offset(), d);
    if ((same && kept) || !broken_.empty()) return;
    broken_ = text_of(limits_) + ": offset " + std::to_string(offset) + " step " +
              std::to_string(step) + (soft ? " soft" : "") + " goes to " +
              std::to_string(limiter_.offset()) + ", defined " +
              std::to_string(definition_.offset()) + ", status " + std::to_string(status) +
              ", defined " + std::to_string(defined);
  }

  OffsetLimiter<true> limiter_;
  LimitedOffset definition_;
  OffsetLimits limits_;
  std::string broken_;
  std::int64_t ticks_ = 0;
};

TEST(OffsetDefinition, EveryStateTargetAndTargetBefore) {
  std::int64_t ticks = 0;
  for_each_limits(kMostLimit, [&](const OffsetLimits& limits) {
    EveryTick tick(limits);
    for_each_safe_state(UsedLimits(limits), [&](std::int32_t o, std::int32_t d) {
      for (std::int32_t last = -limits.limit; last <= limits.limit; ++last) {
        for (std::int32_t t = -limits.limit; t <= limits.limit; ++t) {
          tick.from(o, d, last, t, false);
          tick.from(o, d, last, t, true);
        }
      }
      tick.held_from(o, d);
    });
    EXPECT_EQ(tick.broken(), std::string());
    ticks += tick.ticks();
  });
  EXPECT_GT(ticks, kMostLimit == 12 ? 10'000'000 : 300'000);
}

// Without a bound on the acceleration, stated or not: clamp(target − offset).
TEST(OffsetDefinition, WithoutAccelerationItIsTheRateAlone) {
  for (std::int32_t rate = 1; rate <= kMostRate; ++rate) {
    for (std::int32_t acceleration = 0; acceleration <= 2 * rate + 5; ++acceleration) {
      if (acceleration != 0 && acceleration < 2 * rate) continue;
      OffsetLimiter<true> limiter = limiter_with({kMostLimit, rate, 1, acceleration});
      OffsetLimiter<false> rate_alone;
      rate_alone.change(OffsetBounds(OffsetLimits{kMostLimit, rate, 1, 0}));
      for (std::int32_t o = -kMostLimit; o <= kMostLimit; ++o) {
        for (std::int32_t t = -kMostLimit; t <= kMostLimit; ++t) {
          for (const bool soft : {false, true}) {
            const std::int32_t most = soft ? 1 : rate;
            limiter.resume(o, 0, o);
            rate_alone.start(o);
            const std::uint32_t status = soft ? limiter.follow_softly(t) : limiter.follow(t);
            ASSERT_EQ(soft ? rate_alone.follow_softly(t) : rate_alone.follow(t), status);
            ASSERT_EQ(limiter.offset(), std::clamp(t, o - most, o + most));
            ASSERT_EQ(rate_alone.offset(), limiter.offset());
            ASSERT_EQ(status, limiter.offset() == t ? 0U : std::uint32_t{kRateLimited});
            ASSERT_EQ(limiter.hold(), 0U);
            ASSERT_EQ(limiter.offset(), rate_alone.offset()) << "held, it stands";
          }
        }
      }
    }
  }
}

// --- new limits in every state

// Targets that provoke an offset which is to slow down.
std::int32_t provoking_target(int play, int tick, std::int32_t most, Int offset, Int step) {
  switch (play) {
    case 0:
      return most;
    case 1:
      return -most;
    case 2:
      return tick % 2 != 0 ? most : -most;
    case 3:
      return static_cast<std::int32_t>(std::clamp<Int>(offset + 2 * step, -most, most));
    default:
      return 0;  // held before
  }
}

// Empty, or what is broken.
std::string change_in_state(const OffsetLimits& from, const OffsetLimits& to, std::int32_t offset,
                            std::int32_t step, int play) {
  OffsetLimiter<true> limiter = limiter_with(from);
  limiter.resume(offset, step, offset);
  limiter.change(OffsetBounds(to));
  LimitedOffset definition(from);
  definition.put(offset, step, offset);
  definition.change(to);
  const Int before = UsedLimits(from).acceleration;
  const Int most_waiting = (std::abs(step) + before - 1) / before;
  Int waited = 0;
  for (int n = 0; n < 10; ++n) {
    const Int o = limiter.offset();
    const Int d = limiter.step();
    const bool hold = play == 4 && n < 2;
    const std::int32_t t = provoking_target(play, n, to.limit, o, d);
    const std::uint32_t status = hold ? limiter.hold() : limiter.follow(t);
    const std::uint32_t defined = hold ? definition.hold() : definition.follow(t, false);
    const UsedLimits& l = definition.limits().now();
    if (limiter.offset() != definition.offset() ||
        limiter.waiting() != definition.limits().waiting())
      return "not as defined";
    if (status != defined) return "status";
    if (limiter.waiting()) ++waited;
    if (std::abs(limiter.step() - d) > l.acceleration) return "acceleration";
    if (!limiter.waiting() && std::abs(limiter.step()) > l.rate) return "rate";
    if (limiter.waiting() && std::abs(limiter.step()) >= std::abs(d)) return "does not brake";
    if (std::abs(o) > l.limit) {
      if (std::abs(limiter.offset()) > std::abs(o)) return "further beyond the limit";
    } else if (!l.can_stop(limiter.offset(), limiter.step())) {
      return "limit";
    }
  }
  return waited <= most_waiting ? "" : "waits too long";
}

TEST(OffsetDefinition, EveryChangeOfLimitsInEveryState) {
  std::int64_t changes = 0;
  for (const std::int32_t limit : {std::int32_t{1}, std::int32_t{3}, kMostLimit}) {
    for (std::int32_t rate = 1; rate <= kMostRate; rate += 2) {
      for (std::int32_t acceleration = 1; acceleration <= kMostAcceleration; ++acceleration) {
        const OffsetLimits from{limit, rate, 1, acceleration};
        for_each_limits(4, [&](const OffsetLimits& next) {
          OffsetLimits to = next;
          if (to.limit == 4) to.limit = kMostLimit + 1;
          for_each_safe_state(UsedLimits(from), [&](std::int32_t o, std::int32_t d) {
            for (int play = 0; play < 5; ++play) {
              ASSERT_EQ(change_in_state(from, to, o, d, play), std::string())
                  << text_of(from) << " to " << text_of(to) << " offset " << o << " step " << d
                  << " play " << play;
              ++changes;
            }
          });
        });
      }
    }
  }
  EXPECT_GT(changes, 50'000);
}

}  // namespace
}  // namespace volcomp::test
