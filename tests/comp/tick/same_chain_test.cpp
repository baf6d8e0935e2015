// Tables may run on a machine only when nothing that the tick relies on differs.

#include <algorithm>
#include <functional>

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

// base → table X, and base → arm (fixed, tilted, with errors) → Y → C with the tool; beside it a
// column that carries neither.
MachineDescription machine() {
  MachineDescription m;
  m.body[1] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X');
  m.body[2].lower = 1;
  m.body[2].joint.orientation = {1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8};
  m.body[2].constant_error = {1e-3, 0, 0, 0, 2e-5, 0};
  m.body[3] = moving_body(3, JointKind::prismatic, Axis::y, 1, 1, 'Y', {0, 0, 10.0});
  m.body[4] = moving_body(4, JointKind::rotary, Axis::z, 1, 2, 'C');
  m.body[5].lower = 1;
  m.body_count = 6;
  m.work_body = 2;
  m.tool_body = 5;
  m.correcting = {0, 1};
  m.correcting_count = 2;
  return m;
}

struct Difference {
  const char* what;
  std::function<void(MachineDescription&)> make;
};

const Difference kDifferences[] = {
    {"a body less on the way", [](auto& m) { m.tool_body = 4; }},
    {"tool and work exchanged", [](auto& m) { std::swap(m.tool_body, m.work_body); }},
    {"another axis beside the way",
     [](auto& m) { m.body[5] = moving_body(1, JointKind::prismatic, Axis::z, 1, 3, 'W'); }},
    {"one that corrects less", [](auto& m) { m.correcting_count = 1; }},
    {"others that correct",
     [](auto& m) {
       m.correcting = {0, 2};
     }},
    {"the order in which they correct",
     [](auto& m) {
       m.correcting = {1, 0};
     }},
    {"a kind of joint", [](auto& m) { m.body[4].joint.kind = JointKind::prismatic; }},
    {"an axis of motion", [](auto& m) { m.body[3].joint.axis = Axis::z; }},
    {"numbers of axes",
     [](auto& m) { std::swap(m.body[1].joint.nc_axis, m.body[3].joint.nc_axis); }},
    {"a sense", [](auto& m) { m.body[3].joint.sign = -1; }},
    {"an offset", [](auto& m) { m.body[3].joint.offset[2] = 10.001; }},
    {"an offset to the other side", [](auto& m) { m.body[3].joint.offset[2] = 9.999; }},
    {"a tilt", [](auto& m) { m.body[2].joint.orientation = {1, 0, 0, 0, 1, 0, 0, 0, 1}; }},
    {"a constant error", [](auto& m) { m.body[2].constant_error[4] = 3e-5; }},
};

TEST(SameChain, AnyDifferenceCountsEitherWay) {
  const RuntimeChain chain = make_runtime_chain(machine());
  EXPECT_TRUE(same_chain(chain, make_runtime_chain(machine())));
  for (const Difference& difference : kDifferences) {
    MachineDescription other = machine();
    difference.make(other);
    const RuntimeChain changed = make_runtime_chain(other);
    EXPECT_FALSE(same_chain(chain, changed)) << difference.what;
    EXPECT_FALSE(same_chain(changed, chain)) << difference.what;
  }
}

// Letters and what lies beside the way do not reach the tick.
TEST(SameChain, NamesAndWhatCarriesNothingDoNotCount) {
  MachineDescription other = machine();
  other.body[1].joint.letter = 'U';
  other.body[5].joint.offset[0] = 5.0;
  other.correcting[2] = 7;
  EXPECT_TRUE(same_chain(make_runtime_chain(machine()), make_runtime_chain(other)));
}

}  // namespace
}  // namespace volcomp::test
