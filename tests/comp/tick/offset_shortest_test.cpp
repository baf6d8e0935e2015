// How soon an offset is at its target: against the shortest of all sequences that rate and
// acceleration allow, and behind a target that moves.

#include <gtest/gtest.h>

#include <vector>

#include "tests/oracle/limited_offset.hpp"

namespace volcomp::test {
namespace {

OffsetLimiter<true> limiter_with(std::int32_t rate, std::int32_t acceleration) {
  OffsetLimiter<true> limiter;
  limiter.change(OffsetBounds(OffsetLimits{4'000'000, rate, 1, acceleration}));
  limiter.start(0);
  return limiter;
}

// Ticks until an offset that moves by `step` is at a target that is `way` away and stays there, by
// breadth-first search from the end; it may pass the target or not.
class ShortestTimes {
 public:
  ShortestTimes(int rate, int acceleration)
      : rate_(rate),
        acceleration_(acceleration),
        times_(static_cast<std::size_t>(kWays) * static_cast<std::size_t>(2 * rate + 1), -1) {
    for (int d = -std::min(rate, acceleration); d <= std::min(rate, acceleration); ++d) {
      time(0, d) = 0;  // the next step may be 0
      border_.push_back({0, d});
    }
    for (int ticks = 1; !border_.empty(); ++ticks)
      step_back(ticks);
  }
  [[nodiscard]] int operator()(int way, int step) { return time(way, step); }

 private:
  struct State {
    int way;
    int step;
  };
  static constexpr int kMostWay = 320;
  static constexpr int kWays = 2 * kMostWay + 1;

  [[nodiscard]] int steps() const { return 2 * rate_ + 1; }
  int& time(int way, int step) {
    const int at = (way + kMostWay) * steps() + step + rate_;
    return times_[static_cast<std::size_t>(at)];
  }
  // States from which one tick leads to those found last.
  void step_back(int ticks) {
    std::vector<State> found;
    for (const State& to : border_) {
      const int way = to.way + to.step;
      if (std::abs(way) > kMostWay) continue;
      const int least = std::max(-rate_, to.step - acceleration_);
      const int most = std::min(rate_, to.step + acceleration_);
      for (int d = least; d <= most; ++d) {
        if (time(way, d) >= 0) continue;
        time(way, d) = ticks;
        found.push_back({way, d});
      }
    }
    border_ = std::move(found);
  }

  int rate_;
  int acceleration_;
  std::vector<int> times_;
  std::vector<State> border_;
};

// Ticks until the limiter is at the target for good; -1 if it passes it twice or leaves it again.
int ticks_to(OffsetLimiter<true>& limiter, int target, int step, int acceleration) {
  limiter.resume(0, step, target);
  int passed = 0;
  int before = target;
  for (int n = 0; n < 1'000; ++n) {
    if (limiter.offset() == target && std::abs(limiter.step()) <= acceleration) {
      for (int k = 0; k < 3; ++k) {
        if (limiter.follow(target) != 0 || limiter.offset() != target) return -1;
      }
      return passed <= 1 ? n : -1;
    }
    limiter.follow(target);
    const int left = target - limiter.offset();
    if (left != 0 && (left < 0) != (before < 0)) ++passed;
    if (left != 0) before = left;
  }
  return -1;
}

TEST(OffsetShortest, AConstantTargetIsReachedInTheLeastNumberOfTicks) {
  int states = 0;
  for (int rate = 1; rate <= 12; ++rate) {
    for (int acceleration = 1; acceleration <= 6; ++acceleration) {
      ShortestTimes shortest(rate, acceleration);
      OffsetLimiter<true> limiter = limiter_with(rate, acceleration);
      for (int way = -100; way <= 100; ++way) {
        for (int step = -rate; step <= rate; ++step) {
          ASSERT_GE(shortest(way, step), 0);
          ASSERT_EQ(ticks_to(limiter, way, step, acceleration), shortest(way, step))
              << "rate " << rate << " acceleration " << acceleration << " way " << way << " step "
              << step;
          ++states;
        }
      }
    }
  }
  EXPECT_EQ(states, 202'608);
}

// A speed of p/q per tick, rounded to integers, below the rate: after some ticks the offset is the
// target in every one.
TEST(OffsetShortest, AMovingTargetIsFollowedWithoutLag) {
  constexpr int kTicks = 500;
  for (int rate = 2; rate <= 10; rate += 2) {
    for (int acceleration = 1; acceleration <= 6; ++acceleration) {
      OffsetLimiter<true> limiter = limiter_with(rate, acceleration);
      for (const int q : {1, 2, 3, 7}) {
        for (int p = -(rate - 1) * q; p <= (rate - 1) * q; ++p) {
          for (int ahead = -30; ahead <= 30; ahead += 15) {
            limiter.resume(0, p < 0 ? rate : -rate, ahead);
            int last_behind = 0;
            for (int k = 1; k <= kTicks; ++k) {
              const int target = ahead + (p * k + kTicks * rate * q) / q - kTicks * rate;
              limiter.follow(target);
              if (limiter.offset() != target) last_behind = k;
            }
            ASSERT_LT(last_behind, kTicks - 100)
                << "rate " << rate << " acceleration " << acceleration << " speed " << p << '/' << q
                << " ahead " << ahead;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace volcomp::test
