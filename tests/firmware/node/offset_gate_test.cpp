// The promise of the offset gate by brute force: a drive that takes any value that can be under
// way, and reports that can get lost, late and out of order.

#include <cstdlib>
#include <deque>
#include <vector>

#include "firmware/node/offset_gate.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::node {
namespace {

using test::Random;

constexpr int kCycles = test::kManyPoints / 10;

GateBounds bounds_of(std::int32_t slew, std::uint8_t late, bool reports) {
  GateBounds bounds;
  bounds.slew = slew;
  bounds.late = late;
  bounds.reports = reports ? std::uint8_t{1} : std::uint8_t{0};
  return bounds;
}

// Values on their way, each with the cycle it arrives in.
class Wire {
 public:
  void send(std::int32_t value, std::int64_t arrives) { under_way_.push_back({value, arrives}); }
  void cut() { under_way_.clear(); }

  // What arrives in this cycle, in any order.
  std::vector<std::int32_t> arriving(std::int64_t cycle, Random& random) {
    std::vector<std::int32_t> values;
    for (std::size_t i = 0; i < under_way_.size();) {
      if (under_way_[i].arrives != cycle) {
        ++i;
        continue;
      }
      const auto place = values.begin() + random.integer(0, std::int64_t(values.size()));
      values.insert(place, under_way_[i].value);
      under_way_.erase(under_way_.begin() + std::ptrdiff_t(i));
    }
    return values;
  }

 private:
  struct Value {
    std::int32_t value;
    std::int64_t arrives;
  };
  std::vector<Value> under_way_;
};

struct Trouble {
  double lost = 0.0;     // of the offsets and of the reports
  double twice = 0.0;    // the copy has a delay of its own
  double delayed = 0.0;  // by 1…late cycles
  double restart = 0.0;  // of the drive or of the gate, per cycle
  double refused = 0.0;  // offsets the port does not take, per cycle; 100 cycles in a row
};

// One gate and one drive, cycle by cycle.
class Pair {
 public:
  Pair(std::int32_t slew, std::uint8_t late, const Trouble& trouble, Random& random)
      : Pair(bounds_of(slew, late, true), trouble, random) {}
  Pair(const GateBounds& bounds, const Trouble& trouble, Random& random)
      : late_(bounds.late), trouble_(trouble), random_(random) {
    gate_.configure(bounds);
  }

  void cycle(std::int32_t wanted) {
    ++cycle_;
    if (random_.chance(trouble_.restart)) restart();
    if (absent_ > 0) {
      --absent_;
      static_cast<void>(offsets_.arriving(cycle_, random_));
    } else {
      take();
      send(reports_, held_, cycle_);
    }
    const std::vector<std::int32_t> reports = reports_.arriving(cycle_, random_);
    // Some that are late come when the cycle has been computed: they count for the next.
    const auto all = std::int64_t(reports.size());
    const auto early = std::size_t(trouble_.delayed > 0.0 ? random_.integer(0, all) : all);
    for (std::size_t i = 0; i < early; ++i)
      gate_.report(reports[i]);
    gate_.begin_cycle();
    sent_ = gate_.next(wanted, value_);
    if (refusing_ == 0 && random_.chance(trouble_.refused)) refusing_ = 100;
    if (refusing_ > 0) {
      --refusing_;
    } else if (sent_) {
      gate_.handed_over(value_);
      send(offsets_, value_, cycle_ + 1);
    }
    for (std::size_t i = early; i < reports.size(); ++i)
      gate_.report(reports[i]);
  }

  [[nodiscard]] std::int64_t largest_step() const { return largest_step_; }
  [[nodiscard]] bool sent() const { return sent_; }
  [[nodiscard]] std::int32_t value() const { return value_; }
  [[nodiscard]] std::int32_t held() const { return held_; }
  void hold(std::int32_t value) { held_ = value; }
  [[nodiscard]] bool refused() const { return gate_.refused(); }

 private:
  void send(Wire& wire, std::int32_t value, std::int64_t earliest) {
    if (random_.chance(trouble_.lost)) return;
    do {
      const bool late = random_.chance(trouble_.delayed);
      wire.send(value, earliest + (late ? random_.integer(0, late_) : 0));
    } while (random_.chance(trouble_.twice));
  }

  void take() {
    const std::int32_t before = held_;
    for (const std::int32_t v : offsets_.arriving(cycle_, random_))
      held_ = v;
    largest_step_ = std::max(largest_step_, std::abs(std::int64_t{held_} - before));
  }

