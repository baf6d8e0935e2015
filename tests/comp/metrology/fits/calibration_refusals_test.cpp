// What fits of circles, spheres, bodies, axes and face gears refuse, and that a refusal leaves the
// old result.

#include <cmath>
#include <limits>
#include <vector>

#include "comp/metrology/faces/face_angle.hpp"
#include "comp/metrology/faces/face_frame.hpp"
#include "comp/metrology/fits/circle_fit.hpp"
#include "comp/metrology/fits/lobing_fit.hpp"
#include "comp/metrology/fits/printed_procedure.hpp"
#include "comp/metrology/fits/sphere_fit.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/axis_identification.hpp"
#include "tests/oracle/face_gears.hpp"
#include "tests/oracle/stylus.hpp"

namespace volcomp::test {
namespace {

// --- circles and spheres

TEST(CircleFitRefusal, AYThatIsNoNumberIsNamed) {
  const std::vector<double> y{0.0, 1.0, kInfinite, 3.0};
  const std::vector<double> z{1.0, 0.0, 1.0, 2.0};
  CircleFit fit;
  const Status s = fit_circle(y, z, fit);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 2);
}

TEST(CircleFitRefusal, PointsAboveEachOtherAreALineAndNotOnePlace) {
  const std::vector<double> alike{5.0, 5.0, 5.0, 5.0};
  const std::vector<double> rising{0.0, 1.0, 2.0, 3.0};
  CircleFit fit;
  EXPECT_EQ(fit_circle(alike, rising, fit).reason, Reason::collinear);
  EXPECT_EQ(fit_circle(alike, alike, fit).reason, Reason::coincident);
}

// A sagitta of 0.5 µm: the steps end by their number, and the fit is still the best there is.
TEST(CircleFit, AnArcOfSixMinutesStillEnds) {
  std::vector<double> y;
  std::vector<double> z;
  for (int i = -10; i <= 10; ++i) {
    const double turn = 1e-4 * i;
    y.push_back(20.0 + 1000.0 * std::cos(turn));
    z.push_back(1000.0 * std::sin(turn) + 1e-7 * std::sin(7.0 * i));
  }
  CircleFit fit;
  ASSERT_TRUE(fit_circle(y, z, fit).ok());
  EXPECT_LT(fit.rms, 2e-7);
  EXPECT_NEAR(fit.geometric.radius, 1000.0, 10.0);
}

TEST(SphereFit, FourPointsLieOnItExactly) {
  const std::vector<Vec3> four{{3, 0, 0}, {1, 2, 0}, {1, 0, 2}, {-1, 0, 0}};
  SphereFit fit;
  ASSERT_TRUE(fit_sphere(four, fit).ok());
  EXPECT_NEAR((fit.sphere.centre - Vec3(1, 0, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR(fit.sphere.radius, 2.0, 1e-14);
  EXPECT_NEAR(fit.rms, 0.0, 1e-14);
}

TEST(SphereFit, ACapOfAMilliradianStillEnds) {
  std::vector<Vec3> cap{{0.0, 0.0, 1000.0}};
  for (int i = 0; i < 24; ++i) {
    const double round = 2.0 * kPi * i / 24.0;
    const double turn = 1e-3 * (1.0 + i % 3);
    cap.emplace_back(1000.0 * std::sin(turn) * std::cos(round),
                     1000.0 * std::sin(turn) * std::sin(round),
                     1000.0 * std::cos(turn) + 1e-7 * std::sin(5.0 * i));
  }
  SphereFit fit;
  ASSERT_TRUE(fit_sphere(cap, fit).ok());
  EXPECT_LT(fit.rms, 2e-7);
  EXPECT_NEAR(fit.sphere.radius, 1000.0, 10.0);
}

TEST(LobingRefusal, ADirectionThatIsNoNumberIsNamed) {
  const std::vector<Vec3> directions{{1, 0, 0}, {0, kNan, 0}};
  const std::vector<double> radius{1.0, 1.0};
  LobingFit fit;
  const Status s = fit_lobing(directions, radius, fit);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 1);
}

TEST(ContactPointRefusal, AnythingThatIsNoNumber) {
  Vec3 out(7, 7, 7);
  const Vec3 good(1, 2, 3);
  const Vec3 bad(1, kNan, 3);
  EXPECT_EQ(contact_point(bad, good, 1.0, out).reason, Reason::not_finite);
  EXPECT_EQ(contact_point(good, bad, 1.0, out).reason, Reason::not_finite);
  EXPECT_EQ(contact_point(good, good, kInfinite, out).reason, Reason::not_finite);
  EXPECT_EQ(contact_point(good, Vec3::Zero(), 1.0, out).reason, Reason::zero_normal);
  EXPECT_EQ(out, Vec3(7, 7, 7));
}

// --- targets of an axis

TEST(RigidFitRefusal, NoneTooManyUnequalAndNotFinite) {
  const std::vector<Vec3> many(kMaxTargets + 1, Vec3::Ones());
  const std::vector<Vec3> none;
  std::vector<Vec3> some{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  RigidFit fit;
  fit.rms = 7.0;
  EXPECT_EQ(fit_rigid(some, many, fit).reason, Reason::length_mismatch);
  EXPECT_EQ(fit_rigid(none, none, fit).reason, Reason::too_few_points);
  EXPECT_EQ(fit_rigid(many, many, fit).reason, Reason::too_many_runs);
  std::vector<Vec3> displaced(some.size(), Vec3::Zero());
  displaced[2].z() = kNan;
  const Status s = fit_rigid(some, displaced, fit);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 2);
  EXPECT_EQ(fit.rms, 7.0);
}

TEST(BadTargets, MotionsAreAsManyAsNodesAndTargetsNotTooMany) {
  const Joint x{JointKind::prismatic, Axis::x, 1, Branch::tool, 0, 'X'};
  const std::vector<double> nodes{0.0, 100.0};
  std::vector<ErrorMotion> motion(1, ErrorMotion::Constant(7.0));
  const std::vector<Vec3> few(4, Vec3::Ones());
  const std::vector<Vec3> twice(2 * few.size(), Vec3::Ones());
  EXPECT_EQ(identify_axis({}, x, {nodes, few, twice}, {motion.data(), 1}).reason,
            Reason::length_mismatch);
  const std::vector<Vec3> many(kMaxTargets + 1, Vec3::Ones());
  const std::vector<Vec3> many_twice(2 * many.size(), Vec3::Ones());
  motion.resize(2, motion[0]);
  EXPECT_EQ(identify_axis({}, x, {nodes, many, many_twice}, {motion.data(), 2}).reason,
            Reason::length_mismatch);
  EXPECT_EQ(motion[0], ErrorMotion::Constant(7.0));
}

// Base, a slide X, a bracket that does not move, slides Y and Z on it.
MachineChain slides_on_a_bracket() {
  MachineDescription d;
  d.body_count = 5;
  const std::array<Joint, 5> joints{{{JointKind::fixed, Axis::x, 1, Branch::none, 0, '\0'},
                                     {JointKind::prismatic, Axis::x, 1, Branch::tool, 0, 'X'},
                                     {JointKind::fixed, Axis::x, 1, Branch::tool, 0, '\0'},
                                     {JointKind::prismatic, Axis::y, 1, Branch::tool, 1, 'Y'},
                                     {JointKind::prismatic, Axis::z, 1, Branch::tool, 2, 'Z'}}};
  for (std::size_t k = 0; k < joints.size(); ++k) {
    d.body[k].joint = joints[k];
    d.body[k].lower = static_cast<std::uint8_t>(k);
  }
  d.work_body = 1;
  d.tool_body = 5;
  MachineChain chain;
  EXPECT_TRUE(MachineChain::build(d, chain).ok());
  return chain;
}

TEST(Order, OfTwoAxesThatHaveMovedTheOneNextToTheBaseIsNamed) {
  const MachineChain chain = slides_on_a_bracket();
  const Pose reference{};
  const Pose both{10.0, 20.0, 0.0};
  const Status s = check_order(chain, 2, 0, both, reference);
  EXPECT_EQ(s.reason, Reason::parent_not_identified);
  EXPECT_EQ(s.where.axis, 'X');
  EXPECT_EQ(check_order(chain, 2, 0b001, both, reference).where.axis, 'Y');
  EXPECT_TRUE(check_order(chain, 2, 0b011, both, reference).ok()) << "a bracket needs no errors";
}

TEST(PrintedProcedureRefusal, ReadingsAndStartsThatAreNoNumbers) {
  ReadingFigures figures;
  figures.range = 7.0;
  const std::vector<double> none;
  std::vector<double> readings{0.1, 0.2, kNan};
  EXPECT_EQ(reading_figures(none, figures).reason, Reason::too_few_points);
  const Status s = reading_figures(readings, figures);
  EXPECT_EQ(s.reason, Reason::not_finite);
  EXPECT_EQ(s.where.index, 2);
  EXPECT_EQ(figures.range, 7.0);
  PrintedSolution solution;
  EXPECT_EQ(printed_x_solution(readings, 10.0, solution).reason, Reason::not_finite);
  readings.pop_back();
  EXPECT_EQ(printed_x_solution(readings, kInfinite, solution).reason, Reason::not_finite);
  EXPECT_TRUE(printed_x_solution(readings, 10.0, solution).ok());
}

// --- face gears

TEST(FaceAngleRefusal, ABallThatIsNowhereAndABallInsideTheGear) {
  const FaceGear gear = face_gear_of_table_3();
  FaceContact contact{FaceFlank{}, 0.5, Vec3(20.34, kNan, 47.0)};
  FaceAngle found;
  EXPECT_EQ(relieved_face_angle(gear, contact, 0.0, 1e-6, found).reason, Reason::not_finite);
  contact.centre = {10.0, 20.0, 47.0};
  EXPECT_EQ(relieved_face_angle(gear, contact, 0.0, 1e-6, found).reason, Reason::inside_gear_base);
}

std::vector<FaceTouchPoint> one_row(const FaceGear& plain) {
  const FaceGrid grid = grid_of(plain, face_grid_of_table_3());
  std::vector<FaceTouchPoint> points;
  for (const FaceGridNode& node : grid[0]) {
    const FacePoint on = on_flank(node, flank_of(plain, 1, 0));
    points.push_back({flank_of(plain, 1, 0), turned_by(1e-4, on.point + 0.5 * on.normal)});
  }
  return points;
}

// Touches of a flank without relief, near the tip: a fit without the relief finds the turn, one
// with it takes the relief for a turn.
TEST(FaceFrame, TheReliefIsLeftOutWhereThatIsAskedFor) {
  const FaceGear relieved = face_gear_of_table_3();
  const std::vector<FaceTouchPoint> points = one_row(without_relief(relieved));
  FaceFrameSettings settings;
  settings.ball_radius = 0.5;
  settings.relieved = false;
  FaceFrame fit;
  ASSERT_TRUE(fit_face_frame(relieved, points, settings, {}, fit).ok());
  EXPECT_NEAR(fit.frame.R(1, 0), -1e-4, 1e-9);
  EXPECT_LT(fit.rms, 1e-6);
  settings.relieved = true;
  settings.sigma = 1.0;
  FaceFrame other;
  const Status s = fit_face_frame(relieved, points, settings, {}, other);
  EXPECT_TRUE(!s.ok() || std::abs(other.frame.R(1, 0) + 1e-4) > 1e-5);
}

TEST(FaceFrameRefusal, ATouchInsideTheGearShowsNothing) {
  const FaceGear gear = without_relief(face_gear_of_table_3());
  std::vector<FaceTouchPoint> points = one_row(gear);
  points[3].centre = {10.0, 0.0, 50.0};
  FaceFrameSettings settings;
  settings.ball_radius = 0.5;
  FaceObservability out;
  const Status s = face_observability(gear, points, settings, out);
  EXPECT_EQ(s.reason, Reason::inside_gear_base);
  EXPECT_EQ(s.where.index, 3);
  EXPECT_EQ(out.rank, 0);
}

TEST(FaceGridRefusal, RowsThatAreNowhereOrInsideTheGear) {
  const FaceGear gear = face_gear_of_table_3();
  FaceGrid grid;
  FaceGridPlan plan = face_grid_of_table_3();
  plan.tip_depths[1] = kNan;
  const Status nowhere = make_face_grid(gear, plan, grid);
  EXPECT_EQ(nowhere.reason, Reason::not_finite);
  EXPECT_EQ(nowhere.where.index, static_cast<int>(kGridColumns));
  plan = face_grid_of_table_3();
  plan.first_x = 20.0;
  const Status inside = make_face_grid(gear, plan, grid);
  EXPECT_EQ(inside.reason, Reason::inside_gear_base);
  EXPECT_EQ(inside.where.index, 0);
}

}  // namespace
}  // namespace volcomp::test
