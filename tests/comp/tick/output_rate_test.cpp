// The promise to the drive: no output ever moves by more than `rate` in one tick, whatever happens.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

MachineTables big_tables(double sign, Random& random) {
  MachineTables t = xyfz_tables(60e3, 1e-4, random);
  for (AxisTable& axis : t.axis) {
    for (auto& column : axis.value) {
      for (std::uint32_t i = 0; i < axis.knots; ++i)
        column[i][0] += static_cast<float>(sign * 200e3);
    }
  }
  return t;
}

MachineTables rotary_tables(double size, Random& random) {
  MachineTables t;
  MachineDescription& d = t.machine;
  d.body_count = 5;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X', {173.0, 0, 0});
  d.body[2] = moving_body(2, JointKind::prismatic, Axis::y, 1, 1, 'Y', {0, -12.5, 0});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::y, 1, 2, 'B');
  d.body[4] = moving_body(1, JointKind::rotary, Axis::z, 1, 3, 'A', {-60, 5, -20});
  d.tool_body = 4;
  d.work_body = 5;
  d.tool_point = {-173.7, 0, 0};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  t.axis[0] = random_table(-120'000'000, 15'000'000, 17, size, size * 1e-8, random);
  t.axis[1] = random_table(-80'000'000, 20'000'000, 9, size, size * 1e-8, random);
  t.axis[2] = random_table(-kTurn / 3, kTurn / 36, 25, size, size * 1e-8, random);  // ±120°
  t.axis[3] = random_table(0, kTurn / 36, 36, size, size * 1e-8, random);
  t.axis[3].periodic = true;
  return t;
}

// Random operation of one compensator; every tick is checked.
class Storm {
 public:
  Storm(LoadedRunner& runner, std::size_t axes, Random& random)
      : runner_(runner), axes_(axes), random_(random) {}

