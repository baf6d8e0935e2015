// The NC programs of the inspection of a face gear, read back: what they command, on the machine as
// it really is.

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "comp/probe/face_relief.hpp"
#include "host_sim/experiments/face_gear/inspection_program.hpp"
#include "host_sim/experiments/face_gear/machine_errors.hpp"
#include "host_sim/experiments/face_gear/traced_table.hpp"
#include "host_sim/experiments/face_gear/truth.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

// Where the axes stand after a block: words are modal.
struct FaceBlock {
  Pose pose{};
  bool probes = false;
  bool turns = false;  // names C
};

std::vector<FaceBlock> face_blocks_of(const std::string& program) {
  std::vector<FaceBlock> blocks;
  Pose pose{};
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    if (line.front() == '%' || line.front() == '(') continue;
    FaceBlock block;
    bool moves = false;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::size_t axis = std::string("XYZC").find(word.front());
      EXPECT_NE(std::string("GXYZCFM").find(word.front()), std::string::npos) << line;
      const double value = std::stod(word.substr(1));
      if (word == "G38.2") block.probes = true;
      if (axis == std::string::npos) continue;
      pose.at(axis) = axis == 3 ? value * kPi / 180.0 : value;
      block.turns = block.turns || axis == 3;
      moves = true;
    }
    block.pose = pose;
    if (moves) blocks.push_back(block);
  }
  return blocks;
}

// Both programs, of the gear where the drawing has it.
struct FacePrograms {
  explicit FacePrograms(int touches)
      : file(host::read_machine_file(host::bundled_machine("yk7280"))),
        truth(face_gear::make_yk7280_truth(file, 1)),
        gear(face_gear_of_table_3()) {
    host::require(make_face_grid(gear, face_grid_of_table_3(), grid), "grid");
    const face_gear::FaceProgramSetup setup{
        gear, grid, {file.chain, gear, face_gear::nominal_mounting()}, 0.5, touches, 1};
    const TracedErrors found = trace_errors(truth, file, face_gear::traced_plan(0.0), {true});
    before = face_blocks_of(face_gear::face_program(setup, "before", face_gear::no_face_offset));
    after = face_blocks_of(face_gear::face_program(setup, "after", [&](const Pose& q) {
      return face_gear::face_offset_at(found.built->model, q);
    }));
  }
  [[nodiscard]] Vec3 ideal(const Pose& q) const {
    return ideal_points(file.chain, q, file.chain.tool_point()).work;
  }
  [[nodiscard]] Vec3 real(const Pose& q) const {
    return ideal(q) + truth.error(q, {}, file.chain.tool_point()).position_work;
  }

  host::MachineFile file;
  TrueMachine truth;
  FaceGear gear;
  FaceGrid grid;
  std::vector<FaceBlock> before;
  std::vector<FaceBlock> after;
};

TEST(FaceProgram, TouchesThirtyPointsTwoMapsAndAllTeeth) {
  const auto touches = [](const FacePrograms& p) {
    return std::count_if(p.before.begin(), p.before.end(),
                         [](const FaceBlock& b) { return b.probes; });
  };
  EXPECT_EQ(touches(FacePrograms(1)), 30 + 2 * 105 + 2 * 86);
  EXPECT_EQ(touches(FacePrograms(3)), 3 * (30 + 2 * 105 + 2 * 86));
}

// A touch would end 0.4 mm deep: 0.1 mm of its ball outside, where nothing is touched.
TEST(FaceProgram, EndsItsTouchesBehindTheFlankAndTurnsOnlyAboveTheTips) {
  const FacePrograms p(1);
  const Frame mounting = face_gear::nominal_mounting();
  const Frame to_gear{mounting.R.transpose(), -(mounting.R.transpose() * mounting.t)};
  bool begun = false;
  for (std::size_t i = 0; i < p.before.size(); ++i) {
    const FaceBlock& block = p.before[i];
    const Vec3 ball = to_gear.apply(p.ideal(block.pose));
    if (block.turns && begun) {
      EXPECT_LT(ball.z(), p.gear.z_tip - 1.0) << i;  // + is down into the gear
    }
    begun = true;
    if (!block.probes) continue;
    // The nearest flank of the slot that the ball is in.
    const double pitch = 2.0 * kPi / p.gear.teeth;
    const int slot = static_cast<int>(std::lround(std::atan2(ball.y(), ball.x()) / pitch));
    double nearest = 1e9;
    for (const int side : face_gear::kFaceSides) {
      FaceFlank flank;
      ASSERT_TRUE(choose_flank(p.gear, side, (slot + p.gear.teeth) % p.gear.teeth, flank).ok());
      nearest = std::min(nearest, distance_from_relieved_face(p.gear, flank, ball).distance);
    }
    EXPECT_NEAR(nearest, 0.1, 0.02) << i;
  }
}

// Where touches end, from where an ideal machine stands in the first program.
TEST(FaceProgram, CompensatesTheErrorsOfTheMachineInItsWords) {
  const FacePrograms p(1);
  ASSERT_EQ(p.before.size(), p.after.size());
  double uncompensated = 0.0;
  double compensated = 0.0;
  for (std::size_t i = 0; i < p.before.size(); ++i) {
    if (!p.before[i].probes) continue;
    const Vec3 wanted = p.ideal(p.before[i].pose);
    uncompensated = std::max(uncompensated, (p.real(p.before[i].pose) - wanted).norm());
    compensated = std::max(compensated, (p.real(p.after[i].pose) - wanted).norm());
  }
  EXPECT_GT(uncompensated, 3e-3);
  EXPECT_LT(compensated, 0.3e-3);
}

}  // namespace
}  // namespace volcomp::sim
