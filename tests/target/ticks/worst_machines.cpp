#include "tests/target/ticks/worst_machines.hpp"

#include "comp/core/units.hpp"
#include "tests/target/ticks/draw.hpp"

namespace volcomp::target {
namespace {

// Turned about Z by the angle whose half has this tangent: no library, so the same bits everywhere.
void tilt(Joint& joint, double half_tangent) {
  const double scale = 1.0 / (1.0 + half_tangent * half_tangent);
  const double c = (1.0 - half_tangent * half_tangent) * scale;
  const double s = 2.0 * half_tangent * scale;
  joint.orientation = {c, -s, 0, s, c, 0, 0, 0, 1};
}

// Hangs a fixed body with an error on `lower` and returns its number.
std::uint8_t hang_fixed_body(MachineDescription& machine, std::uint8_t lower) {
  Body& body = machine.body[machine.body_count++];
  body.lower = lower;
  body.joint.kind = JointKind::fixed;
  body.joint.offset = {1.0, 2.0, 3.0};
  tilt(body.joint, 0.005);
  body.constant_error = {1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-5};
  return machine.body_count;
}

// Values between knots change by up to 8 µm and 40 µrad.
void fill(AxisTable& table, Draw& draw) {
  constexpr std::int32_t kSize = 4'000;
  constexpr std::int32_t kReversal = 400;
  for (std::size_t knot = 0; knot < table.knots; ++knot) {
    for (std::size_t c = 0; c < 6; ++c) {
      const auto drawn = static_cast<std::int32_t>(draw.below(2 * kSize + 1)) - kSize;
      const float unit = c < 3 ? 1.0F : 5e-9F;  // nm, rad
      table.value[0][knot][c] = static_cast<float>(drawn) * unit;
      table.value[1][knot][c] = static_cast<float>(drawn + kReversal) * unit;
    }
  }
}

// Few knots, which cost a tick as much as many: tables are folded often.
void set_grid(AxisTable& table, bool rotary, bool periodic) {
  constexpr std::int64_t kMillimetre = 1'000'000;
  table.periodic = rotary && periodic;
  if (!rotary) {
    table.q0 = -150 * kMillimetre;
    table.pitch = kMillimetre * 25 / 4;
    table.knots = 21;
  } else if (periodic) {
    table.q0 = 0;
    table.pitch = kUnitsPerTurn / 32;
    table.knots = 32;
  } else {
    table.q0 = -kUnitsPerTurn / 4;
    table.pitch = kUnitsPerTurn / 32;
    table.knots = 17;
  }
}

std::unique_ptr<MachineTables> make_set(const MachineDescription& machine, Draw& draw) {
  auto set = std::make_unique<MachineTables>();
  set->machine = machine;
  set->directions = zero_directions();
  bool periodic = false;
  for (std::size_t b = 0; b < machine.body_count; ++b) {
    const Joint& joint = machine.body[b].joint;
    if (!joint.moves()) continue;
    const bool rotary = joint.kind == JointKind::rotary;
    AxisTable& table = set->axis[joint.nc_axis];
    set_grid(table, rotary, periodic);
    fill(table, draw);
    periodic = periodic || rotary;
  }
  return set;
}

}  // namespace

MachineDescription orienting_five_axis() {
  MachineDescription machine = bench::kFiveAxis;
  machine.orienting = {3, 4};
  machine.orienting_count = 2;
  return machine;
}

MachineDescription askew_five_axis() {
  MachineDescription machine = bench::kFiveAxis;
  machine.body[1].joint.offset = {1.0, 2.0, 3.0};
  for (std::size_t b = 1; b < machine.body_count; ++b)
    tilt(machine.body[b].joint, 0.025 * static_cast<double>(b));
  return machine;
}

MachineDescription askew_five_axis_with_fixed_bodies() {
  MachineDescription machine = askew_five_axis();
  machine.tool_body = hang_fixed_body(machine, machine.tool_body);
  machine.work_body = hang_fixed_body(machine, machine.work_body);
  return machine;
}

MachineDescription eight_axis() {
  constexpr std::array<char, kMaxAxes> kLetters{'X', 'Y', 'Z', 'A', 'B', 'C', 'U', 'V'};
  constexpr std::array<Axis, kMaxAxes> kAxes{Axis::x, Axis::y, Axis::z, Axis::x,
                                             Axis::y, Axis::z, Axis::x, Axis::y};
  MachineDescription machine;
  machine.body_count = kMaxAxes + 1;
  for (std::uint8_t a = 0; a < kMaxAxes; ++a) {
    Body& body = machine.body[a + 1U];
    body.lower = a == 5 ? std::uint8_t{1} : static_cast<std::uint8_t>(a + 1);
    body.joint.kind = a >= 3 && a <= 5 ? JointKind::rotary : JointKind::prismatic;
    body.joint.axis = kAxes[a];
    body.joint.nc_axis = a;
    body.joint.letter = kLetters[a];
    body.joint.sign = a < 5 ? std::int8_t{1} : std::int8_t{-1};
    body.joint.offset = {20.0 * a, 150.0 - 30.0 * a, 310.0};
  }
  machine.tool_body = 6;
  machine.work_body = 9;
  machine.tool_point = {-173.7, 12.0, 30.0};
  machine.correcting = {0, 1, 2};
  machine.correcting_count = 3;
  return machine;
}

TwoTables make_worst_tables(const MachineDescription& machine) {
  Draw draw;
  TwoTables tables;
  tables.one = make_set(machine, draw);
  tables.other = make_set(machine, draw);
  return tables;
}

}  // namespace volcomp::target
