// Touches on flanks of a face gear, through drives, latches, bus and node: the node judges them as
// this computer does.

#include <gtest/gtest.h>

#include "comp/metrology/faces/face_grid.hpp"
#include "comp/probe/face_touch.hpp"
#include "firmware/node/probe/flank_probe.hpp"
#include "host_sim/experiments/face_gear/machine_errors.hpp"
#include "host_sim/experiments/face_gear/station.hpp"
#include "host_sim/experiments/face_gear/truth.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "tests/system/true_tables.hpp"

namespace volcomp::sim {
namespace {

TEST(Flanks, AreJudgedByTheNodeAsTheyAreHere) {
  const host::MachineFile file = host::read_machine_file(host::bundled_machine("yk7280"));
  const face_gear::FaceHall hall{file,
                                 face_gear::make_yk7280_truth(file, 1),
                                 face_gear_of_table_3(),
                                 face_gear::nominal_mounting(),
                                 {},
                                 loopback_axes()};
  const MachineTables tables = true_tables(hall.truth, file);
  FaceGrid grid;
  ASSERT_TRUE(make_face_grid(hall.gear, face_grid_of_table_3(), grid).ok());
  face_gear::FaceStation station(hall, tables, face_gear::nominal_mounting());
  const double radius = file.probe->radius_mm;
  for (const face_gear::FlankName& name :
       {face_gear::FlankName{1, 0}, face_gear::FlankName{-1, 0}, face_gear::FlankName{1, 43}}) {
    for (const std::size_t row : {0U, 3U, 6U}) {
      const FaceGridNode& node = grid[row][7];
      const face_gear::FaceStationTouch found =
          station.touch(name, {node.point, node.normal}, row, 7);
      FaceFlank flank;
      ASSERT_TRUE(choose_flank(hall.gear, name.side, name.slot, flank).ok());
      const FaceTouch here =
          judge_touch(hall.gear, flank, {radius, face_gear::kGate_mm}, found.ball);
      EXPECT_EQ(found.judgement.verdict, Reason::ok);
      EXPECT_EQ(found.judgement.verdict, here.verdict);
      EXPECT_EQ(found.judgement.foot, here.foot.reason);
      EXPECT_EQ(found.judgement.distance_nm, node::distance_nm(here.distance));
      EXPECT_NEAR(here.distance, radius, 0.02);
    }
  }
}

}  // namespace
}  // namespace volcomp::sim
