// The grinder with its compensation on a bus: the same as with the compensation beside the
// controller, and what happens when frames are lost or the feed is another one.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/experiments/internal_helical/bus_grinder.hpp"
#include "host_sim/experiments/internal_helical/grinding_job.hpp"
#include "host_sim/experiments/internal_helical/integrated_grinder.hpp"
#include "host_sim/experiments/internal_helical/scenario.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/host/measure/strokes/stroke_learning.hpp"
#include "host_sim/sim/controller/bus_recorder.hpp"
#include "tests/complaint.hpp"

namespace volcomp::sim {
namespace {

using testing::HasSubstr;

constexpr std::size_t kC = 2;
constexpr std::size_t kSomewhere = 20;  // a node of the stroke
constexpr std::uint16_t kProcessStateId = canopen::kTpdo1 + 127;

const host::MachineFile& machine() {
  static const host::MachineFile file =
      host::read_machine_file(host::bundled_machine("internal_grinder"));
  return file;
}

host::WatchedStrokes watched(internal_helical::LearningWay way) {
  static const internal_helical::FlankGrinding grinding(internal_helical::grinding_job(machine()),
                                                        {});
  return internal_helical::watched_strokes(internal_helical::grinding_job(machine()),
                                           grinding.flank_per_x(), way);
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
}

struct Grinding {
  internal_helical::GrindingProcess process{internal_helical::grinding_job(machine()), {}, 1};

  std::vector<internal_helical::StrokeTrace> grind(internal_helical::GrinderControl& control,
                                                   int passes) {
    const auto sync = [&control](const internal_helical::StrokeStep& step) { control.cycle(step); };
    process.rest(sync);
    std::vector<internal_helical::StrokeTrace> traces;
    traces.reserve(static_cast<std::size_t>(passes));
    for (int i = 0; i < passes; ++i)
      traces.push_back(process.pass(sync));
    return traces;
  }
};

struct GrindingOnTheBus : Grinding {
  explicit GrindingOnTheBus(
      internal_helical::LearningWay way = internal_helical::LearningWay::right)
      : grinder(internal_helical::grinder_axes(machine(), watched(way), loopback_axes()),
                process.standing(), process.plant()) {}

  internal_helical::BusGrinder grinder;
};

void expect_equal(const std::vector<internal_helical::StrokeTrace>& a,
                  const std::vector<internal_helical::StrokeTrace>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t pass = 0; pass < a.size(); ++pass) {
    ASSERT_EQ(a[pass].at.size(), b[pass].at.size());
    for (std::size_t i = 0; i < a[pass].at.size(); ++i) {
      ASSERT_EQ(a[pass].at[i].z, b[pass].at[i].z) << pass << ' ' << i;
      ASSERT_EQ(a[pass].at[i].e_c, b[pass].at[i].e_c) << pass << ' ' << i;
    }
  }
}

// The node gives float.
void expect_equal(const internal_helical::LearnedTables& node,
                  const internal_helical::LearnedTables& tables) {
  const auto expect_floats = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_EQ(static_cast<float>(a[i]), static_cast<float>(b[i])) << i;
  };
  EXPECT_EQ(node.z0_mm, tables.z0_mm);
  EXPECT_EQ(node.pitch_mm, tables.pitch_mm);
  for (std::size_t d = 0; d < 2; ++d)
    expect_floats(node.stroke[d], tables.stroke[d]);
  expect_floats(node.slot, tables.slot);
}

class EitherForm : public testing::TestWithParam<internal_helical::LearningWay> {};

// Learned after four slots, used in the next four: the axes do the same to the last bit.
TEST_P(EitherForm, MovesTheAxesAlike) {
  Grinding beside;
  internal_helical::IntegratedGrinder integrated(watched(GetParam()), GetParam(),
                                                 beside.process.plant());
  GrindingOnTheBus bus(GetParam());
  for (int update = 0; update < 2; ++update) {
    expect_equal(bus.grind(bus.grinder, 4), beside.grind(integrated, 4));
    bus.grinder.learn();
    integrated.learn();
  }
  expect_equal(bus.grind(bus.grinder, 4), beside.grind(integrated, 4));
  const internal_helical::LearnedTables learned = integrated.tables();
  expect_equal(bus.grinder.tables(), learned);
  EXPECT_GT(std::abs(learned.stroke[0].at(kSomewhere)), 1e-7);  // not nothing, alike
  const internal_helical::MonitorView seen = bus.grinder.view();
  const internal_helical::MonitorView here = integrated.view();
  for (std::size_t d = 0; d < 2; ++d) {
    ASSERT_EQ(seen.stroke[d].size(), here.stroke[d].size());
    for (std::size_t j = 0; j < here.stroke[d].size(); ++j)
      EXPECT_NEAR(seen.stroke[d][j], here.stroke[d][j], 1e-5);
  }
  EXPECT_EQ(seen.along, here.along);
}

