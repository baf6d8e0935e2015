// A touch on the L300G, from the plane through probe, drives and bus to the controller.

#include <map>

#include <gtest/gtest.h>

#include "comp/core/bytes.hpp"
#include "comp/core/units.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/controller/straight_move.hpp"
#include "tests/host_sim/sim/artefacts/plane.hpp"

namespace volcomp::sim {
namespace {

using test::Plane;

constexpr double kSpeed_mm_s = 1000.0 / 60.0;
constexpr double kSwungLevel = -39.025 * kPi / 180.0;
constexpr double kOnAxis = 168.8053;  // reading of Y with the ball at y = 0
constexpr std::array<double, 4> kDelay_s{12e-6, 14e-6, 16e-6, 18e-6};  // probe and drive together
constexpr double kPeriod_ns = 4e6;

// All four axes move, Y towards the plane; the plane turns with A.
constexpr Pose kBegin{-1.0, kOnAxis + 66.0, kSwungLevel + 0.02, 0.0};
constexpr Pose kBeyond{1.0, kOnAxis + 60.0, kSwungLevel - 0.01, 0.2};

// 60 mm from the axis of A, leaning.
const Vec3 kNormal = Vec3(0.1, 0.9, 0.2).normalized();

class Grinder {
 public:
  explicit Grinder(const Plane& plane, std::vector<std::int64_t> bounces_ns = {}) {
    truth_.chain = file_.chain;
    auto axes = std::make_unique<BusAxes>(host::bus_settings(file_, kBusCycleOfFive_hz),
                                          std::vector<std::uint8_t>{});
    bus_ = axes.get();
    TouchProbe::Settings probe;
    probe.radius_mm = file_.probe->radius_mm;
    probe.delay_ns = std::llround(1000.0 * file_.probe->delay_us);
    probe.bounces_ns = std::move(bounces_ns);
    axes->mount(TouchProbe(truth_, plane, probe));
    axes->bus().bus().set_observer(
        [this](std::uint64_t, const hal::CanFrame& frame, const auto&) { write_down(frame); });
    cell_ = std::make_unique<MotionCell>(truth_, std::move(axes));
    cell_->place(kBegin);
  }

  [[nodiscard]] MotionCell& cell() { return *cell_; }
  [[nodiscard]] BusAxes& bus() { return *bus_; }
  [[nodiscard]] double ball_radius() const { return file_.probe->radius_mm; }
  [[nodiscard]] Vec3 ball_at(const Pose& q) const {
    return ideal_points(file_.chain, q, file_.chain.tool_point()).work;
  }
  // Latch frames of all drives: 280h + n and 380h + n.
  [[nodiscard]] int latch_frames() const { return latch_frames_; }
  // 6064h of Y at the SYNC before and at the SYNC after the latch, then its 60BAh and 60D1h.
  struct Report {
    std::int32_t before, after, latch;
    double time_ns;
  };
  [[nodiscard]] const std::vector<Report>& reports() const { return reports_; }

 private:
  void write_down(const hal::CanFrame& frame) {
    const auto value = static_cast<std::int32_t>(load_le(frame.data.data(), 4));
    const std::uint16_t pdo = frame.id & 0x780U;
    if ((pdo == 0x280 || pdo == 0x380) && (frame.id & 0x7FU) <= 4) ++latch_frames_;
    if (frame.id == 0x182) {
      before_ = after_;
      after_ = value;
    }
    if (frame.id == 0x282) {
      reports_.push_back({before_, after_, value, static_cast<double>(load_le(&frame.data[4], 4))});
    }
  }

  host::MachineFile file_ = host::read_machine_file(host::bundled_machine("l300g"));
  TrueMachine truth_;
  BusAxes* bus_ = nullptr;
  std::unique_ptr<MotionCell> cell_;
  std::int32_t before_ = 0;
  std::int32_t after_ = 0;
  int latch_frames_ = 0;
  std::vector<Report> reports_;
};

// Speed of the axes on the way from kBegin to kBeyond: the feed is that of X and Y.
Pose velocity() {
  Pose v{};
  const double length = std::hypot(kBeyond[0] - kBegin[0], kBeyond[1] - kBegin[1]);
  for (std::size_t a = 0; a < 4; ++a)
    v[a] = (kBeyond[a] - kBegin[a]) / length * kSpeed_mm_s;
  return v;
}

Pose at_contact(const Pose& latch) {
  Pose q = latch;
  for (std::size_t a = 0; a < 4; ++a)
    q[a] -= velocity()[a] * kDelay_s[a];
  return q;
}

// The plane is where the latches show it: half a unit of every encoder (1 nm; 0.5 nm at the arm)
// and 11 ns of the way to it.
TEST(TouchOnTheBus, LatchesOfAllAxesLieOnThePlane) {
  const Plane plane(60.0 * Vec3::UnitY(), kNormal);
  Grinder grinder(plane);
  const Touch touch = grinder.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0);
  ASSERT_TRUE(touch.touched);
  for (std::size_t a = 0; a < 4; ++a)
    EXPECT_TRUE(touch.latched[a]) << "axis " << a;
  const double r = grinder.ball_radius();
  EXPECT_NEAR(plane.gap(grinder.ball_at(at_contact(touch.latch)), r).mm, 0.0, 1.5e-6);
  // As latched, it is missed by what the ball went in 12 to 18 µs.
  EXPECT_LT(plane.gap(grinder.ball_at(touch.latch), r).mm, -kSpeed_mm_s * 12e-6);
}

TEST(TouchOnTheBus, EveryDriveLatchesSoLateAsItIs) {
  const Plane plane(60.0 * Vec3::UnitY(), kNormal);
  Grinder grinder(plane);
  ASSERT_TRUE(grinder.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0).touched);
  const Latches latches = grinder.cell().axes().latches();
  for (std::size_t a = 1; a < 4; ++a)
    EXPECT_EQ(latches[a].time_ns - latches[0].time_ns, 2000U * a);
}

