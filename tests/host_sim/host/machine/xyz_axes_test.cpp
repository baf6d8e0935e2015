// Coordinates of machines with axes in another order, on another side or in another sense.

#include "host_sim/host/machine/xyz_axes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

// `axes`: of the form "name = "X", travel_mm = [0.0, 1.0], …", without what all have in common.
MachineFile machine(const std::string& chain, const std::vector<std::string>& axes,
                    const std::string& correcting) {
  std::string list;
  for (const std::string& axis : axes)
    list += fmt::format("  {{ {}, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 }},\n", axis);
  return parse_machine(
      fmt::format("name = \"m\"\nid = 1\nconvention = \"relative\"\nside = \"moving\"\n"
                  "chain = \"{}\"\ntool = {{ point_mm = [0.0, 0.0, -100.0] }}\n"
                  "correction = {{ axes = [{}] }}\naxis = [\n{}]\n",
                  chain, correcting, list),
      "m.toml");
}

const std::string kX = R"(name = "X", travel_mm = [-10.0, 20.0], reference_mm = 0.0)";
const std::string kY = R"(name = "Y", travel_mm = [-30.0, 40.0], reference_mm = 0.0)";
const std::string kZ = R"(name = "Z", travel_mm = [-50.0, -5.0], reference_mm = -5.0)";
const std::string kC = R"(name = "C", travel_rad = [-1.0, 1.0], reference_rad = 0.0)";

TEST(XyzAxes, FindsItsAxesInAnyOrder) {
  const XyzAxes axes(machine("w-b-Y-X-Z-C-t", {kC, kZ, kX, kY}, R"("X", "Y", "Z")"));
  EXPECT_EQ(axes.count(), 3U);
  EXPECT_EQ(axes.travel().lo, Vec3(-10.0, -30.0, -50.0));
  EXPECT_EQ(axes.travel().hi, Vec3(20.0, 40.0, -5.0));
  const Pose q = axes.pose(Vec3(1.0, 2.0, -7.0));
  EXPECT_THAT((std::array<double, 4>{q[0], q[1], q[2], q[3]}),
              testing::ElementsAre(0.0, -7.0, 1.0, 2.0));
  EXPECT_EQ(axes.diagonals(false).size(), 4U);
  EXPECT_EQ(axes.diagonals(true).size(), 10U);
}

// ISO 841: a coordinate counts the tool against the work, unless the axis runs the other way.
TEST(XyzAxes, WaysAreThoseOfTheToolRelativeToTheWork) {
  for (const char* chain : {"w-X-Y-b-Z-t", "w-b-Z-Y-X-t", "w-Z-Y-X-b-t"}) {
    const XyzAxes axes(machine(chain, {kX, kY, kZ}, R"("X", "Y", "Z")"));
    EXPECT_EQ(axes.in_work(Vec3(1.0, 2.0, 3.0)), Vec3(1.0, 2.0, 3.0)) << chain;
  }
  const XyzAxes against(machine("w-X-b-Y-Z-t", {kX + ", sign = 1", kY, kZ}, R"("X", "Y", "Z")"));
  EXPECT_EQ(against.in_work(Vec3(1.0, 2.0, 3.0)), Vec3(-1.0, 2.0, 3.0));
}

TEST(XyzAxes, AMissingAxisStaysAtZero) {
  const XyzAxes axes(machine("w-b-Z-X-t", {kX, kZ}, R"("X", "Z")"));
  EXPECT_FALSE(axes.has(1));
  EXPECT_EQ(axes.travel().hi, Vec3(20.0, 0.0, -5.0));
  EXPECT_EQ(axes.pose(Vec3(1.0, 2.0, -7.0))[1], -7.0);
  std::vector<std::string> names;
  for (const Diagonal& d : axes.diagonals(false))
    names.emplace_back(d.name);
  EXPECT_THAT(names, testing::ElementsAre("XZ+", "XZ-"));
}

TEST(XyzAxes, OneAxisHasNoDiagonal) {
  const XyzAxes axes(machine("w-b-Z-t", {kZ}, R"("Z")"));
  EXPECT_THAT(sim::complaint_of([&] { static_cast<void>(axes.diagonals(true)); }),
              testing::HasSubstr("m.toml: a diagonal needs at least two of the linear axes X, Y "
                                 "and Z, this machine has 1"));
}

}  // namespace
}  // namespace volcomp::host
