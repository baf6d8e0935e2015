// The monitor of helical strokes and what is learned from it have the same bits with every compiler
// and on every board.

#include <cstring>
#include <memory>

#include "comp/strokes/helix_instances.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "tests/oracle/fixed_numbers.hpp"

namespace volcomp::test {
namespace {

void add_bits(double value, Digest& digest) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  digest.add(static_cast<std::uint32_t>(bits), 4);
  digest.add(static_cast<std::uint32_t>(bits >> 32U), 4);
}

TEST(HelixMonitorDigest, OfFixedStrokes) {
  Fixed fixed;
  Digest digest;
  HelixMonitorSettings settings;
  settings.turn_per_mm = 1.0 / 305.25;
  settings.flank_per_rad = 74.25;
  settings.flank_per_x = 0.325;
  settings.z0_nm = -22'500'000;
  settings.nodes = 181;
  settings.time_line_hz = {50.0, 0, 0, 0};
  settings.order_wavelength_mm = {2.5, 0, 0, 0};
  const auto monitor = std::make_unique<GrinderMonitor>();
  ASSERT_TRUE(monitor->configure(settings).ok());
  const auto add = [&digest](double value) { add_bits(value, digest); };
  for (int k = 0; k < 20'000; ++k) {
    HelixFrame frame;
    frame.sequence = static_cast<std::uint16_t>(k);
    const std::int64_t z = -22'500'000 + (k % 4000) * 13'400;
    frame.z = {z, z + fixed.integer(-200'000, 200'000),
               static_cast<std::int32_t>(fixed.integer(0, 200'000)), true};
    frame.x = {44'000'000, 44'000'000 + fixed.integer(-9'000, 9'000), 0, true};
    const std::int64_t c = -z * 573;
    frame.c = {c, c + fixed.integer(-90'000'000, 90'000'000), 0, fixed.integer(0, 999) != 0};
    frame.slot = static_cast<std::uint16_t>(k / 4000);
    frame.stroke = Direction::forward;
    frame.in_face = k % 4000 < 3400;
    monitor->tick(frame);
    add(static_cast<double>(monitor->signals().sync_um));
    add(static_cast<double>(monitor->signals().x_um));
    digest.end_record();
    if (!monitor->pass_waits()) continue;
    EXPECT_TRUE(monitor->collect().ok());
  }
  const auto& spectra = monitor->totals().spectra(Direction::forward);
  add(spectra.of(FlankSignal::sync).mean());
  add(spectra.of(FlankSignal::sync).variance());
  add(spectra.order[0].with_sine);
  digest.end_record();
  EXPECT_EQ(digest.value(), 1718931644U);
}

TEST(HelixLearningDigest, OfFixedSums) {
  constexpr std::size_t kNodes = 181;
  Fixed fixed;
  Digest digest;
  LearningRules rules;
  rules.least_samples = 8;
  rules.dead_sigma = 1.0;
  rules.most_step = 1e-3;
  rules.most_offset = 2e-3;
  rules.most_slope = 1e-3;
  rules.spacing = 0.25;
  const auto learner = std::make_unique<OffsetLearner<kNodes>>();
  ASSERT_TRUE(learner->start(rules, kNodes).ok());
  for (int update = 0; update < 6; ++update) {
    std::array<NodeSums, kNodes> sums{};
    for (NodeSums& node : sums) {
      const auto samples = static_cast<int>(fixed.integer(4, 12));
      for (int n = 0; n < samples; ++n)
        node.add(static_cast<double>(fixed.integer(-60'000, 60'000)) * 1e-9);
    }
    const double rms = rms_of_means(rules, {sums.data(), sums.size()});
    const LearnerStep step = learner->step(74.25e3 * rms, {sums.data(), sums.size()});
    add_bits(rms, digest);
    digest.add(static_cast<std::uint32_t>(step.report.updated), 4);
    digest.end_record();
    for (const double offset : learner->table()) {
      add_bits(offset, digest);
      digest.end_record();
    }
  }
  EXPECT_EQ(digest.value(), 1371815303U);
}

}  // namespace
}  // namespace volcomp::test
