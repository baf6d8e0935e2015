// Rate and acceleration of offsets: what a machine file states, what follows from it, and what a
// compensator gets. Figures by hand: a unit is 1 nm or 2^-32 turn.

#include <gmock/gmock.h>

#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/host/machine/axis_kinds.hpp"
#include "host_sim/host/machine/compensator_settings.hpp"
#include "host_sim/host/machine/machine_summary.hpp"
#include "host_sim/host/machine/offset_facts.hpp"
#include "tests/host_sim/host/machine/changed_machine.hpp"

namespace volcomp::host {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string text_of_machine(const char* name) {
  return read_whole_file(bundled_machine(name), std::size_t{1} << 20U);
}

// A field in [correction], and one of the first axis.
MachineFile with(const std::string& in_correction, const std::string& in_axis = "",
                 const char* name = "xyfz") {
  std::string text =
      changed(text_of_machine(name), "\n[correction]\n", "\n[correction]\n" + in_correction + "\n");
  text = changed(text, "\n[[axis]]\n", "\n[[axis]]\n" + in_axis + "\n");
  return parse_machine(text, "m.toml");
}

AxisLimits limits(const MachineFile& machine, std::size_t axis = 0) {
  return compensator_settings(machine.correction, axis_kinds(machine.chain)).axis.at(axis);
}
AxisLimits limits_of_setup(MachineFile machine, std::size_t axis = 0) {
  machine.correction = machine.correction.with_default_acceleration();
  return limits(machine, axis);
}

TEST(OffsetSettings, WithoutAWordSimulationsHaveNoneAndSetupTheDefault) {
  const MachineFile machine = with("");
  EXPECT_EQ(limits(machine).acceleration, 0);
  EXPECT_EQ(limits_of_setup(machine).acceleration, 200) << "0.2 m/s² at 1 kHz";
  EXPECT_EQ(limits(machine).rate, 10'000) << "10 mm/s";
}

TEST(OffsetSettings, TheFileStatesTheAcceleration) {
  const MachineFile machine = with("acceleration_mm_per_s2 = 500.0");
  EXPECT_EQ(limits(machine).acceleration, 500);
  EXPECT_EQ(limits(machine, 2).acceleration, 500);
  EXPECT_EQ(limits_of_setup(machine).acceleration, 500);
}

TEST(OffsetSettings, ZeroIsNone) {
  const MachineFile machine = with("acceleration_mm_per_s2 = 0.0");
  EXPECT_EQ(limits_of_setup(machine).acceleration, 0);
}

TEST(OffsetSettings, ATenthOfTheAccelerationOfTheAxis) {
  const MachineFile machine = with("", "max_acceleration_mm_per_s2 = 4000.0");
  EXPECT_EQ(limits(machine).acceleration, 400);
  EXPECT_EQ(limits(machine, 1).acceleration, 0) << "the other axes state nothing";
}

TEST(OffsetSettings, NeverMoreThanTheDriveHasToSpare) {
  const std::string spare = "spare_acceleration_mm_per_s2 = 150.0\n";
  EXPECT_EQ(limits(with("", spare)).acceleration, 150);
  EXPECT_EQ(limits(with("", spare + "max_acceleration_mm_per_s2 = 4000.0")).acceleration, 150);
  EXPECT_EQ(limits(with("acceleration_mm_per_s2 = 500.0", spare)).acceleration, 150);
  EXPECT_EQ(limits(with("acceleration_mm_per_s2 = 0.0", spare)).acceleration, 0) << "none is none";
  EXPECT_EQ(limits(with("", "spare_acceleration_mm_per_s2 = 900.0")).acceleration, 200);
}

// 2 rad/s² at 1 ms: 1367.1 parts of 2^-32 turn.
TEST(OffsetSettings, RotaryAxesHaveTheirOwn) {
  const MachineFile machine = with("", "", "trunnion");
  const AxisKinds kinds = axis_kinds(machine.chain);
  ASSERT_TRUE(kinds.rotary.at(3));
  EXPECT_EQ(limits_of_setup(machine, 3).acceleration, 1367);
  const MachineFile stated = with("acceleration_rad_per_s2 = 4.0", "", "trunnion");
  EXPECT_EQ(limits(stated, 3).acceleration, 2734);
  EXPECT_EQ(limits(stated, 0).acceleration, 0);
}

TEST(OffsetSettings, LessThanAUnitIsRefusedWithTheField) {
  MachineFile machine = with("acceleration_mm_per_s2 = 200.0");
  machine.correction.tick_hz = 16'000.0;
  EXPECT_THAT(sim::complaint_of([&] { return limits(machine); }),
              AllOf(HasSubstr("acceleration_mm_per_s2"), HasSubstr("62.5 us"),
                    HasSubstr("acceleration_too_small")));
}

std::string refusal_at(MachineFile machine, double tick_hz) {
  machine.correction.tick_hz = tick_hz;
  return sim::complaint_of([&] { return limits(machine); });
}

// The field that is too small, and of which axis.
TEST(OffsetSettings, ARefusalNamesTheFieldAndTheAxis) {
  EXPECT_THAT(refusal_at(with("", "max_acceleration_mm_per_s2 = 5.0"), 1000.0),
              HasSubstr("axis X: a tenth of 'max_acceleration_mm_per_s2' = 0.5 every 1000 us"));
  EXPECT_THAT(refusal_at(with("", "spare_acceleration_mm_per_s2 = 0.5"), 1000.0),
              HasSubstr("axis X: 'spare_acceleration_mm_per_s2' = 0.5 every 1000 us"));
  EXPECT_THAT(refusal_at(with("acceleration_mm_per_s2 = 0.5"), 1000.0),
              HasSubstr("axis X: 'acceleration_mm_per_s2' = 0.5 every 1000 us"));
}

// A of the gear grinder takes no offset.
TEST(OffsetSettings, AnAxisWithoutOffsetsHasNoneToLimit) {
  const std::string text = changed(text_of_machine("l300g"), "name = \"A\"\n",
                                   "name = \"A\"\nmax_acceleration_rad_per_s2 = 0.001\n");
  EXPECT_EQ(refusal_at(parse_machine(text, "m.toml"), 1000.0), "accepted");
}

// 1 um/s are 0.01 nm in 10 us, 1 m/s 1e9 nm in a second.
TEST(OffsetSettings, ARateThatNoTickCanKeepIsRefused) {
  const auto at_rate = [](const std::string& rate) {
    return parse_machine(changed(text_of_machine("xyfz"), "rate_mm_per_s = 10.0", rate), "m.toml");
  };
  EXPECT_THAT(refusal_at(at_rate("rate_mm_per_s = 0.001"), 1e5),
              AllOf(HasSubstr("'rate_mm_per_s' = 0.001 every 10 us"), HasSubstr("less than one")));
  EXPECT_THAT(refusal_at(at_rate("rate_mm_per_s = 1001.0"), 1.0),
              AllOf(HasSubstr("'rate_mm_per_s' = 1001 every 1e+06 us"), HasSubstr("more than")));
  EXPECT_EQ(refusal_at(at_rate("rate_mm_per_s = 1000.0"), 1.0), "accepted");
}

// Twice the rate is as good as none, and a node's object ends at 2^24.
TEST(OffsetSettings, AnAccelerationBeyondTheRateIsNone) {
  MachineFile machine = with("acceleration_mm_per_s2 = 1e6");
  EXPECT_EQ(limits(machine).acceleration, 0);
  machine.correction.rate_mm_per_s = 1e4;
  machine.correction.tick_hz = 100.0;
  EXPECT_THAT(sim::complaint_of([&] { return limits(machine); }),
              AllOf(HasSubstr("axis X: 'acceleration_mm_per_s2' = 1e+06 every 10000 us"),
                    HasSubstr("more than 16777216 units of 1 nm")));
}

TEST(OffsetSettings, FieldsOutsideTheirRangeAreRefusedWithTheLine) {
  const std::string text = text_of_machine("xyfz");
  for (const char* const bad : {"-1.0", "nan", "1e7", "\"much\""}) {
    const std::string field = std::string("acceleration_mm_per_s2 = ") + bad;
    EXPECT_THAT(refusal_of(text, "\n[correction]\n", "\n[correction]\n" + field + "\n"),
                AllOf(HasSubstr("m.toml:"), HasSubstr("acceleration_mm_per_s2")))
        << bad;
  }
  for (const char* const field : {"max_acceleration_mm_per_s2", "spare_acceleration_mm_per_s2"})
    EXPECT_THAT(refusal_of(text, "\n[[axis]]\n", std::string("\n[[axis]]\n") + field + " = 0.0\n"),
                AllOf(HasSubstr("m.toml:"), HasSubstr(field)));
  EXPECT_THAT(refusal_of(text, "\n[[axis]]\n", "\n[[axis]]\nmax_acceleration_rad_per_s2 = 1.0\n"),
              HasSubstr("not for a linear axis"));
}

// At 125 µs 3 units: the effective rate is a + D_a(limit/2), here D of 100 000 by hand: S_3(d) =
// d + (d − 3) + … = 100 000 for d = 773 (n = 258, 258·773 − 3·258·257/2 = 99 975), so 776 nm per
// tick, 6.208 mm/s.
TEST(OffsetFactsOf, ALimitThatIsShortOfWayTakesRateAway) {
  OffsetLimits l;
  l.limit = 200'000;
  l.rate = 1'250;
  l.soft_rate = 1;
  l.acceleration = 3;
  const OffsetFacts f = offset_facts('X', false, l, 125e-6);
  EXPECT_NEAR(f.rate, 10.0, 1e-9);
  EXPECT_NEAR(f.effective_rate, 776.0 * 1e-6 / 125e-6, 1e-9);
  EXPECT_NEAR(f.acceleration, 192.0, 1e-9);
  EXPECT_GE(f.free, 0.1);
  EXPECT_TRUE(f.coarse());
  EXPECT_THAT(offset_text({f}), AllOf(HasSubstr("192 mm/s2"), HasSubstr("6.208 mm/s"),
                                      HasSubstr("warning: below 4")));
}

TEST(OffsetFactsOf, WithoutAccelerationThereIsNothingToWarnOf) {
  const OffsetFacts f = offset_facts('X', false, OffsetLimits{}, 1e-3);
  EXPECT_EQ(f.units, 0);
  EXPECT_EQ(f.effective_rate, f.rate);
  EXPECT_FALSE(f.coarse());
  EXPECT_THAT(offset_text({f}), AllOf(HasSubstr("any acceleration"), Not(HasSubstr("warning"))));
}

TEST(OffsetFactsOf, AMachineFileShowsThem) {
  EXPECT_THAT(short_text(with("")), HasSubstr("setup allows 200 mm/s2"));
  EXPECT_THAT(short_text(with("acceleration_mm_per_s2 = 500.0")),
              HasSubstr("offset of X: at most 10 mm/s and 500 mm/s2 (500 per period and period)"));
}

}  // namespace
}  // namespace volcomp::host
