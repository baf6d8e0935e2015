// Points of the node, read over the bus: what was touched, where and how well; and what is reported
// of a touch that gave none.

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/experiments/l300g/truth.hpp"
#include "host_sim/host/bus/drive_model.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/controller/prober.hpp"
#include "tests/host_sim/sim/artefacts/plane.hpp"
#include "tests/system/true_tables.hpp"

namespace volcomp::sim {
namespace {

using test::Plane;

constexpr double kWall_mm = 62.0;
constexpr double kArmLevel = -39.025 * kPi / 180.0;

enum class Tables : std::uint8_t { none, of_truth };

// A wall that faces +Y, and the L300G with the errors P8 in front of it.
class Bench {
 public:
  explicit Bench(Tables tables, std::vector<std::int64_t> bounces_ns = {},
                 const std::vector<std::string>& drives = {})
      : truth_(l300g::make_l300g_truth(file_, l300g::grinder_errors("p8"), 1)) {
    const MachineTables contents =
        tables == Tables::none ? no_tables(file_) : true_tables(truth_, file_);
    host::BusSettings settings = host::bus_settings(file_, kBusCycleOfFive_hz);
    if (!drives.empty()) settings = host::with_models(settings, drives);
    auto axes = std::make_unique<BusAxes>(settings, host::make_image(contents));
    axes_ = axes.get();
    axes->mount(TouchProbe(truth_, wall_, {file_.probe->radius_mm, {}, 10'000, bounces_ns}));
    cell_ = std::make_unique<MotionCell>(truth_, std::move(axes));
    cell_->place(at(1.0));
    prober_ = std::make_unique<Prober>(*cell_, *axes_, file_);
    prober_->configure(host::node_probe(file_));
  }

  // So far from touching the wall, as the machine believes.
  [[nodiscard]] Pose at(double away_mm) const {
    const double on_axis = file_.axes[1].reference;
    return {0.0, on_axis + kWall_mm + file_.probe->radius_mm + away_mm, kArmLevel, 0.0};
  }
  NodePoint touch(const Vec3& normal = Vec3::UnitY()) {
    return prober_->touch(at(0.5), at(-0.5), normal, {50.0, 5.0, 20.0});
  }
  std::string refusal() {
    try {
      touch();
    } catch (const host::UserError& e) {
      return e.what();
    }
    return {};
  }
  [[nodiscard]] BusAxes& axes() { return *axes_; }
  [[nodiscard]] Prober& prober() { return *prober_; }
  [[nodiscard]] const host::MachineFile& file() const { return file_; }

 private:
  host::MachineFile file_ = host::read_machine_file(host::bundled_machine("l300g"));
  TrueMachine truth_;
  Plane wall_{Vec3(0.0, kWall_mm, 0.0), Vec3::UnitY()};
  BusAxes* axes_ = nullptr;
  std::unique_ptr<MotionCell> cell_;
  std::unique_ptr<Prober> prober_;
};

// P8 shows the ball 52 µm too far from the axis (0.4 µm less where the arm is swung a little); the
// tables know it.
TEST(Points, AreCorrectedByTheTablesOfTheNode) {
  Bench raw(Tables::none);
  EXPECT_NEAR(raw.touch().workpiece.y(), kWall_mm + 0.052, 5e-4);
  Bench corrected(Tables::of_truth);
  const NodePoint point = corrected.touch();
  EXPECT_EQ(point.verdict, TouchVerdict::point);
  EXPECT_NEAR(point.workpiece.y(), kWall_mm, 1e-5);
}

TEST(Points, WithoutANormalAreTheCentreOfTheBall) {
  Bench bench(Tables::of_truth);
  const NodePoint point = bench.touch(Vec3::Zero());
  EXPECT_EQ(point.verdict, TouchVerdict::centre);
  EXPECT_NEAR(point.workpiece.y(), kWall_mm + bench.file().probe->radius_mm, 1e-5);
}

TEST(Points, AreReleasedOnceRead) {
  Bench bench(Tables::of_truth);
  for (std::uint32_t i = 1; i <= 40; ++i)
    EXPECT_EQ(bench.touch().sequence, i) << "more than the node has room for";
  EXPECT_EQ(bench.axes().node()->objects().probe.waiting, 0U);
  EXPECT_EQ(bench.axes().node()->objects().probe.lost, 0U);
}

TEST(Points, CarryTheUncertaintyTheyWereConfiguredWith) {
  Bench bench(Tables::of_truth);
  host::NodeProbe probe = host::node_probe(bench.file());
  probe.radius_uncertainty = 0.3e-3;
  probe.repeatability = 0.4e-3;
  bench.prober().configure(probe);
  EXPECT_NEAR(bench.touch().uncertainty, 0.5e-3, 2e-6);
}

TEST(Points, ABouncingProbeHasTouchedNothing) {
  Bench soon(Tables::of_truth, {50'000});
  soon.touch();  // the first count that the node receives has none before it to compare with
  const std::string told = soon.refusal();
  EXPECT_NE(told.find("[double_edge]"), std::string::npos) << told;
  Bench late(Tables::of_truth, {9'000'000});
  EXPECT_EQ(late.refusal(), "touches 1 and 2: two points of feature 1");
}

TEST(Points, ARejectedTouchIsToldWithNumberAxisAndReason) {
  Bench bench(Tables::of_truth);
  bench.axes().break_probe_line(2, true);
  const std::string told = bench.refusal();
  EXPECT_EQ(told.rfind("touch 1, axis B: ", 0), 0U) << told;
  EXPECT_NE(told.find("[axis_missing]"), std::string::npos) << told;
  bench.axes().break_probe_line(2, false);
  EXPECT_EQ(bench.touch().sequence, 2U);
}

// A drive without 60D1h latches where the edge was, too; when that was within a cycle of 4 ms
// nobody knows: 2 ms · 5 mm/s / √3.
TEST(Points, OfDrivesThatDoNotSayWhenAreLessCertain) {
  for (const std::string drive : {"elmo_gold", "epos4_0170"}) {
    Bench bench(Tables::of_truth, {}, {drive});
    for (std::uint32_t i = 1; i <= 5; ++i) {
      const NodePoint point = bench.touch();
      EXPECT_EQ(point.sequence, i);
      EXPECT_EQ(point.verdict, TouchVerdict::point);
      EXPECT_NEAR(point.workpiece.y(), kWall_mm, drive == "elmo_gold" ? 2e-5 : 5e-5) << drive;
      EXPECT_NEAR(point.uncertainty, 2e-3 * 5.0 / std::sqrt(3.0), 1e-4) << drive;
    }
  }
}

// One drive says when, the others do not: the edges can have been one.
TEST(Points, OfDrivesThatDifferBelongTogether) {
  Bench bench(Tables::of_truth, {}, {"elmo_gold", "epos4_0170", "elmo_gold", "epos4_0170"});
  EXPECT_EQ(bench.touch().verdict, TouchVerdict::point);
}

TEST(Points, OfADriveWithoutItsLineAreNotMadeWithoutTimesEither) {
  Bench bench(Tables::of_truth, {}, {"elmo_gold"});
  bench.touch();
  bench.axes().break_probe_line(2, true);
  const std::string told = bench.refusal();
  EXPECT_NE(told.find("axis B"), std::string::npos) << told;
  EXPECT_NE(told.find("[axis_missing]"), std::string::npos) << told;
}

TEST(Points, BadSettingsAreRefusedByName) {
  Bench bench(Tables::of_truth);
  host::NodeProbe probe = host::node_probe(bench.file());
  probe.radius.coefficient[0] = 30.0;
  EXPECT_THROW(bench.prober().configure(probe), host::UserError);
}

}  // namespace
}  // namespace volcomp::sim
