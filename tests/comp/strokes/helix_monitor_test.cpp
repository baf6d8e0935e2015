// The monitor on strokes whose errors are known.

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "comp/strokes/helix_instances.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

constexpr double kFeed_mm_s = 13.4;  // mm/s
constexpr double kFlankPerX = 0.3246;

HelixMonitorSettings paper_settings() {
  const InternalGear gear = paper_gear();
  HelixMonitorSettings s;
  s.turn_per_mm = gear.turn_per_mm;
  s.flank_per_rad = gear.normal_lever();
  s.flank_per_x = kFlankPerX;
  s.z0_nm = to_nm(-22.5);
  s.nodes = 181;
  return s;
}

// Errors of the axes at a time and place of a stroke, mm and rad.
struct StrokeErrors {
  double x = 0.0;
  double z = 0.0;
  double c = 0.0;
};

class Stroke {
 public:
  explicit Stroke(const HelixMonitorSettings& settings = paper_settings()) : settings_(settings) {
    EXPECT_TRUE(monitor->configure(settings).ok());
  }

  // One pass through the face; `errors(t, z)`. Returns the result of collect().
  template <class Errors>
  Status pass(std::uint16_t slot, Direction direction, const Errors& errors) {
    const double sign = direction == Direction::forward ? 1.0 : -1.0;
    for (int k = 0; k * 1e-3 * kFeed_mm_s < 47.0; ++k) {
      const double t = 1e-3 * k;
      const double z = sign * (t * kFeed_mm_s - 23.5);
      HelixFrame frame = frame_at(z, errors(t, z), sign);
      frame.slot = slot;
      frame.stroke = direction;
      frame.in_face = std::abs(z) <= 22.5;
      if (spoil && spoil(frame)) continue;
      monitor->tick(frame);
    }
    return monitor->collect();
  }

  // `age_ns` of the actual position of Z.
  HelixFrame frame_at(double z, const StrokeErrors& e, double sign) {
    HelixFrame frame;
    frame.sequence = ++sequence_;
    const double early = z - sign * kFeed_mm_s * age_z_ns * 1e-9;
    frame.x = {to_nm(44.0), to_nm(44.0 + e.x), 0, true};
    frame.z = {to_nm(z), to_nm(early + e.z), age_z_ns, true};
    const double c = -z * settings_.turn_per_mm;
    frame.c = {to_units(c, kUnitsPerRad), to_units(c + e.c, kUnitsPerRad), 0, true};
    return frame;
  }

  std::unique_ptr<GrinderMonitor> monitor = std::make_unique<GrinderMonitor>();
  std::int32_t age_z_ns = 0;
  std::function<bool(HelixFrame&)> spoil;  // true: the frame is lost

 private:
  HelixMonitorSettings settings_;
  std::uint16_t sequence_ = 65500;  // wraps during the first pass
};

const StrokeErrors kNoErrors{};
const auto kPerfect = [](double, double) { return kNoErrors; };

TEST(HelixMonitor, ALagAlongTheHelixLeavesNothing) {
  Stroke stroke;
  const double turn = paper_gear().turn_per_mm;
  const auto lag = [&](double, double) { return StrokeErrors{0.0, -0.16, 0.16 * turn}; };
  ASSERT_TRUE(stroke.pass(0, Direction::forward, lag).ok());
  const StrokeSpectra& s = stroke.monitor->totals().spectra(Direction::forward);
  EXPECT_NEAR(s.of(FlankSignal::sync).mean(), 0.0, 1e-3);
  EXPECT_NEAR(s.of(FlankSignal::lag_c).mean(), 38.9, 0.1) << "of C alone";
  EXPECT_GT(s.of(FlankSignal::sync).count(), 3300U);
}

TEST(HelixMonitor, SignalsAreMicrometresOnTheFlank) {
  Stroke stroke;
  const auto errors = [](double, double) { return StrokeErrors{0.01, -0.17, 0.033 * kDegree}; };
  ASSERT_TRUE(stroke.pass(0, Direction::backward, errors).ok());
  const StrokeSpectra& s = stroke.monitor->totals().spectra(Direction::backward);
  EXPECT_NEAR(s.of(FlankSignal::sync).mean(), 1.411, 1e-3);
  EXPECT_NEAR(s.of(FlankSignal::x).mean(), 3.246, 1e-3);
  EXPECT_NEAR(s.of(FlankSignal::x).peak(), 3.246, 1e-3);
  EXPECT_EQ(stroke.monitor->totals().passes(Direction::forward), 0U)
      << "one direction only: the other has nothing to learn from";
}

