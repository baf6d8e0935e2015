// Any machine file, measured, compensated and measured again: what a ball on its table must show by
// closed form, and what compensation must leave.

#include <cmath>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/any_machine/figures.hpp"
#include "host_sim/experiments/any_machine/report.hpp"
#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/campaign/located_runs.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"
#include "tests/host_sim/host/measure/picture_of_volume.hpp"

namespace volcomp::sim {
namespace {

constexpr double kNm = 1e-6;  // mm

const host::MachineFile& trunnion() {
  static const host::MachineFile file = host::read_machine_file(host::bundled_machine("trunnion"));
  return file;
}

// A fork head on three slides, and nothing under the workpiece.
const host::MachineFile& fork_head() {
  static const host::MachineFile file = host::parse_machine(R"(
name = "fork head"
id = 6001
convention = "body"
side = "fixed"
chain = "w-b-X-Y-Z-C-B-t"
tool = { point_mm = [0.0, 0.0, -250.0] }
axis = [
  { name = "X", travel_mm = [0.0, 1000.0], targets = 41, reference_mm = 0.0, sensed_point_mm = [0.0, 100.0, -300.0], kappa = 0 },
  { name = "Y", travel_mm = [-400.0, 400.0], targets = 33, reference_mm = 0.0, sensed_point_mm = [50.0, 0.0, -300.0], kappa = 0 },
  { name = "Z", travel_mm = [-500.0, 0.0], targets = 21, reference_mm = 0.0, sensed_point_mm = [0.0, 0.0, -400.0], kappa = 0, offset_mm = [0.0, 0.0, 900.0] },
  { name = "C", travel_rad = [0.0, 6.283185307179586], targets = 37, reference_rad = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
  { name = "B", travel_rad = [-1.6, 1.6], targets = 33, reference_rad = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
]
correction = { axes = ["X", "Y", "Z"] }
)",
                                                            "fork_head.toml");
  return file;
}

any_machine::MachineOptions quick(std::uint64_t seed = 1) {
  any_machine::MachineOptions options;
  options.seed = seed;
  options.places = 40;
  return options;
}

any_machine::MachineResult run(const host::MachineFile& file, const TrueMachine& truth,
                               const any_machine::MachineOptions& options = quick()) {
  return any_machine::run_machine_with(file, truth, options, [](double, const std::string&) {});
}

std::vector<any_machine::PlaceReading> sphere_of(const host::MachineFile& file,
                                                 const TrueMachine& truth) {
  const auto cell = make_integrated_cell(truth, file.correction, {});
  cell->place(any_machine::plan_sphere_test(file).poses.front());
  return any_machine::measure_sphere(*cell, file.chain, any_machine::plan_sphere_test(file));
}

TrueMachine with_location(char axis, const ErrorMotion& location) {
  TrueMachine truth = sim::ideal_machine(trunnion());
  const std::size_t a = trunnion().axis_index(axis);
  sim::set_location(trunnion().chain.axis(a), location, truth.axis[a]);
  return truth;
}

ErrorMotion only(Eigen::Index channel, double value) { return value * ErrorMotion::Unit(channel); }

// --- the ball on the table

TEST(MachineRun, TheBallStaysAtTheToolOfAnIdealMachine) {
  const any_machine::SpherePlan plan = any_machine::plan_sphere_test(trunnion());
  EXPECT_GT(plan.poses.size(), 30U);
  for (const Pose& q : plan.poses) {
    const PointPair points = ideal_points(trunnion().chain, q, trunnion().chain.tool_point());
    EXPECT_LT((points.work - plan.ball).norm(), kNm);
    for (std::size_t a = 0; a < trunnion().axes.size(); ++a) {
      EXPECT_GE(q[a], trunnion().axes[a].lo - 1e-9);
      EXPECT_LE(q[a], trunnion().axes[a].hi + 1e-9);
    }
  }
  // The ball goes round with the table: else C would not be tested.
  EXPECT_GT(plan.ball.head<2>().norm(), 30.0);
}

// EX0C moves the ball once round a circle through where it was found: a chord of it.
TEST(MachineRun, ATableBesideItsPlaceShowsChordsOfACircle) {
  constexpr double kOff_mm = 0.01;
  const auto readings = sphere_of(trunnion(), with_location('C', only(0, kOff_mm)));
  ASSERT_GT(readings.size(), 30U);
  for (const any_machine::PlaceReading& r : readings)
    EXPECT_NEAR(r.deviation_mm.norm(), 2.0 * kOff_mm * std::abs(std::sin(0.5 * r.pose[4])),
                1.5 * kNm);
}

// EZ0A: the same about A, whatever C does.
TEST(MachineRun, ATrunnionBesideItsPlaceShowsChordsToo) {
  constexpr double kOff_mm = 0.01;
  for (const any_machine::PlaceReading& r :
       sphere_of(trunnion(), with_location('A', only(2, kOff_mm))))
    EXPECT_NEAR(r.deviation_mm.norm(), 2.0 * kOff_mm * std::abs(std::sin(0.5 * r.pose[3])),
                1.5 * kNm);
}

// EA0C tilts the table: the angle, seen from the turned table, times the lever of the ball.
TEST(MachineRun, ATiltedTableShowsTheLeverOfTheBall) {
  constexpr double kTilt = 20e-6;
  const Vec3 ball = any_machine::plan_sphere_test(trunnion()).ball;
  for (const any_machine::PlaceReading& r :
       sphere_of(trunnion(), with_location('C', only(3, kTilt)))) {
    // The table turns by -C.
    const Vec3 seen = kTilt * Vec3(std::cos(r.pose[4]), std::sin(r.pose[4]), 0.0);
    const Vec3 expected = (seen - Vec3(kTilt, 0.0, 0.0)).cross(ball);
    EXPECT_LT((r.deviation_mm - expected).norm(), 2.0 * kNm);
    EXPECT_NEAR(r.tilt_rad, kTilt, 5e-9);  // a rotary drive counts in 2.9 nrad
  }
}

// --- compensation

// What is left is that targets are rounded to a nanometre or 2.9 nrad.
TEST(MachineRun, WithoutErrorsNothingIsOff) {
  const any_machine::MachineResult result = run(trunnion(), sim::ideal_machine(trunnion()));
  EXPECT_LT(result.after.lines_max_um(), 1e-3);
  EXPECT_LT(result.after.volume.rms_um, 1e-3);
  EXPECT_LT(result.after.sphere_um().rms_um, 1e-3);
  EXPECT_LT(result.after.tilt_max_rad(), 5e-9);
  for (const any_machine::PlaceReading& r : result.after.place)
    EXPECT_EQ(r.offset, host::Offsets{});
}

TEST(MachineRun, VolumeIsDrawnAlignedAsItsFigureIs) {
  const any_machine::MachineResult result = run(trunnion(), draw_machine(trunnion(), 1));
  host::expect_aligned_picture(any_machine::machine_document(result, {"test", {}}));
}

// Rotary axes elsewhere, and nothing else: all of it is in the tables.
TEST(MachineRun, APlaceOfARotaryAxisIsPutRight) {
  const any_machine::MachineResult result = run(trunnion(), with_location('C', only(0, 0.015)));
  EXPECT_NEAR(result.before.sphere_um().max_um, 30.0, 0.1);  // a diameter
  EXPECT_LT(result.after.sphere_um().max_um, 0.05);
}

// Nothing but what a table can hold: no reversal, no ripple between the targets.
TrueMachine smooth(TrueMachine truth) {
  for (std::size_t a = 0; a < truth.chain.axis_count(); ++a) {
    truth.axis[a].reversal = {};
    if (truth.chain.axis(a).kind == JointKind::rotary) continue;
    for (ErrorFunction& f : truth.axis[a].channel)
      f.ripple = 0.0;
  }
  return truth;
}

TEST(MachineRun, WhatTablesCanHoldIsPutRightToNanometres) {
  for (const host::MachineFile* file : {&trunnion(), &fork_head()}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const any_machine::MachineResult result =
          run(*file, smooth(sim::draw_machine(*file, seed)), quick(seed));
      EXPECT_GT(result.before.lines_max_um(), 5.0) << file->name;
      EXPECT_GT(result.before.volume.max_um, 10.0) << file->name;
      EXPECT_GT(result.before.sphere_um().max_um, 10.0) << file->name;
      EXPECT_LT(result.after.lines_max_um(), 0.05) << file->name;
      EXPECT_LT(result.after.volume.max_um, 0.05) << file->name;
      EXPECT_LT(result.after.sphere_um().max_um, 0.05) << file->name;
      EXPECT_NEAR(result.effect_um(result.after), 1e5 * result.after.tilt_max_rad(), 1e-9);
    }
  }
}

// Three slides cannot turn a tool: what is reported is what was there.
TEST(MachineRun, WithoutOrientingAxesTheDirectionOfTheToolIsReported) {
  const any_machine::MachineResult result =
      run(fork_head(), smooth(sim::draw_machine(fork_head(), 1)));
  EXPECT_GT(result.before.tilt_max_rad(), 2e-5);
  EXPECT_NEAR(result.after.tilt_max_rad(), result.before.tilt_max_rad(), 1e-8);
  EXPECT_EQ(result.before.steerable_max_rad(), 0.0);
}

// The trunnion turns it back wherever its table does not nearly stand along the tool.
TEST(MachineRun, OrientingAxesHoldTheDirectionOfTheTool) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const any_machine::MachineResult result =
        run(trunnion(), smooth(sim::draw_machine(trunnion(), seed)), quick(seed));
    EXPECT_GT(result.before.steerable_max_rad(), 5e-5);
    EXPECT_LT(result.after.steerable_max_rad(), 0.5e-6);
    int gripped = 0;
    for (std::size_t i = 0; i < result.after.place.size(); ++i) {
      const any_machine::PlaceReading& after = result.after.place[i];
      if (std::abs(std::sin(after.pose[3])) <= 0.1) continue;  // the table tilted by A
      ++gripped;
      EXPECT_LT(after.tilt_rad, 0.5e-6) << i;
    }
    EXPECT_GT(gripped, 25);
  }
}