  void configure() {
    for (std::size_t a = 0; a < 5; ++a) {
      AxisLimits& l = settings_.axis[a];
      l.limit = static_cast<std::int32_t>(random_.integer(1'000, 400'000));
      l.rate = static_cast<std::int32_t>(random_.integer(1, 20'000));
      l.soft_rate = static_cast<std::int32_t>(random_.integer(1, l.rate));
      l.hysteresis = static_cast<std::int32_t>(random_.integer(0, 5'000));
      l.max_step = random_.chance(0.5) ? 0 : random_.integer(1'000, 5'000'000);
    }
    settings_.source = random_.chance(0.5) ? PositionSource::target : PositionSource::actual;
    settings_.ramp_ticks = static_cast<std::uint32_t>(random_.integer(1, 300));
    settings_.stale_drop_ticks = static_cast<std::uint16_t>(random_.integer(0, 30));
    ASSERT_TRUE(runner_.compensator->configure(settings_).ok());
    std::array<std::int32_t, 5> start{};
    for (std::size_t a = 0; a < 3; ++a)
      start[a] = static_cast<std::int32_t>(random_.integer(-500'000, 500'000));
    ASSERT_TRUE(runner_.compensator->start_from(start).ok());
    last_ = start;
  }

  void event(const MachineTables& one, const MachineTables& other) {
    if (random_.chance(0.004)) {
      const MachineTables& next = random_.chance(0.5) ? one : other;
      const Vec3 tool(random_.in(-50, 50), random_.in(-50, 50), random_.in(-400, 0));
      if (runner_.compensator->stage(next, tool, 0).ok()) {
        ASSERT_TRUE(runner_.compensator->activate().ok());
      }
    }
    if (random_.chance(0.001)) runner_.compensator->deactivate();
    for (std::size_t a = 0; a < axes_; ++a) {
      AxisSample& s = runner_.in.axis[a];
      if (random_.chance(0.003)) s.homed = !s.homed;
      if (!s.homed && random_.chance(0.05)) s.homed = true;
      s.valid = s.valid ? !random_.chance(0.01) : random_.chance(0.1);
      move(s.position);
    }
  }

  void tick(int n) {
    runner_.tick();
    for (std::size_t a = 0; a < axes_; ++a) {
      const std::int64_t moved = std::int64_t{runner_.out.offset[a]} - last_[a];
      ASSERT_LE(std::abs(moved), settings_.axis[a].rate) << "tick " << n << " axis " << a;
      ASSERT_LE(std::abs(runner_.out.offset[a]),
                std::max<std::int32_t>(settings_.axis[a].limit, 500'000));
      const unsigned gone = kNotHomed | kDropped;
      if (a < 3 && (runner_.out.status[a] & gone) != 0 &&
          (runner_.out.status[a] & kNoTables) == 0) {
        ASSERT_LE(std::abs(moved), settings_.axis[a].soft_rate) << "tick " << n << " axis " << a;
      }
      last_[a] = runner_.out.offset[a];
    }
  }

 private:
  void move(std::int64_t& q) {
    if (random_.chance(0.002)) {
      q = random_.integer(std::numeric_limits<std::int64_t>::min(),
                          std::numeric_limits<std::int64_t>::max());
    } else if (random_.chance(0.01)) {
      q = random_.integer(-600'000'000, 100'000'000);
    } else if (random_.chance(0.005)) {
      q = random_.integer(-3 * kTurn, 3 * kTurn);
    } else {
      q = std::min(std::max(q, -4 * kTurn), 4 * kTurn) + random_.integer(-1'000'000, 1'000'000);
    }
  }

  LoadedRunner& runner_;
  std::size_t axes_;
  Random& random_;
  CompensatorSettings<5> settings_{};
  std::array<std::int32_t, 5> last_{};
};

void weather(const MachineTables& one, const MachineTables& other, std::size_t axes,
             std::uint64_t first_seed) {
  for (std::uint64_t round = 0; round < 10; ++round) {
    Random random(first_seed + round);
    SCOPED_TRACE(random.trace());
    LoadedRunner runner(one.machine);
    Storm storm(runner, axes, random);
    storm.configure();
    for (int n = 0; n < std::max(kManyPoints / 40, 2'500); ++n) {
      storm.event(one, other);
      storm.tick(n);
      if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(runner.compensator->diagnostics().activations, 1U) << "the storm was a calm";
  }
}

TEST(OutputRate, LinearMachineInAStorm) {
  Random random(50);
  const auto one = big_tables(1.0, random);
  const auto other = big_tables(-1.0, random);
  weather(one, other, 3, 100);
}

TEST(OutputRate, RotaryMachineInAStorm) {
  Random random(51);
  const auto one = rotary_tables(5e3, random);
  const auto other = rotary_tables(30e3, random);
  weather(one, other, 4, 200);
}

// Offsets read back from a drive may be anything an int32 can hold.
TEST(OutputRate, AnyStartOffsetGoesStraightToTheTarget) {
  for (const std::int32_t start :
       {4'194'303, 4'194'304, 5'000'000, -5'000'000, 16'777'217, 1 << 30, -(1 << 30)}) {
    LoadedRunner runner(kXyfzMachine);
    auto settings = open_settings<5>();
    settings.ramp_ticks = 50;
    ASSERT_TRUE(runner.compensator->configure(settings).ok());
    ASSERT_TRUE(runner.compensator->start_from({start, 0, 0, 0, 0}).ok());
    std::int64_t last = start;
    for (int n = 0; n < 100; ++n) {
      const std::int64_t now = runner.tick({0, 0, 0, 0, 0}).offset[0];
      ASSERT_LE(std::abs(now), std::abs(last)) << "start " << start << " tick " << n;
      ASSERT_LE(std::abs(now - last), 1'000'000'000) << "start " << start << " tick " << n;
      last = now;
    }
    EXPECT_EQ(last, 0) << "start " << start;
  }
}

// No drive stands a metre from its command: such a read-back is garbage and changes nothing.
TEST(OutputRate, AbsurdStartOffsetIsRefused) {
  for (const std::int32_t start :
       {std::int32_t{(1 << 30) + 1}, std::numeric_limits<std::int32_t>::max(),
        std::numeric_limits<std::int32_t>::min()}) {
    LoadedRunner runner(kXyfzMachine);
    ASSERT_TRUE(runner.compensator->start_from({100, 0, 0, 0, 0}).ok());
    const Status refused = runner.compensator->start_from({0, start, 0, 0, 0});
    EXPECT_EQ(refused.reason, Reason::bad_setting);
    EXPECT_STREQ(refused.where.field, "start offset");
    EXPECT_EQ(refused.where.index, 1);
  }
}

}  // namespace
}  // namespace volcomp::test
