// A touch with the node elsewhere is the touch with the node in this process.

#include <gtest/gtest.h>

#include "host_sim/host/bus/links/pipe_link.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "tests/host_sim/host/bus/linux_node.hpp"
#include "tests/host_sim/sim/artefacts/plane.hpp"

namespace volcomp::sim {
namespace {

using test::Plane;

// The ball goes along −Y into a wall.
Touch touch_wall(const host::MachineFile& file, std::unique_ptr<BusAxes> axes) {
  constexpr Pose kBegin{0.0, 233.0, -0.68, 0.0};
  constexpr Pose kBeyond{0.0, 229.0, -0.68, 0.0};
  TrueMachine truth;
  truth.chain = file.chain;
  const Plane wall({0.0, 62.0, 0.0}, Vec3::UnitY());
  axes->mount(TouchProbe(truth, wall, {file.probe->radius_mm, {}, 10'000, {}}));
  MotionCell cell(truth, std::move(axes));
  cell.place(kBegin);
  return cell.probe_to(kBeyond, 1000.0 / 60.0, kBegin, 20.0);
}

TEST(TouchThroughGateway, IsTheSameTouch) {
  const host::MachineFile file = host::read_machine_file(host::bundled_machine("l300g"));
  const host::BusSettings settings = host::bus_settings(file, kBusCycleOfFive_hz);
  const std::vector<std::uint8_t> no_tables;
  const Touch here = touch_wall(file, std::make_unique<BusAxes>(settings, no_tables));

  const host::TemporaryFolder folder;
  const host::PipeNode node(folder.path());
  host::PipeLink link(folder.path());
  CanGateway gateway(link);
  const Touch there = touch_wall(file, std::make_unique<BusAxes>(settings, no_tables, gateway));

  EXPECT_TRUE(here.touched);
  EXPECT_TRUE(there.touched);
  EXPECT_EQ(here.latched, there.latched);
  EXPECT_EQ(here.latch, there.latch);
}

}  // namespace
}  // namespace volcomp::sim
