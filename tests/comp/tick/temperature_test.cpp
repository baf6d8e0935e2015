// Temperatures on their way into the tables in force: which are believed, what is refused, and how
// the offsets follow.

#include "comp/tables/image.hpp"
#include "comp/tick/temperature_input.hpp"
#include "tests/oracle/growing_machine.hpp"

namespace volcomp::test {
namespace {

// --- what is believed ----------------------------------------------------------------------------

TEST(TemperatureInput, KeepsTheLastGoodOne) {
  constexpr std::uint32_t kStale_s = 60;
  TemperatureInput input;
  EXPECT_EQ(input.state(0, kStale_s), TemperatureState::unknown);
  EXPECT_TRUE(std::isnan(input.celsius()));
  input.take(8001, 0);
  EXPECT_EQ(input.state(0, kStale_s), TemperatureState::implausible);
  EXPECT_TRUE(std::isnan(input.celsius()));
  input.take(2150, 1);
  EXPECT_EQ(input.state(1, kStale_s), TemperatureState::good);
  EXPECT_FLOAT_EQ(input.celsius(), 21.5F);
  for (const std::int16_t bad : {TemperatureInput::kNone, std::int16_t{-2001}, std::int16_t{8001},
                                 std::int16_t{2361}, std::int16_t{1939}}) {
    input.take(bad, 2);  // 2.1 K within a second is too fast
    EXPECT_EQ(input.state(2, kStale_s), TemperatureState::implausible) << bad;
    EXPECT_FLOAT_EQ(input.celsius(), 21.5F);
  }
  input.take(2360, 2);
  EXPECT_EQ(input.state(2, kStale_s), TemperatureState::good);
  EXPECT_EQ(input.state(62, kStale_s), TemperatureState::good);
  EXPECT_EQ(input.state(63, kStale_s), TemperatureState::stale);
  EXPECT_FLOAT_EQ(input.celsius(), 23.6F);
}

// A sensor that was moved is believed when the machine could have become so warm.
TEST(TemperatureInput, BelievesALastingChangeInTheEnd) {
  TemperatureInput input;
  input.take(2000, 0);
  std::uint32_t s = 1;
  for (; s < 1000; ++s) {
    input.take(3200, s);
    if (input.state(s, 60) == TemperatureState::good) break;
  }
  EXPECT_EQ(s, 100U);  // 12 K: 2 K at once, 0.1 K/s for the others
  input.take(-1000, 100 + 5000);
  EXPECT_FLOAT_EQ(input.celsius(), -10.0F);
}
// --- following -----------------------------------------------------------------------------------

TEST(Thermal, TablesFollowWithoutABump) {
  Random random(64);
  MachineTables tables = xyfz_tables(5e3, 4e-6, random);
  tables.expansion[0] = {kSteel, -500.0F, 0};
  LoadedRunner runner(kXyfzMachine);
  auto settings = open_settings<5>();
  settings.ramp_ticks = 200;
  for (AxisLimits& l : settings.axis)
    l.rate = l.soft_rate = 100;
  ASSERT_TRUE(runner.start(tables, settings).ok());
  const std::array<std::int64_t, 5> q{-50'000'000, -10'000'000, -20'000'000, 0, 0};
  for (int n = 0; n < 1000; ++n)
    runner.tick(q);
  ASSERT_TRUE(runner.compensator->at_rest());
  const std::array<std::int32_t, 5> cold = runner.out.offset;
  ASSERT_TRUE(stage_warm(runner, tables, warm(22.0F, 0.0F, 0.0F)).ok());
  EXPECT_FALSE(runner.compensator->at_rest());
  std::int32_t before = cold[0];
  for (int n = 0; n < 1000; ++n) {
    const std::int32_t now = runner.tick(q).offset[0];
    ASSERT_LE(std::abs(now - before), 100) << "tick " << n;
    ASSERT_LE(now, before) << "tick " << n;
    before = now;
  }
  EXPECT_TRUE(runner.compensator->at_rest());
  EXPECT_NEAR(before - cold[0], -kSteel_per_K * 2.0 * 450e6, 1.0);  // −10.53 µm
  EXPECT_EQ(runner.out.offset[1], cold[1]);
  EXPECT_EQ(runner.out.offset[2], cold[2]);
}

TEST(Thermal, TheLargestGrowthIsThatOfTheFarthestEnd) {
  Random random(65);
  MachineTables tables = xyfz_tables(5e3, 4e-6, random);  // X −500…0, Y −300…0, Z −400…0
  tables.expansion[0] = {10e-6F, -100.0F, 0};
  tables.expansion[2] = {10e-6F, 0.0F, 1};
  TablesView view;
  ASSERT_TRUE(view_tables(tables, view).ok());
  const auto at = [&](float x, float z) { return strains(view, warm(x, z, 20.0F)); };
  EXPECT_EQ(largest_growth_nm(view, at(20, 20)), 0.0);
  EXPECT_NEAR(largest_growth_nm(view, at(21, 20)), 10e-6 * 400e6, 1e-3);
  view.strain = at(21, 20);
  EXPECT_NEAR(largest_growth_nm(view, at(20, 22)), 2 * 10e-6 * 400e6, 1e-3);
  EXPECT_EQ(largest_growth_nm(view, at(21, 20)), 0.0);
}

// --- what is refused -----------------------------------------------------------------------------

struct Refused {
  const char* field;
  char axis;
  void (*spoil)(MachineTables&);
};

TEST(Thermal, ImagesWithUnusableExpansionsAreRefused) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Refused> cases{
      {"expansion", 'X', [](MachineTables& t) { t.expansion[0].per_K = 1.1e-4F; }},
      {"expansion", 'Y', [](MachineTables& t) { t.expansion[1].per_K = -1.1e-4F; }},
      {"expansion", 'Z', [](MachineTables& t) { t.expansion[2].per_K = kNan; }},
      {"expansion", 'A', [](MachineTables& t) { t.expansion[3].per_K = 1e-6F; }},
      {"fixed point", 'Y', [](MachineTables& t) { t.expansion[1].fixed_mm = 5001.0F; }},
      {"fixed point", 'Y', [](MachineTables& t) { t.expansion[1].fixed_mm = kNan; }},
      {"temperature input", 'X', [](MachineTables& t) { t.expansion[0].input = 4; }},
      {"temperature input", 'X', [](MachineTables& t) { t.expansion[0].input = 254; }},
      {"reference temperature", '\0',
       [](MachineTables& t) { t.provenance.temperature_C = -20.5F; }},
      {"reference temperature", '\0', [](MachineTables& t) { t.provenance.temperature_C = 81.0F; }},
      {"reference temperature", '\0',
       [](MachineTables& t) { t.provenance.temperature_C = kUnknownTemperature; }},
      {"expiry", '\0', [](MachineTables& t) { t.provenance.expires_unix_s = -1; }},
  };
  Random random(66);
  for (const Refused& c : cases) {
    MachineTables tables = five_axes(8e3, 40e-6, random);
    let_grow(tables);
    std::vector<std::uint8_t> image(image_size(tables));
    std::size_t written = 0;
    TablesView view;
    ASSERT_TRUE(encode_image(tables, image, written).ok());
    ASSERT_TRUE(check_image(image, kTableKnots, view).ok());
    c.spoil(tables);
    ASSERT_TRUE(encode_image(tables, image, written).ok());
    const Status from_image = check_image(image, kTableKnots, view);
    EXPECT_EQ(from_image.reason, Reason::bad_thermal) << c.field;
    EXPECT_EQ(from_image.where.axis, c.axis);
    const Status from_memory = view_tables(tables, view);
    EXPECT_EQ(from_memory.reason, Reason::bad_thermal) << c.field;
    EXPECT_STREQ(from_memory.where.field, c.field);
  }
}

TEST(Thermal, ExpiryNeedsADateAndATime) {
  EXPECT_FALSE(expired(0, 4'000'000'000));
  EXPECT_FALSE(expired(1'800'000'000, 0));
  EXPECT_FALSE(expired(1'800'000'000, 1'799'999'999));
  EXPECT_TRUE(expired(1'800'000'000, 1'800'000'000));
}
}  // namespace
}  // namespace volcomp::test
