#pragma once
// The machines that hostile images are made from: one of every kind that is compiled in or loaded.

#include <vector>

#include "comp/metrology/gears/internal_grinder.hpp"
#include "tests/oracle/hostile_image.hpp"
#include "tests/oracle/l300g_machine.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {

// X, Y, Z and a table on a trunnion A, C; A and C hold the direction of the tool.
inline MachineDescription hostile_trunnion(bool orients) {
  MachineDescription d;
  d.body_count = 6;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::y, -1, 1, 'Y', {10, 20, 30});
  d.body[2] = moving_body(2, JointKind::rotary, Axis::x, 1, 3, 'A', {1, 2, 50});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::z, 1, 4, 'C', {0.5, 0.1, 20});
  d.body[4] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X', {5, 6, 400});
  d.body[5] = moving_body(5, JointKind::prismatic, Axis::z, 1, 2, 'Z', {7, 8, 9});
  d.work_body = 4;
  d.tool_body = 6;
  d.tool_point = {0, 0, -120};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  d.orienting = {3, 4};
  d.orienting_count = orients ? 2 : 0;
  return d;
}

// The first is the one that is compiled in.
inline std::vector<MachineDescription> hostile_machines() {
  return {kXyfzMachine,
          l300g_machine({}, {}),
          internal_grinder(GrinderY::none),
          internal_grinder(GrinderY::on_z),
          hostile_trunnion(false),
          hostile_trunnion(true)};
}

// Few knots: more of the mutations meet the geometry. On a machine without measured angles
// `epsilon` is 0.
inline MachineTables small_tables(const MachineDescription& machine, Random& random,
                                  double epsilon = 2e-5) {
  MachineTables t;
  t.machine = machine;
  for (std::size_t k = 0; k < machine.body_count; ++k) {
    const Joint& joint = machine.body[k].joint;
    if (!joint.moves()) continue;
    const bool turns = joint.kind == JointKind::rotary;
    t.axis[joint.nc_axis] = turns
                                ? random_table(0, kTurn / 4, 4, 8e3, epsilon, random)
                                : random_table(-400'000'000, 200'000'000, 5, 8e3, epsilon, random);
    t.axis[joint.nc_axis].periodic = turns;
  }
  return t;
}

// Two images of every machine, with and without measured angles.
inline std::vector<ImageBytes> hostile_seeds(Random& random) {
  std::vector<ImageBytes> images;
  for (const MachineDescription& machine : hostile_machines()) {
    for (const double epsilon : {2e-5, 0.0})
      images.push_back(image_bytes(small_tables(machine, random, epsilon)));
  }
  return images;
}

// Whether seed `i` is one of the machine that is compiled in.
constexpr bool is_compiled_in(std::size_t i) { return i < 2; }

}  // namespace volcomp::test