// 1 ms between the positions of Z and C is 3.3 µm at 13.4 mm/s; interpolated it is nothing.
TEST(HelixMonitor, PositionsOfDifferentAgeAreBroughtToOneInstant) {
  Stroke stroke;
  stroke.age_z_ns = 1'000'000;
  ASSERT_TRUE(stroke.pass(0, Direction::forward, kPerfect).ok());
  const auto& interpolated =
      stroke.monitor->totals().spectra(Direction::forward).of(FlankSignal::sync);
  EXPECT_LT(interpolated.peak(), 2e-3);
  Stroke unaware;
  unaware.age_z_ns = 1'000'000;
  unaware.spoil = [](HelixFrame& frame) {
    frame.z.age_ns = 0;
    return false;
  };
  ASSERT_TRUE(unaware.pass(0, Direction::forward, kPerfect).ok());
  EXPECT_NEAR(unaware.monitor->totals().spectra(Direction::forward).of(FlankSignal::sync).mean(),
              -3.26, 0.05);
}

TEST(HelixMonitor, NodesCarryWhatBelongsToAPlaceOfTheStroke) {
  Stroke stroke;
  const auto wave = [](double, double z) {
    return StrokeErrors{0.0, 0.0, 2e-5 + 1e-5 * std::sin(2.0 * kPi * z / 10.0)};
  };
  ASSERT_TRUE(stroke.pass(3, Direction::forward, wave).ok());
  std::vector<NodeSums> nodes(181);
  stroke.monitor->totals().stroke_sums(Direction::forward, nodes);
  for (std::size_t j = 1; j + 1 < nodes.size(); ++j) {
    ASSERT_GT(nodes[j].n, 15U);
    const double z = -22.5 + 0.25 * static_cast<double>(j);
    EXPECT_NEAR(nodes[j].sum / nodes[j].n, wave(0, z).c, 1e-7) << z;
  }
}

// The mean of a slot against that of its direction is T2, the rest T1; together they are all of it
// and nothing twice.
TEST(HelixMonitor, SharesOutBetweenStrokeAndSlotTables) {
  Stroke stroke;
  constexpr int kSlots = 8;
  const auto slot_error = [](int slot) { return 4e-6 * std::cos(2.0 * kPi * slot / kSlots); };
  const auto stroke_error = [](Direction d, double z) {
    return d == Direction::forward ? 2e-5 + 1e-7 * z : -3e-5;
  };
  for (int slot = 0; slot < kSlots; ++slot) {
    for (const Direction d : {Direction::forward, Direction::backward}) {
      ASSERT_TRUE(stroke
                      .pass(static_cast<std::uint16_t>(slot), d,
                            [&](double, double z) {
                              return StrokeErrors{0, 0, stroke_error(d, z) + slot_error(slot)};
                            })
                      .ok());
    }
  }
  std::vector<NodeSums> nodes(181);
  std::vector<NodeSums> slots(kSlots);
  for (const Direction d : {Direction::forward, Direction::backward}) {
    stroke.monitor->totals().stroke_sums(d, nodes);
    for (std::size_t j = 1; j + 1 < nodes.size(); ++j) {
      const double z = -22.5 + 0.25 * static_cast<double>(j);
      EXPECT_NEAR(nodes[j].sum / nodes[j].n, stroke_error(d, z), 3e-8);
    }
  }
  stroke.monitor->totals().slot_sums(slots);
  for (int slot = 0; slot < kSlots; ++slot) {
    const NodeSums& sums = slots[static_cast<std::size_t>(slot)];
    EXPECT_EQ(sums.n, 2U);
    EXPECT_NEAR(sums.sum / sums.n, slot_error(slot), 1e-9);
  }
  const SpectralLine first = order_around(slots, 1);
  EXPECT_NEAR(first.amplitude, 4e-6, 1e-9);
  EXPECT_NEAR(first.phase, 0.0, 1e-3);
  EXPECT_NEAR(order_around(slots, 3).amplitude, 0.0, 1e-9);
}

