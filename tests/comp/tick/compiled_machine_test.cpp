// A machine described as a constant is walked by the compiler: everything about it is known there.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using Xyfz = CompiledMachine<kXyfzMachine>;

static_assert(Xyfz::kAxes == 3);
static_assert(Xyfz::kCompiledIn);
static_assert(Xyfz::chain.steps == 3 && Xyfz::chain.tool_steps == 1);
static_assert(Xyfz::chain.folded);
static_assert(!Xyfz::chain.has_orientation && !Xyfz::chain.has_constant_error);
// Walk: tool tip → base, then base → work tip: Z, then Y, then X.
static_assert(Xyfz::chain.step[0].axis == Axis::z && !Xyfz::chain.step[0].work);
static_assert(Xyfz::chain.step[1].axis == Axis::y && Xyfz::chain.step[1].work);
static_assert(Xyfz::chain.step[2].axis == Axis::x && Xyfz::chain.step[2].work);
static_assert(Xyfz::chain.letter[0] == 'X' && Xyfz::chain.letter[1] == 'Y' &&
              Xyfz::chain.letter[2] == 'Z');
static_assert(Xyfz::chain.kind[2] == JointKind::prismatic);
// Tool relative to work moves +1 with every NC coordinate: −1 (branch) · −1 (sign) for X and Y.
static_assert(Xyfz::chain.inverse.form == InverseForm::aligned);
static_assert(Xyfz::chain.inverse.gain[0] > 0.5F && Xyfz::chain.inverse.gain[1] > 0.5F &&
              Xyfz::chain.inverse.gain[2] > 0.5F);
static_assert(Xyfz::chain.inverse.component[0] == 0 && Xyfz::chain.inverse.component[1] == 1 &&
              Xyfz::chain.inverse.component[2] == 2);

constexpr MachineDescription rotary_machine() {
  MachineDescription d;
  d.body_count = 3;
  d.body[1].lower = 1;
  d.body[1].joint.kind = JointKind::prismatic;
  d.body[1].joint.letter = 'X';
  d.body[2].lower = 2;
  d.body[2].joint.kind = JointKind::rotary;
  d.body[2].joint.axis = Axis::y;
  d.body[2].joint.nc_axis = 1;
  d.body[2].joint.letter = 'B';
  d.body[2].joint.offset = {0, 0, 50};
  d.work_body = 1;
  d.tool_body = 3;
  d.tool_point = {-100, 0, 0};
  d.correcting = {0, 1};
  d.correcting_count = 2;
  return d;
}
constexpr MachineDescription kRotary = rotary_machine();
using Rotary = CompiledMachine<kRotary>;

static_assert(Rotary::kAxes == 2);
static_assert(!Rotary::chain.folded, "a rotary axis needs the recursion");
static_assert(Rotary::chain.inverse.form == InverseForm::general);
static_assert(Rotary::chain.kind[1] == JointKind::rotary);
static_assert(Rotary::chain.step[0].has_offset && !Rotary::chain.step[1].has_offset);
static_assert(CompiledMachine<kXyfzMachine, RuntimeModel::second_order>::chain.folded == false);
static_assert(!CompiledMachine<kRotary, RuntimeModel::folded>::chain.folded,
              "the sum is defined for linear axes only");

// The same bits whether the recursion is unrolled by the compiler or walked at run time.
TEST(CompiledMachine, RotaryMachineEqualsTheLoadedOne) {
  Random random(110);
  SCOPED_TRACE(random.trace());
  MachineTables tables;
  tables.machine = kRotary;
  tables.axis[0] = random_table(-100'000'000, 20'000'000, 11, 10e3, 5e-5, random);
  tables.axis[1] = random_table(-kTurn / 6, kTurn / 60, 21, 10e3, 5e-5, random);
  tables.directions[0] = Vec3(1e-5, 2e-5, -3e-5);
  Runner<Compensator<Rotary>> compiled;
  LoadedRunner loaded(kRotary);
  ASSERT_TRUE(compiled.start(tables).ok());
  ASSERT_TRUE(loaded.start(tables).ok());
  for (int n = 0; n < 100'000; ++n) {
    const std::int64_t x = random.integer(-110'000'000, 110'000'000);
    const std::int64_t b = random.integer(-kTurn / 5, kTurn / 5);
    compiled.tick({x, b});
    loaded.tick({x, b, 0, 0, 0});
    for (std::size_t a = 0; a < 2; ++a) {
      ASSERT_EQ(compiled.out.offset[a], loaded.out.offset[a]) << "point " << n;
      ASSERT_EQ(compiled.out.status[a], loaded.out.status[a]) << "point " << n;
    }
  }
}

TEST(CompiledMachine, SecondOrderXyfzEqualsTheLoadedOne) {
  Random random(111);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  Runner<Compensator<CompiledMachine<kXyfzMachine, RuntimeModel::second_order>>> compiled;
  LoadedRunner loaded(kXyfzMachine, RuntimeModel::second_order);
  ASSERT_TRUE(compiled.start(tables).ok());
  ASSERT_TRUE(loaded.start(tables).ok());
  for (int n = 0; n < 100'000; ++n) {
    const std::int64_t x = random.integer(-510'000'000, 10'000'000);
    const std::int64_t y = random.integer(-310'000'000, 10'000'000);
    const std::int64_t z = random.integer(-410'000'000, 10'000'000);
    compiled.tick({x, y, z});
    loaded.tick({x, y, z, 0, 0});
    for (std::size_t a = 0; a < 3; ++a)
      ASSERT_EQ(compiled.out.offset[a], loaded.out.offset[a]) << "point " << n;
  }
}

}  // namespace
}  // namespace volcomp::test
