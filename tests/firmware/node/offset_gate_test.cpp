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
};

// One gate and one drive, cycle by cycle.
class Pair {
 public:
  Pair(std::int32_t slew, std::uint8_t late, const Trouble& trouble, Random& random)
      : late_(late), trouble_(trouble), random_(random) {
    gate_.configure(slew, late, true);
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
    if (sent_) send(offsets_, value_, cycle_ + 1);
    for (std::size_t i = early; i < reports.size(); ++i)
      gate_.report(reports[i]);
  }

  [[nodiscard]] std::int64_t largest_step() const { return largest_step_; }
  [[nodiscard]] bool sent() const { return sent_; }
  [[nodiscard]] std::int32_t value() const { return value_; }
  [[nodiscard]] std::int32_t held() const { return held_; }
  void hold(std::int32_t value) { held_ = value; }

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
  // it hears nothing before its controller has started it, which takes as long as the header says.
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
    for (const Trouble& t : {Trouble{0.1, 0.1, 0.3, 0.0}, Trouble{0.5, 0.3, 0.5, 0.01},
                             Trouble{0.0, 0.0, 1.0, 0.05}, Trouble{0.9, 0.5, 1.0, 0.02}}) {
      for (const std::int32_t slew : {1, 7, 20'000}) {
        EXPECT_LE(largest_step(slew, late, t, random), slew)
            << "late " << int{late} << " lost " << t.lost << " restart " << t.restart;
      }
    }
  }
}

// Otherwise the test above would also pass for a gate that never sends.
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

  Reported() { gate.configure(kSlew, kLate, true); }
  bool cycle(std::int32_t report, std::int32_t wanted) {
    gate.report(report);
    return cycle_without_report(wanted);
  }
  bool cycle_without_report(std::int32_t wanted) {
    gate.begin_cycle();
    return gate.next(wanted, value);
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

// Offsets anywhere in 32 bits: the differences do not fit.
TEST_F(Reported, TheEndsOfTheRangeDoNotOverflow) {
  open_at(INT32_MIN);
  ASSERT_TRUE(cycle(INT32_MIN, INT32_MAX));
  EXPECT_EQ(value, INT32_MIN + kSlew);
  gate.forget();
  open_at(INT32_MAX);
  ASSERT_TRUE(cycle(INT32_MAX, INT32_MIN));
  EXPECT_EQ(value, INT32_MAX - kSlew);
}

TEST(OffsetGateWithoutReports, TrustsTheStartValueAndKeepsTheSlew) {
  OffsetGate gate;
  gate.configure(100, 2, false);
  std::int32_t value = 0;
  gate.begin_cycle();
  EXPECT_FALSE(gate.next(1000, value));  // nobody has said where to start
  gate.start_at(-50);
  std::deque<std::int32_t> sent{-50};
  for (int i = 0; i < 200; ++i) {
    gate.begin_cycle();
    ASSERT_TRUE(gate.next(1000, value));
    for (const std::int32_t before : sent)
      EXPECT_LE(std::abs(value - before), 100);
    sent.push_back(value);
    if (sent.size() > 3) sent.pop_front();  // what can be under way
  }
  EXPECT_EQ(value, 1000);
}

}  // namespace
}  // namespace volcomp::node