TEST(HelixMonitor, FindsLinesInTimeAndAlongTheStroke) {
  HelixMonitorSettings settings = paper_settings();
  settings.time_line_hz = {50.0, 23.0, 0.0, 0.0};
  settings.order_wavelength_mm = {2.5, 10.0, 0.0, 0.0};
  Stroke stroke(settings);
  const double lever = paper_gear().normal_lever();
  const auto errors = [&](double t, double z) {
    return StrokeErrors{
        0, 0,
        1e-3 / lever *
            (30.0 + 2.0 * std::cos(2.0 * kPi * 50.0 * t) + 0.5 * std::sin(2.0 * kPi * z / 2.5))};
  };
  ASSERT_TRUE(stroke.pass(0, Direction::forward, errors).ok());
  ASSERT_TRUE(stroke.pass(1, Direction::forward, errors).ok());
  const auto& totals = stroke.monitor->totals();
  EXPECT_NEAR(totals.time_amplitude(Direction::forward, 0), 2.0, 0.01);
  EXPECT_NEAR(totals.time_amplitude(Direction::forward, 1), 0.0, 0.03);
  EXPECT_EQ(totals.time_amplitude(Direction::forward, 2), 0.0);
  const auto& order = totals.spectra(Direction::forward).order;
  EXPECT_NEAR(spectral_line(order[0]).amplitude, 0.5, 0.01);
  EXPECT_NEAR(spectral_line(order[0]).phase, -0.5 * kPi, 0.01);
  EXPECT_NEAR(spectral_line(order[1]).amplitude, 0.0, 0.03);
}

TEST(HelixMonitor, CountsWhatItCannotUse) {
  Stroke stroke;
  int k = 0;
  stroke.spoil = [&](HelixFrame& frame) {
    ++k;
    if (k == 500) frame.c.valid = false;
    if (k == 600) return true;
    if (k == 700) frame.z.age_ns = 3'000'000;
    if (k == 800) frame.x.actual += 2'000'000;
    return false;
  };
  ASSERT_TRUE(stroke.pass(0, Direction::forward, kPerfect).ok());
  EXPECT_EQ(stroke.monitor->frames(FrameUse::invalid), 1U);
  EXPECT_EQ(stroke.monitor->frames(FrameUse::gap), 1U);
  EXPECT_EQ(stroke.monitor->frames(FrameUse::skewed), 1U);
  EXPECT_EQ(stroke.monitor->frames(FrameUse::implausible), 1U);
  EXPECT_EQ(stroke.monitor->frames(FrameUse::starting), 2U)
      << "the first and after the invalid one";
  EXPECT_LT(stroke.monitor->totals().spectra(Direction::forward).of(FlankSignal::x).peak(), 1e-3);
}

TEST(HelixMonitorRefusal, PassWithMoreThanOnePercentBad) {
  Stroke stroke;
  int k = 0;
  stroke.spoil = [&k](HelixFrame& frame) {
    frame.c.valid = ++k % 80 != 0;  // each costs two samples
    return false;
  };
  const Status status = stroke.pass(0, Direction::forward, kPerfect);
  EXPECT_EQ(status.reason, Reason::pass_discarded);
  EXPECT_NEAR(status.where.value, 0.025, 0.002);
  EXPECT_EQ(stroke.monitor->totals().passes(Direction::forward), 0U);
  EXPECT_EQ(stroke.monitor->totals().spectra(Direction::forward).of(FlankSignal::sync).count(), 0U);
}

// Frames that never came count like bad ones, although only one of them shows as a gap.
TEST(HelixMonitorRefusal, PassWithAHole) {
  Stroke stroke;
  int k = 0;
  stroke.spoil = [&k](HelixFrame&) {
    ++k;
    return k > 1000 && k <= 1050;
  };
  const Status status = stroke.pass(0, Direction::forward, kPerfect);
  EXPECT_EQ(stroke.monitor->frames(FrameUse::gap), 1U);
  EXPECT_EQ(status.reason, Reason::pass_discarded);
  EXPECT_NEAR(status.where.value, 51.0 / 3359.0, 1e-4);
}