// With reversal and ripple. An axis that stands while others turn is moved by its offset alone and
// may turn round without its command doing so: the largest reversal, seen from the first pose.
TEST(MachineRun, AnyMachineIsPutRight) {
  for (const host::MachineFile* file : {&trunnion(), &fork_head()}) {
    const any_machine::MachineResult result = run(*file, sim::draw_machine(*file, 2), quick(2));
    EXPECT_TRUE(any_machine::machine_verdict(result).ok) << any_machine::machine_summary(result);
    EXPECT_LT(result.after.volume.max_um, 1.5) << file->name;
    EXPECT_LT(result.after.sphere_um().max_um, 2.5) << file->name;
  }
}

TEST(MachineRun, MachinesOfThePapersRunFromTheirFiles) {
  for (const char* name : {"xyfz", "l300g", "yk7280"}) {
    const host::MachineFile file = host::read_machine_file(host::bundled_machine(name));
    const any_machine::MachineResult result = run(file, sim::draw_machine(file, 3), quick(3));
    EXPECT_TRUE(any_machine::machine_verdict(result).ok) << any_machine::machine_summary(result);
    EXPECT_EQ(result.before.sphere.empty(), std::string(name) == "xyfz");
  }
}

TEST(MachineRun, RealisticInstrumentsLeaveMicrometres) {
  any_machine::MachineOptions options = quick();
  options.noise = true;
  const any_machine::MachineResult result =
      run(trunnion(), sim::draw_machine(trunnion(), 1), options);
  EXPECT_TRUE(any_machine::machine_verdict(result).ok) << any_machine::machine_summary(result);
  EXPECT_GT(result.after.volume.max_um, 0.5);  // more than perfect instruments would leave
}

