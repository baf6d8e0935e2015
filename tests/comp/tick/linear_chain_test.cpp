// Linear machines of every build: other axis orders, everything on one side, rotated fixed offsets,
// fixed bodies with constant errors. Oracle: odd part of the exact 4×4 chain.

#include "tests/oracle/exact_offsets.hpp"

namespace volcomp::test {
namespace {

constexpr JointKind kLinear = JointKind::prismatic;

MachineDescription bed() {
  MachineDescription d;
  d.body_count = 1;
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  return d;
}

std::uint8_t append(MachineDescription& d, const Body& body) {
  d.body[d.body_count] = body;
  return ++d.body_count;
}

// Bed carries the workpiece; X on Y on Z carry the tool: all axes on the tool side.
MachineDescription fxyz() {
  MachineDescription d = bed();
  const auto x = append(d, moving_body(1, kLinear, Axis::x, 1, 0, 'X', {100, -20, 300}));
  const auto y = append(d, moving_body(x, kLinear, Axis::y, 1, 1, 'Y', {-40, 60, 250}));
  d.tool_body = append(d, moving_body(y, kLinear, Axis::z, 1, 2, 'Z', {10, 20, -150}));
  d.work_body = 1;
  d.tool_point = {5, -12, -180};
  return d;
}

// All three axes under the workpiece, tool on the bed; NC signs −1.
MachineDescription xyzf() {
  MachineDescription d = bed();
  const auto z = append(d, moving_body(1, kLinear, Axis::z, -1, 2, 'Z', {0, 10, 200}));
  const auto y = append(d, moving_body(z, kLinear, Axis::y, -1, 1, 'Y', {30, -50, 120}));
  d.work_body = append(d, moving_body(y, kLinear, Axis::x, -1, 0, 'X', {-80, 15, 90}));
  d.tool_body = 1;
  d.tool_point = {150, 220, 700};
  return d;
}

// Gantry: Y under the workpiece, X and Z over it; axes numbered in another order.
MachineDescription gantry() {
  MachineDescription d = bed();
  d.work_body = append(d, moving_body(1, kLinear, Axis::y, -1, 0, 'Y', {0, 0, 150}));
  const auto x = append(d, moving_body(1, kLinear, Axis::x, 1, 2, 'X', {-300, 400, 900}));
  d.tool_body = append(d, moving_body(x, kLinear, Axis::z, 1, 1, 'Z', {0, -80, 0}));
  d.tool_point = {0, 0, -250};
  return d;
}

Body fixed_body(std::uint8_t lower, const std::array<double, 3>& offset,
                const std::array<double, 6>& error, double about_z = 0.0, double about_x = 0.0) {
  Body body;
  body.lower = lower;
  body.joint.offset = offset;
  const double cz = std::cos(about_z);
  const double sz = std::sin(about_z);
  const double cx = std::cos(about_x);
  const double sx = std::sin(about_x);
  body.joint.orientation = {cz, -sz * cx, sz * sx, sz, cz * cx, -cz * sx, 0, sx, cx};
  body.constant_error = error;
  return body;
}

// Constant errors at the root side, between axes and at both tips.
MachineDescription with_constant_errors() {
  MachineDescription d = bed();
  const auto foot = append(d, fixed_body(1, {5, 6, 7}, {2e-3, -1e-3, 3e-3, 2e-5, -3e-5, 4e-5}));
  const auto y = append(d, moving_body(foot, kLinear, Axis::y, -1, 1, 'Y', {30, -50, 120}));
  const auto between =
      append(d, fixed_body(y, {-9, 8, -7}, {-4e-3, 2e-3, 1e-3, -3e-5, 5e-5, 1e-5}));
  const auto x = append(d, moving_body(between, kLinear, Axis::x, -1, 0, 'X', {-80, 15, 90}));
  d.work_body = append(d, fixed_body(x, {1, 2, 60}, {1e-3, 1e-3, -2e-3, 4e-5, 2e-5, -5e-5}));
  const auto column = append(d, fixed_body(1, {0, 500, 0}, {0, 2e-3, 0, 3e-5, 1e-5, 2e-5}));
  const auto z = append(d, moving_body(column, kLinear, Axis::z, 1, 2, 'Z', {0, -80, 900}));
  d.tool_body = append(d, fixed_body(z, {3, -2, -40}, {1e-3, 0, 5e-3, -2e-5, 6e-5, 3e-5}));
  d.tool_point = {30, -100, -300};
  return d;
}

// Frames turned by fixed bodies: no axis along X, Y or Z of the base.
MachineDescription rotated() {
  MachineDescription d = bed();
  const auto foot = append(d, fixed_body(1, {5, 6, 7}, {}, 0.3, -0.2));
  const auto y = append(d, moving_body(foot, kLinear, Axis::y, -1, 1, 'Y', {30, -50, 120}));
  const auto x = append(d, moving_body(y, kLinear, Axis::x, -1, 0, 'X', {-80, 15, 90}));
  d.work_body = append(d, fixed_body(x, {1, 2, 60}, {1e-3, 1e-3, -2e-3, 4e-5, 2e-5, -5e-5}, 1.1));
  const auto column = append(d, fixed_body(1, {0, 500, 0}, {0, 2e-3, 0, 3e-5, 0, 2e-5}, -0.5, 0.4));
  d.tool_body = append(d, moving_body(column, kLinear, Axis::z, 1, 2, 'Z', {0, -80, 900}));
  d.tool_point = {30, -100, -300};
  return d;
}

MachineTables tables_for(const MachineDescription& d, Random& random) {
  MachineTables tables;
  tables.machine = d;
  for (std::size_t a = 0; a < 3; ++a) {
    tables.axis[a] = random_table(-250'000'000 + 70'000'001 * static_cast<std::int64_t>(a),
                                  31'234'567, 14, 20e3, 4e-5, random);
    tables.directions[a] =
        Vec3(random.in(-1e-4, 1e-4), random.in(-1e-4, 1e-4), random.in(-1e-4, 1e-4));
  }
  return tables;
}

struct LinearMachine {
  const char* name;
  MachineDescription description;
};

std::array<LinearMachine, 5> machines() {
  return {{{"fxyz", fxyz()},
           {"xyzf", xyzf()},
           {"gantry", gantry()},
           {"constants", with_constant_errors()},
           {"rotated", rotated()}}};
}

void tick_equals_first_order(const MachineDescription& d) {
  Random random(10);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = tables_for(d, random);
  LoadedRunner runner(d);
  ASSERT_TRUE(runner.start(tables).ok());
  ASSERT_TRUE(runner.compensator->machine().chain.folded);
  MachineModel model(tables, d.tool_point);
  const std::array<Real3, 3> J = jacobian(d);
  std::array<std::int64_t, kMaxAxes> q{};
  std::array<int, kMaxAxes> travel{2, 2, 2};
  double worst = 0.0;
  for (int n = 0; n < kManyPoints / 20; ++n) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t to = random.integer(-300'000'000, 350'000'000);
      if (n > 0) travel[a] = to > q[a] ? 0 : 1;
      q[a] = to;
    }
    runner.tick({q[0], q[1], q[2], 0, 0});
    model.stand_at(q, travel);
    const Real3 want = cancelling(J, model.first_order());
    for (std::size_t c = 0; c < 3; ++c) {
      const Real got = runner.out.offset[d.correcting[c]];
      worst = std::max(worst, static_cast<double>(std::abs(got - want[c])));
    }
    ASSERT_LT(worst, 1.0) << "point " << n;
  }
}