TEST(HelixMonitorRefusal, SlotsAndDirectionsThatDoNotExist) {
  Stroke stroke;
  EXPECT_STREQ(stroke.pass(kGearSlots, Direction::forward, kPerfect).where.field, "slot");
  EXPECT_STREQ(stroke.pass(0, Direction::unknown, kPerfect).where.field, "direction");
  EXPECT_EQ(stroke.monitor->collect().reason, Reason::too_few_points) << "no pass waits";
}

// A stroke beside the nodes leaves no mean that a table could be made of.
TEST(HelixMonitorRefusal, PassBesideTheNodes) {
  HelixMonitorSettings far = paper_settings();
  far.z0_nm = to_nm(500.0);
  Stroke stroke(far);
  EXPECT_EQ(stroke.pass(0, Direction::forward, kPerfect).reason, Reason::too_few_points);
  EXPECT_GT(stroke.monitor->outside(), 3000U);
  EXPECT_EQ(stroke.monitor->totals().passes(Direction::forward), 0U);
  std::vector<NodeSums> sums(far.nodes);
  stroke.monitor->totals().stroke_sums(Direction::forward, sums);
  for (const NodeSums& node : sums)
    EXPECT_EQ(node.n, 0U);
}

TEST(RunningStatistics, CountsWhatIsNoMeasurementAndLeavesItOut) {
  RunningStatistics signal;
  EXPECT_TRUE(signal.add(1.0));
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e301})
    EXPECT_FALSE(signal.add(bad));
  EXPECT_TRUE(signal.add(3.0));
  RunningStatistics empty;
  EXPECT_FALSE(empty.add(std::nan("")));
  signal.merge(empty);
  EXPECT_EQ(signal.count(), 2U);
  EXPECT_EQ(signal.bad(), 5U);
  EXPECT_NEAR(signal.mean(), 2.0, 1e-15);
  EXPECT_NEAR(signal.variance(), 1.0, 1e-15);
  EXPECT_NEAR(RunningStatistics().variance(), 0.0, 0.0);
}

TEST(HelixMonitor, APassNobodyCollectsIsLostAndCounted) {
  Stroke stroke;
  HelixFrame frame = stroke.frame_at(0.0, {}, 1.0);
  for (int pass = 0; pass < 3; ++pass) {
    for (int k = 0; k < 20; ++k) {
      frame = stroke.frame_at(0.0, {}, 1.0);
      frame.stroke = Direction::forward;
      frame.in_face = k > 0 && k < 10;
      stroke.monitor->tick(frame);
    }
  }
  EXPECT_EQ(stroke.monitor->passes_lost(), 2U);
  EXPECT_TRUE(stroke.monitor->collect().ok());
}

TEST(HelixMonitorRefusal, SettingsNameTheirField) {
  GrinderMonitor monitor;
  const auto refused = [&](const auto& change) {
    HelixMonitorSettings s = paper_settings();
    change(s);
    return monitor.configure(s);
  };
  EXPECT_EQ(refused([](auto& s) { s.nodes = kStrokeNodes + 1; }).reason, Reason::too_many_knots);
  EXPECT_EQ(refused([](auto& s) { s.nodes = 1; }).reason, Reason::too_few_knots);
  EXPECT_EQ(refused([](auto& s) { s.turn_per_mm = std::nan(""); }).reason, Reason::not_finite);
  EXPECT_EQ(refused([](auto& s) { s.flank_per_x = std::nan(""); }).reason, Reason::not_finite);
  const auto bad = [&](const auto& change) {
    const Status s = refused(change);
    return s.reason == Reason::bad_setting ? s.where.field : code(s.reason);
  };
  EXPECT_STREQ(bad([](auto& s) { s.flank_per_rad = 0.0; }), "flank_per_rad");
  EXPECT_STREQ(bad([](auto& s) { s.tick_ns = 0; }), "tick_ns");
  EXPECT_STREQ(bad([](auto& s) { s.most_skew_ns = -1; }), "most_skew_ns");
  EXPECT_STREQ(bad([](auto& s) { s.node_pitch_nm = 0; }), "node_pitch_nm");
  EXPECT_STREQ(bad([](auto& s) { s.time_line_hz[1] = 500.0; }), "time_line_hz");
  EXPECT_STREQ(bad([](auto& s) { s.time_line_hz[0] = -1.0; }), "time_line_hz");
  for (const double mm : {-1.0, 1e-4, 1e6, std::nan("")})
    EXPECT_STREQ(bad([mm](auto& s) { s.order_wavelength_mm[2] = mm; }), "order_wavelength_mm");
  EXPECT_EQ(refused([](auto& s) { s.node_pitch_nm = 100'000'000; }).reason,
            Reason::travel_too_long);
}