// Over the bus the same offsets come out, to the last bit of the drives' units: those of the rotary
// ones are two of the tick's, or 0.5 nm at the tool point. The drives stand where they stood.
TEST(MachineRun, OverTheBusTheSameComesOut) {
  host::MachineFile file = trunnion();
  file.correction.tick_hz = kBusCycleOfFive_hz;
  any_machine::MachineOptions options = quick();
  options.places = 15;
  const TrueMachine truth = sim::draw_machine(file, 1);
  const any_machine::MachineResult beside = run(file, truth, options);
  options.make_cell = bus_cells(file, kBusCycleOfFive_hz);
  const any_machine::MachineResult on_bus = run(file, truth, options);
  const auto expect_same = [](const std::vector<any_machine::PlaceReading>& a,
                              const std::vector<any_machine::PlaceReading>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t axis = 0; axis < 5; ++axis)
        EXPECT_LE(std::abs(a[i].offset[axis] - b[i].offset[axis]), axis < 3 ? 0 : 256) << i;
      EXPECT_LT((a[i].deviation_mm - b[i].deviation_mm).norm(), 2 * kNm) << i;
    }
  };
  expect_same(beside.after.place, on_bus.after.place);
  expect_same(beside.after.sphere, on_bus.after.sphere);
}

// A counts 0.001° (2036h): its target and its offset are rounded to half a unit of 17.5 µrad each,
// and no place is 600 mm from it.
TEST(MachineRun, DecimalDegreesLeaveWhatTheirRoundingDoes) {
  host::MachineFile file = trunnion();
  file.correction.tick_hz = kBusCycleOfFive_hz;
  any_machine::MachineOptions options = quick();
  options.places = 15;
  const TrueMachine truth = sim::draw_machine(file, 1);
  const any_machine::MachineResult exact = run(file, truth, options);
  constexpr std::uint32_t kUnits = 360'000;
  host::DriveFile& drive = file.axes[3].drive;
  drive.scale_numerator = drive.scale_denominator = 1;
  drive.units_per_turn = kUnits;
  options.make_cell = bus_cells(file, kBusCycleOfFive_hz);
  const any_machine::MachineResult rounded = run(file, truth, options);
  constexpr double kUnit_rad = 2.0 * kPi / kUnits;
  constexpr double kHalfUnit = 0x1p39 / kUnits;  // 2^-40 turn
  ASSERT_EQ(exact.after.place.size(), rounded.after.place.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < exact.after.place.size(); ++i) {
    const any_machine::PlaceReading& a = exact.after.place[i];
    const any_machine::PlaceReading& b = rounded.after.place[i];
    EXPECT_LE(std::abs(static_cast<double>(a.offset[3] - b.offset[3])), 1.01 * kHalfUnit) << i;
    const double apart = (a.deviation_mm - b.deviation_mm).norm();
    EXPECT_LT(apart, kUnit_rad * 600.0) << i;
    largest = std::max(largest, apart);
  }
  EXPECT_GT(largest, kUnit_rad * 10.0) << "nothing was rounded";
}

