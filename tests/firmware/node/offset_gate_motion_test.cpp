// A gate that checks limit, rate and acceleration of what it is given: broken streams, flipped
// bits, missing reports, drives that start elsewhere.

#include <cstdlib>
#include <vector>

#include "firmware/node/offset_gate.hpp"
#include "tests/oracle/offset_storm.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::node {
namespace {

using test::Int;
using test::QuickRandom;

constexpr std::int32_t kLimit = 200'000;
constexpr std::int32_t kRate = 2'000;
constexpr std::int32_t kSoft = 500;
constexpr std::int32_t kAcceleration = 100;
constexpr std::uint8_t kLate = 2;
constexpr std::int32_t kSlew = kRate * (2 * kLate + 3);

GateBounds motion_bounds(bool reports) {
  GateBounds b;
  b.limit = kLimit;
  b.slew = kSlew;
  b.soft = kSoft;
  b.rate = kRate;
  b.acceleration = kAcceleration;
  b.late = kLate;
  b.reports = reports ? std::uint8_t{1} : std::uint8_t{0};
  b.scale = {512, 3, true};
  return b;
}

// What a compensator puts out under hostile targets.
class Stream {
 public:
  explicit Stream(QuickRandom& random) : random_(random) {
    limiter_.change(OffsetBounds(OffsetLimits{kLimit, kRate, kSoft, kAcceleration}));
    limiter_.start(0);
  }
  std::int32_t next() {
    if (random_.once_in(60)) targets_.next_manner(kRate, random_);
    const std::int32_t t = targets_.next(limiter_.offset(), limiter_.step(), kLimit, random_);
    limiter_.follow(t);
    return limiter_.offset();
  }
  [[nodiscard]] std::int32_t offset() const { return limiter_.offset(); }

 private:
  QuickRandom& random_;
  test::HostileTargets targets_;
  OffsetLimiter<true> limiter_;
};

// A gate and a drive that takes every value in the next cycle and reports it.
class Drive {
 public:
  explicit Drive(bool reports) : reports_(reports) {
    gate.configure(motion_bounds(reports));
    gate.start_at(0);
    gate.join();
  }
  void cycle(std::int32_t wanted, bool report = true, bool handed = true) {
    if (reports_ && report) gate.report(held);
    gate.begin_cycle();
    std::int32_t value = held;
    const bool sends = gate.next(wanted, value);
    if (sends && handed) gate.handed_over(value);
    const Int next = sends && handed ? value : held;
    change = std::abs(next - held - step);
    step = next - held;
    held = static_cast<std::int32_t>(next);
  }
  // Limit, rate and acceleration of what the drive takes.
  [[nodiscard]] bool kept() const {
    return std::abs(Int{held}) <= kLimit && std::abs(step) <= kRate && change <= kAcceleration;
  }

  OffsetGate gate;
  std::int32_t held = 0;
  Int step = 0;
  Int change = 0;