TEST(LinearChain, TickEqualsFirstOrderOfTheExactChain) {
  for (const LinearMachine& machine : machines()) {
    SCOPED_TRACE(machine.name);
    tick_equals_first_order(machine.description);
  }
}

void second_order_model_equals_exact_chain(const MachineDescription& d) {
  Random random(11);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = tables_for(d, random);
  LoadedRunner runner(d, RuntimeModel::second_order);
  ASSERT_TRUE(runner.start(tables).ok());
  ASSERT_FALSE(runner.compensator->machine().chain.folded);
  MachineModel model(tables, d.tool_point);
  const std::array<Real3, 3> J = jacobian(d);
  std::array<std::int64_t, kMaxAxes> q{};
  std::array<int, kMaxAxes> travel{2, 2, 2};
  double worst = 0.0;
  for (int n = 0; n < kManyPoints / 20; ++n) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t to = random.integer(-300'000'000, 350'000'000);
      if (n > 0) travel[a] = to > q[a] ? 0 : 1;
      q[a] = to;
    }
    runner.tick({q[0], q[1], q[2], 0, 0});
    model.stand_at(q, travel);
    const Real3 want = cancelling(J, model.exact());
    for (std::size_t c = 0; c < 3; ++c) {
      const Real got = runner.out.offset[d.correcting[c]];
      worst = std::max(worst, static_cast<double>(std::abs(got - want[c])));
    }
    ASSERT_LT(worst, 1.0) << "point " << n;
  }
}

TEST(LinearChain, SecondOrderModelEqualsTheExactChain) {
  for (const LinearMachine& machine : machines()) {
    SCOPED_TRACE(machine.name);
    second_order_model_equals_exact_chain(machine.description);
  }
}

// What the tick computes never exceeds what was promised at load time.
void bound_covers_every_error(const MachineDescription& d) {
  Random random(12);
  SCOPED_TRACE(random.trace());
  MachineTables tables = tables_for(d, random);
  for (AxisTable& table : tables.axis) {  // as little as possible besides constants and squareness
    for (auto& column : table.value)
      column.fill({});
  }
  for (const RuntimeModel model : {RuntimeModel::folded, RuntimeModel::second_order}) {
    LoadedRunner runner(d, model);
    ASSERT_TRUE(runner.start(tables).ok());
    const double bound = runner.compensator->fold_report().bound_nm;
    for (int n = 0; n < 2'000; ++n) {
      runner.tick({random.integer(-300'000'000, 350'000'000),
                   random.integer(-300'000'000, 350'000'000),
                   random.integer(-300'000'000, 350'000'000), 0, 0});
      for (const float e : runner.compensator->last_error_nm())
        ASSERT_LE(std::abs(static_cast<double>(e)), bound * (1.0 + 1e-6) + 1e-3);
    }
  }
}

TEST(LinearChain, LoadTimeBoundCoversEveryError) {
  for (const LinearMachine& machine : machines()) {
    SCOPED_TRACE(machine.name);
    bound_covers_every_error(machine.description);
  }
}

}  // namespace
}  // namespace volcomp::test