// --- the campaign

// Measured without noise, its rotary axes located.
Campaign located(const TrueMachine& truth, const host::MachineFile& file) {
  host::BuildOptions how = host::tables_only(host::ModelKind::abbe_closed);
  how.slope = SlopeFit::keep;
  Campaign campaign = sim::measure_any_machine(truth, file, no_noise(), 1, {});
  sim::forget_places(campaign);
  const auto tables = host::build_tables(campaign.machine, campaign.runs, how);
  const sim::RotaryLocations found =
      sim::locate_rotary_axes(truth, campaign.machine, tables->model, {true, 1});
  sim::put_in_place(found.place, campaign);
  return campaign;
}

// However the values are meant, the tables are the same.
TEST(MachineRun, ConventionAndSideOfTheFileChangeNoTable) {
  const TrueMachine truth = sim::draw_machine(trunnion(), 1);
  host::BuildOptions how = host::tables_only(host::ModelKind::abbe_closed);
  how.slope = SlopeFit::keep;
  std::unique_ptr<host::BuiltTables> first;
  for (const Convention convention : {Convention::relative, Convention::body}) {
    for (const Side side : {Side::moving, Side::fixed}) {
      host::MachineFile file = trunnion();
      file.convention = convention;
      file.side = side;
      const Campaign campaign = located(truth, file);
      auto tables = host::build_tables(campaign.machine, campaign.runs, how);
      if (!first) {
        first = std::move(tables);
        continue;
      }
      for (std::size_t a = 0; a < file.axes.size(); ++a) {
        const ErrorTable& one = *first->refined[a];
        const ErrorTable& other = *tables->refined[a];
        ASSERT_EQ(one.knots, other.knots);
        for (std::size_t k = 0; k < one.knots; ++k) {
          // Between the targets of a turned frame something else is interpolated.
          const ErrorMotion off = one.forward[k] - other.forward[k];
          EXPECT_LT(off.head<3>().norm(), 50.0 * kNm) << file.axes[a].letter << k;
          EXPECT_LT(off.tail<3>().norm(), 0.2e-6) << file.axes[a].letter << k;
        }
      }
    }
  }
}

TEST(MachineRun, AFileWithItsErrorsAtTheReferenceHoldsThePlaceOfARotaryAxis) {
  const Campaign campaign = located(with_location('C', only(1, 0.012)), trunnion());
  EXPECT_NEAR(campaign.machine.axes[4].at_reference(1), 0.012, kNm);
  EXPECT_NEAR(campaign.machine.axes[4].at_reference(0), 0.0, kNm);
  EXPECT_NEAR(campaign.machine.axes[3].at_reference.norm(), 0.0, kNm);
}

}  // namespace
}  // namespace volcomp::sim