  // A gate comes back at once and has forgotten everything. A drive comes back with another offset;
  // it receives nothing before its controller has started it, which takes as long as the header
  // states.
  void restart() {
    const bool gate_too = random_.chance(0.5);  // or the drive has announced itself
    if (gate_too) gate_.forget();
    if (gate_too && random_.chance(0.5)) return;
    held_ = static_cast<std::int32_t>(random_.integer(-100'000, 100'000));
    const int silent = gate_too ? late_ + 1 : OffsetGate::silence_after_restart(late_);
    absent_ = silent + random_.integer(0, 20);
  }

  OffsetGate gate_;
  Wire offsets_;
  Wire reports_;
  std::uint8_t late_;
  Trouble trouble_;
  Random& random_;
  std::int64_t cycle_ = 0;
  std::int64_t absent_ = 0;
  int refusing_ = 0;  // cycles
  std::int64_t largest_step_ = 0;
  std::int32_t held_ = 0;
  std::int32_t value_ = 0;
  bool sent_ = false;
};

// Changes its mind by up to ten slews at any time, or creeps.
std::int32_t next_wanted(std::int32_t wanted, std::int32_t slew, Random& random) {
  const std::int64_t most = random.chance(0.05) ? 10 * std::int64_t{slew} : slew / 4;
  return static_cast<std::int32_t>(wanted + random.integer(-most, most));
}

std::int64_t largest_step(std::int32_t slew, std::uint8_t late, const Trouble& trouble,
                          Random& random) {
  Pair pair(slew, late, trouble, random);
  std::int32_t wanted = 0;
  for (int i = 0; i < kCycles; ++i) {
    wanted = next_wanted(wanted, slew, random);
    pair.cycle(wanted);
  }
  return pair.largest_step();
}

TEST(OffsetGate, NoStepAboveTheSlewWhateverIsLostLateTwiceOrRestarted) {
  Random random(301);
  SCOPED_TRACE(random.trace());
  for (std::uint8_t late = 0; late <= OffsetGate::kMostLate; ++late) {
    for (const Trouble& t :
         {Trouble{0.1, 0.1, 0.3, 0.0}, Trouble{0.5, 0.3, 0.5, 0.01}, Trouble{0.0, 0.0, 1.0, 0.05},
          Trouble{0.9, 0.5, 1.0, 0.02}, Trouble{0.1, 0.1, 0.3, 0.0, 0.01}}) {
      for (const std::int32_t slew : {1, 7, 20'000}) {
        EXPECT_LE(largest_step(slew, late, t, random), slew)
            << "late " << int{late} << " lost " << t.lost << " restart " << t.restart;
      }
    }
  }
}

// With a bound on acceleration values go on while reports are missing, and a limiter leads back.
TEST(OffsetGate, NoStepAboveTheSlewWhereAMissingReportBrakes) {
  Random random(304);
  SCOPED_TRACE(random.trace());
  for (std::uint8_t late = 0; late <= OffsetGate::kMostLate; ++late) {
    for (const Trouble& t :
         {Trouble{0.1, 0.1, 0.3, 0.0}, Trouble{0.5, 0.3, 0.5, 0.01}, Trouble{0.0, 0.0, 1.0, 0.05},
          Trouble{0.9, 0.5, 1.0, 0.02}, Trouble{0.1, 0.1, 0.3, 0.0, 0.01}}) {
      GateBounds bounds = bounds_of(20'000, late, true);
      bounds.rate = OffsetGate::unhindered(bounds.slew, late);
      bounds.soft = bounds.rate / 3;
      bounds.acceleration = bounds.rate / 7;
      bounds.limit = 4'000'000;
      OffsetLimiter<true> stream;
      stream.change(OffsetBounds(OffsetLimits{bounds.limit, bounds.rate, 1, bounds.acceleration}));
      stream.start(0);
      Pair pair(bounds, t, random);
      std::int32_t wanted = 0;
      for (int i = 0; i < kCycles; ++i) {
        wanted = next_wanted(wanted, bounds.slew, random);
        wanted = std::max(-bounds.limit, std::min(bounds.limit, wanted));
        stream.follow(wanted);
        pair.cycle(stream.offset());
      }
      EXPECT_LE(pair.largest_step(), bounds.slew)
          << "late " << int{late} << " lost " << t.lost << " restart " << t.restart;
      EXPECT_FALSE(pair.refused());
    }
  }
}

// Otherwise the tests above would also pass for a gate that never sends.
TEST(OffsetGate, ReachesWhatIsWantedInSpiteOfLosses) {
  Random random(302);
  SCOPED_TRACE(random.trace());
  Pair pair(1000, 2, {0.2, 0.1, 0.3, 0.0}, random);
  for (int i = 0; i < 2000; ++i)
    pair.cycle(50'000);
  EXPECT_EQ(pair.held(), 50'000);
}

TEST(OffsetGate, LetsEverythingThroughBelowItsUnhinderedRate) {
  Random random(303);
  SCOPED_TRACE(random.trace());
  for (std::uint8_t late = 0; late <= OffsetGate::kMostLate; ++late) {
    const std::int32_t slew = 20'000;
    const std::int32_t rate = OffsetGate::unhindered(slew, late);
    Pair pair(slew, late, {}, random);
    for (int i = 0; i < 2 * late + 3; ++i)
      pair.cycle(0);
    ASSERT_TRUE(pair.sent()) << int{late};
    std::int32_t wanted = 0;
    for (int i = 0; i < 10'000; ++i) {
      const bool straight = i % 1000 < 500;
      wanted += straight ? rate : static_cast<std::int32_t>(random.integer(-rate, rate));
      pair.cycle(wanted);
      ASSERT_EQ(pair.value(), wanted) << "late " << int{late} << " cycle " << i;
    }
    EXPECT_LE(pair.largest_step(), rate);
  }
}

class Reported : public ::testing::Test {
 protected:
  static constexpr std::int32_t kSlew = 100;
  static constexpr std::uint8_t kLate = 2;

  Reported() { gate.configure(bounds_of(kSlew, kLate, true)); }
  bool cycle(std::int32_t report, std::int32_t wanted) {
    gate.report(report);
    return cycle_without_report(wanted);
  }
  bool cycle_without_report(std::int32_t wanted) {
    gate.begin_cycle();
    if (!gate.next(wanted, value)) return false;
    gate.handed_over(value);
    return true;
  }
  void open_at(std::int32_t held) {
    for (int i = 0; i < 100 && !gate.open(); ++i)
      static_cast<void>(cycle(held, held));
    ASSERT_TRUE(gate.open());
  }

  OffsetGate gate;
  std::int32_t value = 0;
};

// An offset and then a report of its arrival can be late by two cycles each, and a report may come
// when its cycle has been computed.
TEST_F(Reported, IsSilentUntilNothingCanBeUnderWay) {
  constexpr int kEnough = 2 * kLate + 2;
  for (int i = 1; i < kEnough; ++i)
    EXPECT_FALSE(cycle(500, 0)) << i;
  EXPECT_TRUE(cycle(500, 0));
  EXPECT_EQ(value, 400);
}

TEST_F(Reported, AnotherValueStartsTheWaitingAnew) {
  for (int i = 0; i < 5; ++i)
    EXPECT_FALSE(cycle(500, 0));
  for (int i = 0; i < 5; ++i)
    EXPECT_FALSE(cycle(501, 0));
  EXPECT_TRUE(cycle(501, 0));
}

TEST_F(Reported, RepeatsItsLastValueWhileReportsAreMissingThenFallsSilent) {
  open_at(500);
  ASSERT_TRUE(cycle(500, 450));
  for (int i = 0; i <= kLate; ++i) {
    EXPECT_TRUE(cycle_without_report(0)) << i;
    EXPECT_EQ(value, 450);
  }
  EXPECT_FALSE(cycle_without_report(0));
  EXPECT_FALSE(gate.open());
}

TEST_F(Reported, StartsAgainFromAValueThatIsNotItsOwn) {
  open_at(500);
  ASSERT_TRUE(cycle(500, 450));
  EXPECT_FALSE(cycle(0, 450));  // the drive was restarted
  for (int i = 0; i < 2 * kLate; ++i)
    EXPECT_FALSE(cycle(0, 450));
  EXPECT_TRUE(cycle(0, 450));
  EXPECT_EQ(value, 100);
}

// A drive may report anything in 32 bits; what cannot be meant is not continued.
TEST_F(Reported, TheEndsOfTheRangeDoNotOverflow) {
  gate.configure(bounds_of(INT32_MAX, kLate, true));
  for (const std::int32_t end : {kMostHeld, -kMostHeld}) {
    open_at(end);
    ASSERT_TRUE(cycle(end, end < 0 ? INT32_MAX : INT32_MIN));
    EXPECT_EQ(value, 0) << "one slew further";
    gate.forget();
  }
  for (const std::int32_t end : {INT32_MIN, INT32_MAX}) {
    for (int i = 0; i < 100; ++i)
      EXPECT_FALSE(cycle(end, 0));
  }
}

TEST(OffsetGateWithoutReports, TrustsTheStartValueAndKeepsTheSlew) {
  OffsetGate gate;
  gate.configure(bounds_of(100, 2, false));
  std::int32_t value = 0;
  gate.begin_cycle();
  EXPECT_FALSE(gate.next(1000, value));  // no start value yet
  gate.start_at(-50);
  std::deque<std::int32_t> sent{-50};
  for (int i = 0; i < 200; ++i) {
    gate.begin_cycle();
    ASSERT_TRUE(gate.next(1000, value));
    gate.handed_over(value);
    for (const std::int32_t before : sent)
      EXPECT_LE(std::abs(value - before), 100);
    sent.push_back(value);
    if (sent.size() > 3) sent.pop_front();  // what can be under way
  }
  EXPECT_EQ(value, 1000);
}

// --- what is handed over

// Nothing can reach the drive, so nothing may be counted on: a port that takes nothing for 200
// cycles, then everything.
TEST(OffsetGateHandOver, WhatNeverLeftIsNotRemembered) {
  for (const bool reports : {true, false}) {
    OffsetGate gate;
    gate.configure(bounds_of(20'000, 2, reports));
    gate.start_at(0);
    std::int32_t value = 0;
    for (int i = 0; i < 200; ++i) {
      gate.report(0);
      gate.begin_cycle();
      ASSERT_TRUE(gate.next(200'000, value));
      EXPECT_LE(value, 20'000) << i;
      EXPECT_EQ(gate.last(), 0);
    }
    gate.handed_over(value);
    EXPECT_EQ(gate.last(), value);
  }
}

TEST(OffsetGateWithoutReports, HearsNone) {
  OffsetGate gate;
  gate.configure(bounds_of(100, 2, false));
  gate.start_at(500);
  gate.report(-70'000);
  EXPECT_TRUE(gate.open());
  std::int32_t value = 0;
  gate.begin_cycle();
  ASSERT_TRUE(gate.next(500, value));
  EXPECT_EQ(value, 500);
}

// --- the soft way from what a drive holds

TEST_F(Reported, GoesToWhatIsWantedAtTheSoftRateUntilItIsMet) {
  GateBounds bounds = bounds_of(kSlew, kLate, true);
  bounds.soft = 3;
  gate.configure(bounds);
  gate.start_at(0);
  std::int32_t held = 0;
  for (int i = 1; i <= 200; ++i) {
    ASSERT_TRUE(cycle(held, 600));
    EXPECT_EQ(value, 3 * i);
    held = value;
  }
  EXPECT_EQ(value, 600);
  ASSERT_TRUE(cycle(value, 610));
  EXPECT_EQ(value, 610) << "once met, the slew alone holds";
}

TEST_F(Reported, NothingHasToBeApproachedWhereWhatIsWantedBeginsAtTheDrive) {
  GateBounds bounds = bounds_of(kSlew, kLate, true);
  bounds.soft = 3;
  gate.configure(bounds);
  gate.start_at(500);
  gate.join();
  ASSERT_TRUE(cycle(500, 480));
  EXPECT_EQ(value, 480);
}

// --- the limit

TEST_F(Reported, NothingBeyondTheLimitWhateverIsWanted) {
  GateBounds bounds = bounds_of(kSlew, kLate, true);
  bounds.limit = 250;
  gate.configure(bounds);
  open_at(0);
  for (int i = 0; i < 100; ++i) {
    const std::int32_t wanted = i < 50 ? INT32_MAX : INT32_MIN;
    ASSERT_TRUE(cycle(value, wanted));
    EXPECT_LE(std::abs(value), 250);
  }
  EXPECT_EQ(value, -250);
}

// A drive that starts beyond the limit is brought back along what is wanted, never further out.
TEST_F(Reported, BeyondTheLimitOnlyOnTheWayBack) {
  GateBounds bounds = bounds_of(kSlew, kLate, true);
  bounds.limit = 250;
  gate.configure(bounds);
  gate.start_at(500);
  gate.join();
  std::int32_t before = 500;
  for (const std::int32_t wanted : {490, 900, 480, 485, 470, INT32_MIN, 450}) {
    ASSERT_TRUE(cycle(before, wanted));
    EXPECT_LE(value, before);
    EXPECT_GE(value, before - kSlew);
    before = value;
  }
  for (int i = 0; i < 30; ++i)
    ASSERT_TRUE(cycle(value, 900));
  EXPECT_LE(value, 450);
  for (int i = 0; i < 30; ++i)
    ASSERT_TRUE(cycle(value, 0));
  for (int i = 0; i < 30; ++i)
    ASSERT_TRUE(cycle(value, 900));
  EXPECT_EQ(value, 250);
}

// --- bits that change in memory

// The bits of a gate that are not as they were configured when they flip.
std::vector<std::size_t> bits_of_bounds(const OffsetGate& healthy) {
  OffsetGate changed = healthy;
  auto* const memory = reinterpret_cast<unsigned char*>(&changed);
  std::vector<std::size_t> bits;
  for (std::size_t bit = 0; bit < 8 * sizeof changed; ++bit) {
    const auto flip = static_cast<unsigned char>(1U << bit % 8);
    memory[bit / 8] ^= flip;
    if (!changed.intact()) bits.push_back(bit);
    memory[bit / 8] ^= flip;
  }
  return bits;
}

// A gate on its way between ±limit in which one bit of its bounds or of what it is given changes.
// Whatever bit it is: no value beyond the limit, no step above the slew, and a changed bound is
// reported and walks to 0.
class FlippedBit : public ::testing::TestWithParam<bool> {
 protected:
  static constexpr std::int32_t kLimit = 200'000;
  static constexpr std::int32_t kSlew = 20'000;
  static constexpr std::int32_t kSoft = 1'000;

  FlippedBit() {
    GateBounds bounds = bounds_of(kSlew, 2, GetParam());
    bounds.limit = kLimit;
    bounds.soft = kSoft;
    bounds.scale = {512, 3, true};
    gate.configure(bounds);
    gate.start_at(0);
    gate.join();
  }
  void cycle(std::int32_t wanted) {
    gate.report(held);
    gate.begin_cycle();
    std::int32_t value = 0;
    if (!gate.next(wanted, value)) return;
    gate.handed_over(value);
    EXPECT_LE(std::abs(value), kLimit);
    EXPECT_LE(std::abs(value - held), kSlew);
    held = value;
  }
  void travel() {
    for (int i = 0; i < 60; ++i)
      cycle(i < 30 ? 150'000 : -150'000);
  }

  OffsetGate gate;
  std::int32_t held = 0;
};

TEST_P(FlippedBit, OfTheBoundsWalksToZeroAndIsTold) {
  const std::vector<std::size_t> places = bits_of_bounds(gate);
  ASSERT_EQ(places.size(), 2U * 8U * sizeof(GateBounds)) << "all of it, twice";
  const OffsetGate healthy = gate;
  for (const std::size_t bit : places) {
    SCOPED_TRACE(bit);
    gate = healthy;
    held = 0;
    travel();
    EXPECT_FALSE(gate.tripped());
    const std::int32_t before = held;
    reinterpret_cast<unsigned char*>(&gate)[bit / 8] ^= static_cast<unsigned char>(1U << bit % 8);
    cycle(before);
    EXPECT_TRUE(gate.tripped());
    for (int i = 0; i < 1000; ++i)
      cycle(i % 2 == 0 ? 150'000 : -150'000);
    EXPECT_TRUE(held == 0 || !gate.open()) << held;
    if (HasFailure()) return;
  }
  gate.configure(bounds_of(kSlew, 2, GetParam()));
  EXPECT_FALSE(gate.tripped());
}

TEST_P(FlippedBit, OfWhatIsWantedStaysWithinLimitAndSlew) {
  for (unsigned bit = 0; bit < 32; ++bit) {
    for (const std::int32_t wanted : {0, 1, 150'000, -150'000, kLimit, -kLimit}) {
      travel();
      for (int i = 0; i < 40; ++i)
        cycle(static_cast<std::int32_t>(static_cast<std::uint32_t>(wanted) ^ (1U << bit)));
    }
  }
  EXPECT_FALSE(gate.tripped());
}

INSTANTIATE_TEST_SUITE_P(Reports, FlippedBit, ::testing::Bool());

}  // namespace
}  // namespace volcomp::node