// 60BAh lies between the 6064h of the SYNC before and the SYNC after it, at the time of 60D1h.
TEST(TouchOnTheBus, LatchesAndActualPositionsAreOfOneWorld) {
  const Plane plane(60.0 * Vec3::UnitY(), kNormal);
  Grinder grinder(plane);
  for (int i = 0; i < 5; ++i) {
    Pose begin = kBegin;
    begin[1] += 0.0137 * i;
    grinder.cell().move_to(begin, 20.0);
    ASSERT_TRUE(grinder.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0).touched);
  }
  ASSERT_EQ(grinder.reports().size(), 5U);
  for (const Grinder::Report& r : grinder.reports())
    EXPECT_NEAR(r.latch, r.before + (r.after - r.before) * r.time_ns / kPeriod_ns, 1.5);
}

TEST(TouchOnTheBus, StopsSoonAndRetracts) {
  const Plane plane(60.0 * Vec3::UnitY(), Vec3::UnitY());
  Grinder grinder(plane);
  double nearest = 1e9;
  grinder.bus().drive(1).on_input = [&](const Cia402Drive::InputStep& in) {
    nearest = std::min(nearest, 1e-6 * in.target - kOnAxis);
  };
  Pose beyond = kBeyond;
  beyond[3] = kBegin[3];
  ASSERT_TRUE(grinder.cell().probe_to(beyond, kSpeed_mm_s, kBegin, 20.0).touched);
  // Lag of the drives, three cycles until the news has come round, and v² / 2a.
  const double most = kSpeed_mm_s * (0.0047 + 3.0 * 0.004) +
                      kSpeed_mm_s * kSpeed_mm_s / (2.0 * kAcceleration_mm_s2);
  EXPECT_GT(nearest, 60.0 + grinder.ball_radius() - most);
  EXPECT_LT(nearest, 60.0 + grinder.ball_radius());
  EXPECT_EQ(grinder.cell().target(), kBegin);
}

TEST(TouchOnTheBus, NothingTouchedIsSaid) {
  const Plane plane(50.0 * Vec3::UnitY(), Vec3::UnitY());
  Grinder grinder(plane);
  const Touch touch = grinder.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0);
  EXPECT_FALSE(touch.touched);
  EXPECT_EQ(grinder.latch_frames(), 0);
  EXPECT_EQ(grinder.cell().target(), kBegin);
}

TEST(TouchOnTheBus, ADriveThatMissesTheEdgeIsNamed) {
  const Plane plane(60.0 * Vec3::UnitY(), kNormal);
  Grinder grinder(plane);
  grinder.bus().break_probe_line(2, true);
  const Touch touch = grinder.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0);
  EXPECT_TRUE(touch.touched);
  EXPECT_EQ(touch.latched, (std::array<bool, host::kMostAxes>{true, true, false, true, false}));
  EXPECT_EQ(grinder.latch_frames(), 6);
}

// One report of latch and count from each drive for a touch; a bounce within the cycle is two edges
// in one report.
TEST(TouchOnTheBus, EdgesAreReportedOnceAndCounted) {
  const Plane plane(60.0 * Vec3::UnitY(), kNormal);
  Grinder clean(plane);
  ASSERT_TRUE(clean.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0).touched);
  ASSERT_TRUE(clean.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0).touched);
  EXPECT_EQ(clean.latch_frames(), 2 * 4 * 2);
  Grinder bouncing(plane, {50'000});
  ASSERT_TRUE(bouncing.cell().probe_to(kBeyond, kSpeed_mm_s, kBegin, 20.0).touched);
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_EQ(clean.bus().controller().probe(a).edges, 2);
    EXPECT_EQ(bouncing.bus().controller().probe(a).edges, 2);
  }
  EXPECT_EQ(bouncing.latch_frames(), 4 * 2);
}

}  // namespace
}  // namespace volcomp::sim