INSTANTIATE_TEST_SUITE_P(InternalHelicalBus, EitherForm,
                         testing::Values(internal_helical::LearningWay::right,
                                         internal_helical::LearningWay::c_alone,
                                         internal_helical::LearningWay::coarse));

// What a listener on the bus has recorded teaches the same as the node has learned of it, to the
// unit of 2^-40 turn in which positions are counted: the log's way is by way of mm and degrees.
TEST(InternalHelicalBus, ALogOfTheBusTeachesWhatTheNodeHasLearned) {
  const host::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "strokes.log";
  host::CanLogWriter writer(path, "can0");
  sim::BusRecorder recorder(writer, sim::BusRecorder::Clock::machine);
  Grinding grinding;
  internal_helical::BusGrinder grinder(
      internal_helical::grinder_axes(machine(), watched(internal_helical::LearningWay::right),
                                     sim::recorded(loopback_axes(), recorder)),
      grinding.process.standing(), grinding.process.plant());
  static_cast<void>(grinding.grind(grinder, 4));
  grinder.learn();
  const internal_helical::LearnedTables node = grinder.tables();
  writer.finish();
  constexpr double kUnit_rad = 1.0 / kUnitsPerRad;

  const host::StrokesLearned learned =
      host::learn_strokes(host::read_stroke_log(path, machine()), machine(), {});
  EXPECT_EQ(learned.passes[0], 2U);
  EXPECT_EQ(learned.passes[1], 2U);
  EXPECT_TRUE(learned.discarded.empty()) << learned.discarded.front();
  EXPECT_NEAR(learned.feed_mm_per_s, machine().grinding->feed_mm_per_s, 1e-3);
  for (std::size_t d = 0; d < 2; ++d) {
    ASSERT_EQ(learned.tables.stroke.at(d).size(), node.stroke.at(d).size());
    for (std::size_t j = 0; j < node.stroke.at(d).size(); ++j)
      EXPECT_NEAR(learned.tables.stroke.at(d)[j], node.stroke.at(d)[j], kUnit_rad) << d << ' ' << j;
  }
  ASSERT_EQ(learned.tables.slot.size(), node.slot.size());
  for (std::size_t k = 0; k < node.slot.size(); ++k)
    EXPECT_NEAR(learned.tables.slot[k], node.slot[k], kUnit_rad) << k;
  EXPECT_GT(std::abs(node.stroke[0].at(kSomewhere)), 1e-7);  // not nothing, alike
}

// The whole scenario, on a smaller gear and cut to two updates.
TEST(InternalHelicalBus, TheGearComesOutAlike) {
  const host::TemporaryFolder folder;
  std::string text = host::text_of_file(host::bundled_machine("internal_grinder"));
  replace(text, "teeth = 79", "teeth = 51");
  replace(text, "radius_mm = 40.0", "radius_mm = 25.0");
  replace(text, "width_mm = 45.0", "width_mm = 20.0");
  replace(text, "overrun_mm = 10.0", "overrun_mm = 4.0");
  internal_helical::InternalHelicalOptions options;
  options.seeds = 1;
  options.updates = 2;
  options.machine = folder.path() / "small.toml";
  host::write_whole_file(options.machine, text);
  const auto quiet = [](double, const std::string&) {};
  const internal_helical::InternalHelicalResult beside =
      internal_helical::run_internal_helical(options, quiet);
  options.make_axes = loopback_axes();
  const internal_helical::InternalHelicalResult bus =
      internal_helical::run_internal_helical(options, quiet);
  EXPECT_EQ(bus.seed[0].learning_um, beside.seed[0].learning_um);
  for (const bool after : {false, true}) {
    const internal_helical::GroundGear& a = after ? bus.seed[0].after : bus.seed[0].before;
    const internal_helical::GroundGear& b = after ? beside.seed[0].after : beside.seed[0].before;
    EXPECT_EQ(a.inspection.F_alpha, b.inspection.F_alpha);
    for (std::size_t side = 0; side < 2; ++side)
      EXPECT_EQ(a.inspection.pitch[side].position, b.inspection.pitch[side].position);
  }
  expect_equal(bus.detail.tables, beside.detail.tables);
}

