// Monitor, learner and offsets together on a simulated stroke: the lag of two position loops whose
// gains differ, a ripple of Z and an indexing error of C, all repeatable.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "comp/strokes/helix_instances.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

constexpr double kFeed = 13.4;   // mm/s
constexpr double kGainZ = 83.3;  // 1/s
constexpr double kGainC = 0.966 * kGainZ;
constexpr std::size_t kSlots = 4;
constexpr std::size_t kNodes = 181;
constexpr std::array<Direction, 2> kDirections{Direction::forward, Direction::backward};

// What is learned from and put onto.
enum class Way { per_direction, one_table, c_alone };

class Loop {
 public:
  explicit Loop(Way way) : way_(way) {
    HelixMonitorSettings settings;
    settings.turn_per_mm = gear_.turn_per_mm;
    settings.flank_per_rad = gear_.normal_lever();
    settings.flank_per_x = 0.325;
    settings.z0_nm = to_nm(-22.5);
    settings.nodes = kNodes;
    EXPECT_TRUE(monitor_->configure(settings).ok());
    StrokeOffsetSettings offsets;
    offsets.rate = 1 << 20;
    EXPECT_TRUE(offsets_->configure(offsets).ok());
    LearningRules rules;
    rules.least_samples = 2;
    rules.most_step = 1e-3;
    rules.most_offset = 2e-3;
    rules.most_slope = 1e-3;
    rules.spacing = 0.25;
    for (auto& learner : stroke_)
      EXPECT_TRUE(learner.start(rules, kNodes).ok());
    rules.periodic = true;
    rules.spacing = 1.0;
    rules.taps = {1.0};
    rules.tap_count = 1;
    EXPECT_TRUE(slot_.start(rules, kSlots).ok());
  }

  // All slots up and down once. RMS on the flank, µm.
  double round() {
    monitor_->totals().clear();
    squares_ = count_ = 0.0;
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      for (const Direction d : kDirections) {
        pass(static_cast<std::uint16_t>(slot), d);
        EXPECT_TRUE(monitor_->collect().ok());
      }
    }
    return std::sqrt(squares_ / count_);
  }

  void learn() {
    std::vector<NodeSums> up(kNodes);
    std::vector<NodeSums> down(kNodes);
    std::vector<NodeSums> slots(kSlots);
    monitor_->totals().stroke_sums(Direction::forward, up);
    monitor_->totals().stroke_sums(Direction::backward, down);
    monitor_->totals().slot_sums(slots);
    if (way_ == Way::one_table) {
      for (std::size_t j = 0; j < kNodes; ++j) {
        up[j].n += down[j].n;
        up[j].sum += down[j].sum;
        up[j].sum_squares += down[j].sum_squares;
        down[j] = up[j];
      }
    }
    step(stroke_[0], up);
    step(stroke_[1], down);
    step(slot_, slots);
    ASSERT_TRUE(offsets_
                    ->stage({stroke_[0].table(), stroke_[1].table(), slot_.table(), to_nm(-22.5),
                             250'000, 13'400'000})
                    .ok());
    ASSERT_TRUE(offsets_->activate().ok());
  }

 private:
  template <std::size_t N>
  void step(OffsetLearner<N>& learner, const std::vector<NodeSums>& sums) {
    const double J = kUmPerMm * gear_.normal_lever() * rms_of_means(learner.rules(), sums);
    learner.step(J, sums);
  }

  // Actual − original command without our offset: both lag the command, C the more.
  static double error_z(double velocity, double z) {
    return -velocity / kGainZ + 0.003 * std::sin(2.0 * kPi * z / 10.0);
  }
  [[nodiscard]] double error_c(double velocity, std::size_t slot) const {
    const double lag = velocity * gear_.turn_per_mm / kGainC;
    return lag + 44e-6 * std::cos(2.0 * kPi * static_cast<double>(slot) / kSlots);
  }

  void pass(std::uint16_t slot, Direction d) {
    const double velocity = d == Direction::forward ? kFeed : -kFeed;
    for (int k = 0; k < 3600; ++k) {
      const double z = velocity * (k - 1800) * 1e-3;
      StrokeState state;
      state.z_command = to_nm(z);
      state.feed_nm_per_s = 13'400'000;
      state.slot = slot;
      state.stroke = d;
      state.in_face = std::abs(z) <= 22.5;
      state.stroke_end = k == 0;
      state.fresh = state.homed = true;
      const std::int64_t offset = std::int64_t{offsets_->tick(state)} * 256;
      HelixFrame frame;
      frame.sequence = ++sequence_;
      frame.slot = slot;
      frame.stroke = d;
      frame.in_face = state.in_face;
      const double e_z = error_z(velocity, z);
      const double e_c = error_c(velocity, slot);
      const std::int64_t c = to_units(-z * gear_.turn_per_mm, kUnitsPerRad);
      frame.x.valid = true;
      // Learning C alone is to look away from Z.
      const double seen_z = way_ == Way::c_alone ? 0.0 : e_z;
      frame.z = {state.z_command, state.z_command + to_nm(seen_z), 0, true};
      const std::int64_t actual_c = c + to_units(e_c, kUnitsPerRad) + offset;
      frame.c = {c, actual_c, 0, true};
      monitor_->tick(frame);
      if (!state.in_face) continue;
      const double moved = static_cast<double>(actual_c - c) / kUnitsPerRad;
      const double flank =
          kUmPerMm * synchronisation_on_flank(gear_, synchronisation_error(gear_, e_z, moved));
      squares_ += flank * flank;
      count_ += 1.0;
    }
  }

  Way way_;
  InternalGear gear_ = paper_gear();
  std::unique_ptr<GrinderMonitor> monitor_ = std::make_unique<GrinderMonitor>();
  std::unique_ptr<GrinderOffsets> offsets_ = std::make_unique<GrinderOffsets>();
  std::array<OffsetLearner<kNodes>, 2> stroke_{};
  OffsetLearner<kSlots> slot_{};
  std::uint16_t sequence_ = 0;
  double squares_ = 0.0;
  double count_ = 0.0;
};

struct BeforeAndAfter {
  explicit BeforeAndAfter(Way way) {
    Loop loop(way);
    before = loop.round();
    for (int update = 0; update < 6; ++update) {
      loop.learn();
      after = loop.round();
    }
  }
  double before = 0.0;
  double after = 0.0;
};

TEST(LearningLoop, TakesAwayWhatComesBack) {
  const BeforeAndAfter um(Way::per_direction);
  EXPECT_GT(um.before, 2.0);
  EXPECT_LT(um.after, 0.05 * um.before) << "half per update at low order";
}

// A lag changes its sign with the direction: one table for both learns their mean, which is 0.
TEST(LearningLoop, OneTableForBothDirectionsLeavesTheLag) {
  const BeforeAndAfter um(Way::one_table);
  EXPECT_GT(um.after, 10.0 * BeforeAndAfter(Way::per_direction).after);
}

// Removing the lag of C destroys the balance of both.
TEST(LearningLoop, LearningCAlonePutsTheLagOfZOnTheFlank) {
  const BeforeAndAfter um(Way::c_alone);
  EXPECT_GT(um.after, 5.0 * um.before);
  EXPECT_NEAR(um.after,
              1e3 * paper_gear().normal_lever() * paper_gear().turn_per_mm * kFeed / kGainZ, 2.0);
}

}  // namespace
}  // namespace volcomp::test
