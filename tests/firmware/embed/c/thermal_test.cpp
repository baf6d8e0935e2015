// Temperatures and expiry behind volcomp.h.

#include <cmath>
#include <limits>

#include "tests/firmware/embed/c/support.hpp"

namespace volcomp::test {
namespace {

constexpr double kSteel_per_K = 11.7e-6;

// X from 0 to 300 mm, grown from −120 on.
MachineTables growing() {
  MachineTables tables = random_l300g(5);
  tables.provenance.temperature_C = 20.0F;
  tables.expansion[0] = {static_cast<float>(kSteel_per_K), -120.0F, 2};
  return tables;
}

TEST(CInterfaceThermal, TablesFollowTheTemperature) {
  const MachineTables tables = growing();
  const double reach_mm = static_cast<double>(tables.axis[0].last()) * 1e-6 + 120.0;
  const Bytes image = encode(tables);
  CInstance c;
  c.start(tables);
  const std::array<std::int64_t, kMaxAxes> q{10'000'000, 200'000'000, 0, 0};
  c.tick(q);
  const volcomp_output cold = c.tick(q);
  EXPECT_EQ(volcomp_growth_nm(c.get()), 0.0);
  EXPECT_EQ(volcomp_temperature_state(c.get(), 2, 0, 60), VOLCOMP_TEMPERATURE_UNKNOWN);

  volcomp_take_temperature(c.get(), 2, 24.0F, 10);
  volcomp_take_temperature(c.get(), 0, -10.0F, 10);  // nothing grows by it
  EXPECT_EQ(volcomp_temperature_state(c.get(), 2, 70, 60), VOLCOMP_TEMPERATURE_GOOD);
  EXPECT_EQ(volcomp_temperature_state(c.get(), 2, 71, 60), VOLCOMP_TEMPERATURE_STALE);
  EXPECT_NEAR(volcomp_growth_nm(c.get()), kSteel_per_K * 4.0 * 1e6 * reach_mm, 1.0);
  EXPECT_TRUE(volcomp_at_rest(c.get()));
  ASSERT_EQ(c.stage(image).reason, VOLCOMP_OK);
  ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
  EXPECT_FALSE(volcomp_at_rest(c.get()));
  EXPECT_EQ(volcomp_growth_nm(c.get()), 0.0);
  c.tick(q);
  const volcomp_output grown = c.tick(q);
  EXPECT_TRUE(volcomp_at_rest(c.get()));
  EXPECT_NEAR(grown.offset[0] - cold.offset[0], -kSteel_per_K * 4.0 * 130e6, 1.0);
  EXPECT_EQ(grown.offset[1], cold.offset[1]);

  // What cannot be true changes nothing.
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), 1e30F, -1e30F, 300.0F, 80.1F, -20.1F, 60.0F}) {
    volcomp_take_temperature(c.get(), 2, wrong, 72);
    EXPECT_EQ(volcomp_temperature_state(c.get(), 2, 72, 60), VOLCOMP_TEMPERATURE_IMPLAUSIBLE);
    EXPECT_EQ(volcomp_growth_nm(c.get()), 0.0);
  }
  volcomp_take_temperature(c.get(), VOLCOMP_TEMPERATURES, 24.0F, 72);
  EXPECT_EQ(volcomp_temperature_state(c.get(), VOLCOMP_TEMPERATURES, 72, 60),
            VOLCOMP_TEMPERATURE_UNKNOWN);
}

TEST(CInterfaceThermal, ExpiredImagesAreRefusedWhenTheDateIsKnown) {
  MachineTables tables = growing();
  tables.provenance.expires_unix_s = 1'800'000'000;
  CInstance c;
  c.start(tables);
  c.tick({});
  volcomp_machine machine{};
  volcomp_describe(c.get(), &machine);
  EXPECT_EQ(machine.expires, 1'800'000'000);
  EXPECT_EQ(machine.reference_C, 20.0F);
  EXPECT_FALSE(volcomp_expired(c.get()));
  volcomp_set_time(c.get(), 1'800'000'000);
  EXPECT_TRUE(volcomp_expired(c.get()));
  EXPECT_TRUE(volcomp_active(c.get()));
  // The active image goes on following temperatures; another one as old is refused.
  EXPECT_EQ(c.stage(encode(tables)).reason, VOLCOMP_OK);
  ++tables.provenance.sequence;
  EXPECT_STREQ(volcomp_code(c.stage(encode(tables)).reason), "expired");
  EXPECT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_NOT_STAGED);
  EXPECT_EQ(volcomp_growth_nm(c.get()), 0.0);
  volcomp_set_time(c.get(), 1'799'999'999);
  EXPECT_EQ(c.stage(encode(tables)).reason, VOLCOMP_OK);
}

}  // namespace
}  // namespace volcomp::test