TEST(InternalHelicalBus, OneTableForBothDirectionsIsRefused) {
  internal_helical::InternalHelicalOptions options;
  options.seeds = 1;
  options.way = internal_helical::LearningWay::one_table;
  options.make_axes = loopback_axes();
  options.machine = host::bundled_machine("internal_grinder");
  EXPECT_THAT(complaint_of([&] {
                static_cast<void>(internal_helical::run_internal_helical(
                    options, [](double, const std::string&) {}));
              }),
              HasSubstr("--wrong one-table"));
}

TEST(InternalHelicalBus, MachinesThatCannotDoItAreRefused) {
  const std::string text = host::text_of_file(host::bundled_machine("internal_grinder"));
  const auto with = [&text](const std::string& from, const std::string& to) {
    std::string changed = text;
    replace(changed, from, to);
    return complaint_of([&changed] {
      static_cast<void>(internal_helical::grinder_axes(
          host::parse_machine(changed, "mine.toml"), watched(internal_helical::LearningWay::right),
          loopback_axes()));
    });
  };
  EXPECT_THAT(with("axes = [\"C\"]", "axes = [\"X\"]"),
              HasSubstr("mine.toml: 'axes' of [correction] must contain C"));
  EXPECT_THAT(with("rate_rad_per_s = 0.2", "rate_rad_per_s = 0.1"),
              HasSubstr("mine.toml: 'rate_rad_per_s' of [correction] must be at least 0.102"));
  EXPECT_THAT(complaint_of([] {
                static_cast<void>(internal_helical::grinder_axes(
                    host::read_machine_file(host::bundled_machine("xyfz")),
                    watched(internal_helical::LearningWay::right), loopback_axes()));
              }),
              HasSubstr("the axes must be X Z C, not X Y Z"));
}

// --- disturbed, with tables in force

class DisturbedGrinder : public testing::Test {
 protected:
  // What the monitor counts of the frames, 2510h:01…06, and of passes, :07…:09.
  struct Counts {
    std::array<std::uint64_t, kFrameUses> frames{};
    std::uint64_t discarded = 0;
  };

  void SetUp() override {
    world_.grind(world_.grinder, 4);
    world_.grinder.learn();
    world_.grind(world_.grinder, 4);
    ASSERT_EQ(strokes().table_state, static_cast<std::uint8_t>(node::StrokeTableState::in_force));
  }

  // One more pass. From the middle of the face on frames with this identifier do not reach the
  // node, for so many cycles. The controller does not stop for it. Offsets of C as the drive takes
  // them, in its units, from the cycle before the first that is disturbed.
  std::vector<std::int32_t> offsets_without(std::uint16_t id, int cycles) {
    std::vector<std::int32_t> offsets;
    int in_face = 0;
    const auto lost = [&in_face, id, cycles](const hal::CanFrame& frame,
                                             const hal::LoopbackBus::Port&,
                                             const hal::LoopbackBus::Port& receiver) {
      const bool now = in_face > kBegin && in_face <= kBegin + cycles;
      return hal::LoopbackBus::Fate{now && frame.id == id && receiver.name() == "node", false, 0};
    };
    axes().bus().bus().set_fault_hook(lost);
    world_.process.pass([&](const internal_helical::StrokeStep& step) {
      if (step.in_face) ++in_face;
      axes().controller().send_process_state(step);
      axes().run_cycle({wrapped(step.x), wrapped(step.z), wrapped(step.c)});
      if (in_face >= kBegin) offsets.push_back(axes().drive(kC).offset_taken());
    });
    axes().bus().bus().set_fault_hook({});
    return offsets;
  }

  Counts counts() {
    Counts c;
    const auto read = [this](std::uint8_t sub) {
      return host::number(world_.grinder.read({0x2510, sub}, 4, "count"));
    };
    for (std::size_t use = 0; use < c.frames.size(); ++use)
      c.frames[use] = read(static_cast<std::uint8_t>(use + 1));
    c.discarded = read(9);
    return c;
  }