 private:
  bool reports_;
};

class GateMotion : public ::testing::TestWithParam<bool> {
 protected:
  QuickRandom random{test::seed()};
};

TEST_P(GateMotion, PassesWhatKeepsItsBoundsAsItIs) {
  Drive drive(GetParam());
  Stream stream(random);
  for (int n = 0; n < test::kManyPoints; ++n) {
    const std::int32_t wanted = stream.next();
    drive.cycle(wanted);
    ASSERT_EQ(drive.held, wanted) << n;
  }
  EXPECT_FALSE(drive.gate.refused());
}

// Any stream, from anywhere in a good one: the drive keeps limit, rate and acceleration, and comes
// to 0 unless every value happened to fit.
TEST_P(GateMotion, ABrokenStreamIsTakenToZero) {
  int refused = 0;
  for (int round = 0; round < test::kManyPoints / 1'000; ++round) {
    Drive drive(GetParam());
    Stream stream(random);
    for (int n = random.below(300); n > 0; --n)
      drive.cycle(stream.next());
    for (int n = 0; n < 700; ++n) {
      drive.cycle(static_cast<std::int32_t>(random.bits()));
      ASSERT_TRUE(drive.kept()) << "round " << round << " cycle " << n << ": " << drive.held
                                << " by " << drive.step << " change " << drive.change;
    }
    EXPECT_EQ(drive.held, 0);
    if (drive.gate.refused()) ++refused;
  }
  EXPECT_EQ(refused, test::kManyPoints / 1'000);
}

// Every bit of one wanted value: within the bounds, or refused from there on.
TEST_P(GateMotion, EveryFlippedBitOfTheInputFitsOrIsRefused) {
  for (unsigned bit = 0; bit < 32; ++bit) {
    for (int before = 0; before < 200; before += 7) {
      Drive drive(GetParam());
      Stream stream(random);
      for (int n = 0; n < before; ++n)
        drive.cycle(stream.next());
      const auto wanted = static_cast<std::uint32_t>(stream.next());
      drive.cycle(static_cast<std::int32_t>(wanted ^ (1U << bit)));
      ASSERT_TRUE(drive.kept()) << "bit " << bit;
      for (int n = 0; n < 700; ++n) {
        drive.cycle(stream.next());
        ASSERT_TRUE(drive.kept()) << "bit " << bit << " cycle " << n;
      }
      if (drive.gate.refused()) {
        ASSERT_EQ(drive.held, 0);
      } else {
        ASSERT_EQ(drive.held, stream.offset());
      }
    }
  }
}

// Every bit of bounds and scale, and of their copies.
TEST_P(GateMotion, EveryFlippedBitOfTheBoundsIsTakenToZero) {
  std::vector<std::size_t> bits;
  OffsetGate whole;
  whole.configure(motion_bounds(GetParam()));
  for (std::size_t bit = 0; bit < 8 * sizeof whole; ++bit) {
    auto& byte = reinterpret_cast<unsigned char*>(&whole)[bit / 8];
    byte = static_cast<unsigned char>(byte ^ 1U << bit % 8);
    if (!whole.intact()) bits.push_back(bit);
    byte = static_cast<unsigned char>(byte ^ 1U << bit % 8);
  }
  ASSERT_EQ(bits.size(), std::size_t{2} * 8 * sizeof(GateBounds));
  for (const std::size_t bit : bits) {
    for (const int before : {3, 40, 150}) {
      Drive drive(GetParam());
      Stream stream(random);
      for (int n = 0; n < before; ++n)
        drive.cycle(stream.next());
      auto& byte = reinterpret_cast<unsigned char*>(&drive.gate)[bit / 8];
      byte = static_cast<unsigned char>(byte ^ 1U << bit % 8);
      for (int n = 0; n < 900; ++n) {
        drive.cycle(stream.next());
        ASSERT_TRUE(drive.kept()) << "bit " << bit << " cycle " << n << ": " << drive.held << " by "
                                  << drive.step << " change " << drive.change;
      }
      ASSERT_TRUE(drive.gate.tripped());
      ASSERT_TRUE(drive.held == 0 || !drive.gate.open()) << "bit " << bit << ' ' << drive.held;
    }
  }
}

// A port that takes nothing for a while; what was not handed over did not happen.
TEST_P(GateMotion, WhatWasNotHandedOverBendsNothingAfterIt) {
  Drive drive(GetParam());
  Stream stream(random);
  int together = 0;
  for (int n = 0; n < test::kManyPoints / 10; ++n) {
    const bool handed = n % 500 < 490;
    const Int before = drive.step;
    drive.cycle(stream.next(), true, handed);
    if (handed || before == 0) {
      ASSERT_TRUE(drive.kept()) << n << ": " << drive.step << ' ' << drive.change;
    }
    if (drive.held == stream.offset()) ++together;
  }
  EXPECT_GT(together, test::kManyPoints / 20);
  EXPECT_FALSE(drive.gate.refused());
}

INSTANTIATE_TEST_SUITE_P(Reports, GateMotion, ::testing::Bool());

// At half the rate values that are under way leave room: the drive does not see that reports were
// missing, and the offset comes back to what is wanted.
TEST(GateReports, AMissingReportBrakes) {
  for (int missing = 1; missing <= kLate + 1; ++missing) {
    Drive drive(true);
    std::int32_t wanted = 0;
    std::int32_t step = 0;
    const auto go_on = [&](bool report) {
      step = std::min(step + kAcceleration, kRate / 2);
      wanted += step;
      drive.cycle(wanted, report);
      ASSERT_TRUE(drive.kept()) << missing << ": " << drive.step << ' ' << drive.change;
    };
    for (int n = 0; n < 50; ++n)
      go_on(true);
    ASSERT_EQ(drive.held, wanted);
    for (int n = 1; n <= missing; ++n) {
      go_on(false);
      EXPECT_EQ(drive.step, kRate / 2 - n * kAcceleration);
    }
    for (int n = 0; n < 60; ++n)
      go_on(true);
    EXPECT_EQ(drive.held, wanted) << "without lag again";
    EXPECT_FALSE(drive.gate.refused());
  }
}

// From what a drive holds to what is wanted: soft, without a jump of the speed.
TEST(GateReports, ADriveThatStartsElsewhereIsBroughtBackSoftly) {
  Drive drive(true);
  for (int n = 0; n < 50; ++n)
    drive.cycle(0);
  drive.held = 50'000;  // restarted
  drive.step = 0;
  int cycles = 0;
  for (; drive.held != 0 && cycles < 1'000; ++cycles) {
    drive.cycle(0);
    ASSERT_LE(std::abs(drive.step), kSoft);
    ASSERT_LE(drive.change, kAcceleration);
  }
  EXPECT_GT(cycles, 100);
  EXPECT_LT(cycles, 150);
}

// A limiter of its own leads home and stays there; only a new start ends it.
TEST(GateReports, ARefusedStreamIsNotListenedToAgain) {
  Drive drive(true);
  drive.cycle(100);
  drive.cycle(kRate + 500);
  EXPECT_TRUE(drive.gate.refused());
  EXPECT_FALSE(drive.gate.tripped()) << "its bounds are intact";
  for (int n = 0; n < 100; ++n)
    drive.cycle(100);
  EXPECT_EQ(drive.held, 0);
  drive.gate.forget();
  for (int n = 0; n < 20; ++n)
    drive.cycle(100);
  EXPECT_TRUE(drive.gate.open());
  EXPECT_EQ(drive.held, 0);
  drive.gate.configure(motion_bounds(true));
  EXPECT_FALSE(drive.gate.refused());
}

// Without an acceleration nothing is checked: today's gate.
TEST(GateReports, WithoutAccelerationAnyStreamIsSlewed) {
  Drive drive(true);
  GateBounds bounds = motion_bounds(true);
  bounds.acceleration = 0;
  drive.gate.configure(bounds);
  drive.gate.start_at(0);
  drive.gate.join();
  drive.cycle(1'000'000);
  EXPECT_EQ(drive.held, kSlew);
  EXPECT_FALSE(drive.gate.refused());
}

}  // namespace
}  // namespace volcomp::node