// A pass is one stroke in one slot: another slot, or the wheel turning round in the face, begins
// the next.
TEST(HelixMonitor, AnotherSlotOrDirectionEndsAPass) {
  Stroke stroke;
  const auto ticks = [&](std::uint16_t slot, Direction direction) {
    for (int k = 0; k < 20; ++k) {
      HelixFrame frame = stroke.frame_at(0.0, {}, 1.0);
      frame.slot = slot;
      frame.stroke = direction;
      frame.in_face = true;
      stroke.monitor->tick(frame);
    }
  };
  HelixFrame known = stroke.frame_at(0.0, {}, 1.0);
  stroke.monitor->tick(known);
  ticks(0, Direction::forward);
  EXPECT_FALSE(stroke.monitor->pass_waits());
  ticks(1, Direction::forward);
  EXPECT_TRUE(stroke.monitor->pass_waits());
  EXPECT_TRUE(stroke.monitor->collect().ok());
  ticks(1, Direction::backward);
  EXPECT_TRUE(stroke.monitor->collect().ok());
  EXPECT_EQ(stroke.monitor->totals().passes(Direction::forward), 2U);
}

// Ages that differ by more than the limit, either axis, either way; errors beyond 1 mm, either way.
TEST(HelixMonitor, UsesNoFrameWhoseAxesAreFarApart) {
  Stroke stroke;
  const auto use_of = [&](const auto& change) {
    for (int k = 0; k < 2; ++k) {
      HelixFrame good = stroke.frame_at(0.0, {}, 1.0);
      stroke.monitor->tick(good);
    }
    HelixFrame frame = stroke.frame_at(0.0, {}, 1.0);
    change(frame);
    return stroke.monitor->tick(frame);
  };
  EXPECT_EQ(use_of([](HelixFrame&) {}), FrameUse::used);
  EXPECT_EQ(use_of([](HelixFrame& f) { f.x.age_ns = 2'000'001; }), FrameUse::skewed);
  EXPECT_EQ(use_of([](HelixFrame& f) { f.c.age_ns = 2'000'001; }), FrameUse::skewed);
  EXPECT_EQ(use_of([](HelixFrame& f) { f.x.actual -= 1'000'001; }), FrameUse::implausible);
  EXPECT_EQ(use_of([](HelixFrame& f) { f.x.actual -= 1'000'000; }), FrameUse::used);
}

// Two samples that were taken at one instant give no speed: nothing is carried on.
TEST(HelixMonitor, SamplesOfOneInstantAreTakenAsTheyAre) {
  Stroke stroke;
  HelixFrame first = stroke.frame_at(0.0, {}, 1.0);
  stroke.monitor->tick(first);
  HelixFrame second = stroke.frame_at(0.0, {0.01, 0.0, 0.0}, 1.0);
  second.x.age_ns = 1'000'000;  // a whole tick old: as old as the one before
  ASSERT_EQ(stroke.monitor->tick(second), FrameUse::used);
  EXPECT_NEAR(stroke.monitor->signals().e_x_nm, 10'000.0, 1.0);
}

// Positions at the ends of the integers must do no harm (the sanitizer build checks it).
TEST(HelixMonitor, AcceptsPositionsAnywhere) {
  Stroke stroke;
  for (const std::int64_t at : {INT64_MIN, INT64_MAX, std::int64_t{0}, INT64_MIN}) {
    HelixFrame frame = stroke.frame_at(0.0, {}, 1.0);
    frame.z.command = at;
    frame.z.actual = INT64_MAX - (at == INT64_MAX ? 0 : 1);
    frame.c.command = frame.c.actual = at;
    frame.in_face = true;
    stroke.monitor->tick(frame);
  }
  EXPECT_GT(stroke.monitor->frames(FrameUse::implausible), 0U);
}

}  // namespace
}  // namespace volcomp::test