  static std::uint64_t of(const Counts& c, FrameUse use) {
    return c.frames[static_cast<std::size_t>(use)];
  }

  BusAxes& axes() { return world_.grinder.axes(); }
  const node::StrokeObjects& strokes() { return axes().node()->objects().stroke; }

  static constexpr std::int32_t kRate = 10'000;  // of the learned offset, 2^-31 turn
  static constexpr int kBegin = 800;             // cycles in the face before the disturbance
  GrindingOnTheBus world_;
};

// A few cycles: the offset stays what it was, the samples are not used, the pass still counts.
TEST_F(DisturbedGrinder, HoldsTheOffsetWithoutProcessState) {
  constexpr int kLost = 5;
  const Counts before = counts();
  const std::vector<std::int32_t> offsets = offsets_without(kProcessStateId, kLost);
  const Counts after = counts();
  for (int i = 1; i <= kLost; ++i)
    EXPECT_EQ(offsets[static_cast<std::size_t>(i)], offsets[0]) << i;
  EXPECT_NE(offsets[0], 0);
  EXPECT_EQ(of(after, FrameUse::invalid) - of(before, FrameUse::invalid), kLost);
  EXPECT_EQ(after.discarded, before.discarded);
}

// For long: after 20 ms it goes to 0, no faster than 2500h:09 allows, and the pass does not count.
TEST_F(DisturbedGrinder, DropsTheOffsetWhenTheProcessStateStaysAway) {
  constexpr int kLost = 60;
  const Counts before = counts();
  const std::vector<std::int32_t> offsets = offsets_without(kProcessStateId, kLost);
  const Counts after = counts();
  for (std::size_t i = 1; i <= 10; ++i)
    EXPECT_EQ(offsets[i], offsets[0]) << i;
  for (std::size_t i = 1; i < offsets.size(); ++i)
    EXPECT_LE(std::abs(offsets[i] - offsets[i - 1]), kRate) << i;
  EXPECT_EQ(offsets[kLost], 0);
  EXPECT_NE(offsets[kLost + 10], 0);
  EXPECT_EQ(of(after, FrameUse::invalid) - of(before, FrameUse::invalid), kLost);
  EXPECT_EQ(after.discarded, before.discarded + 1);
}

// The position of Z in one cycle.
TEST_F(DisturbedGrinder, DoesNotUseACycleWithoutThePositionOfZ) {
  const Counts before = counts();
  const std::vector<std::int32_t> offsets = offsets_without(canopen::kTpdo1 + 2, 1);
  const Counts after = counts();
  EXPECT_LE(std::abs(offsets[1] - offsets[0]), kRate);
  EXPECT_EQ(of(after, FrameUse::invalid) - of(before, FrameUse::invalid), 1U);
  EXPECT_EQ(after.discarded, before.discarded);
}

// A drive without power stops the machine: nothing is ground with half an offset.
TEST_F(DisturbedGrinder, StopsWithoutADrive) {
  axes().power_drive(1, false);
  EXPECT_THAT(complaint_of([this] { world_.grind(world_.grinder, 1); }),
              HasSubstr("the machine on the bus has stopped: "));
}

// Tables of another feed are put aside, and learning reports which feed they are for.
TEST_F(DisturbedGrinder, UsesTablesForTheirFeedOnly) {
  world_.process.pass([this](const internal_helical::StrokeStep& step) {
    internal_helical::StrokeStep faster = step;
    faster.feed_nm_per_s = 20'000'000;
    world_.grinder.cycle(faster);
  });
  EXPECT_EQ(axes().drive(kC).offset_taken(), 0);
  EXPECT_NE(strokes().offset_status & kOtherFeed, 0);
  EXPECT_THAT(complaint_of([this] { world_.grinder.learn(); }),
              HasSubstr("its tables are for F=13.4 mm/s, the stroke has F=20 mm/s"));
  world_.grind(world_.grinder, 1);
  EXPECT_EQ(strokes().offset_status & kOtherFeed, 0);
  EXPECT_NE(axes().drive(kC).offset_taken(), 0);
}

}  // namespace
}  // namespace volcomp::sim
