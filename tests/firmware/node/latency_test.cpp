// 2620h: how long the node takes from the last target to the last frame to a drive.

#include "firmware/node/latency.hpp"

#include <cmath>

#include "comp/core/bytes.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

TEST(LatencyBins, AreQuartersOfAnOctaveFrom4us) {
  for (std::uint32_t us = 4; us < 262'144; us += 1 + us / 200) {
    const double quarters = 4.0 * std::log2(us / 4.0);
    // A duration within 1e-4 of a border may be on either side of it.
    if (std::abs(quarters - std::round(quarters)) < 1e-4 && us > 4) continue;
    EXPECT_EQ(Latency::bin_of(us), static_cast<std::size_t>(quarters)) << us;
  }
  EXPECT_EQ(Latency::bin_of(0), 0U);
  EXPECT_EQ(Latency::bin_of(1'000'000), Latency::kBins - 1);
  for (std::size_t bin = 0; bin < Latency::kBins; ++bin)
    EXPECT_NEAR(Latency::end_of(bin), 4.0 * std::exp2((static_cast<double>(bin) + 1.0) / 4.0), 1.0);
}

TEST(LatencyQuantiles, AreThoseOfTheCycles) {
  Latency latency;
  test::Random random(5);
  std::vector<std::uint32_t> all;
  std::uint64_t now = 1'000;
  for (int i = 0; i < 20'000; ++i) {
    latency.sync(now);
    const auto us = static_cast<std::uint32_t>(std::exp(random.in(2.0, 8.0)));
    latency.target(now + 300);
    latency.sent(now + 300 + us);
    all.push_back(us);
    now += 4'000;
  }
  latency.sync(now);
  std::sort(all.begin(), all.end());
  EXPECT_EQ(latency.cycles(), all.size());
  EXPECT_EQ(latency.least_us(), all.front());
  EXPECT_EQ(latency.largest_us(), all.back());
  EXPECT_EQ(latency.until_target_us(), 300U);
  for (const unsigned thousandths : {500U, 900U, 999U}) {
    const double exact = all[all.size() * thousandths / 1000U];
    EXPECT_GE(latency.quantile_us(thousandths), exact * 0.99);
    EXPECT_LE(latency.quantile_us(thousandths), exact * 1.2);
  }
}

// Cycles of a bench that takes the targets 200 µs after SYNC and lets the node send 100 µs later.
TEST(NodeLatency, IsReadAndBegunAnew) {
  NodeBench bench;
  bench.bring_up();
  ASSERT_EQ(bench.set<std::uint32_t>(0x2620, 1, 0), canopen::AbortCode::none);
  for (int i = 0; i < 50; ++i) {
    bench.sync();
    bench.wait(200);
    for (std::size_t a = 0; a < NodeBench::kDrives; ++a) {
      bench.drive_data(a);
      bench.offset_report(a);
    }
    bench.port_full = true;
    for (std::size_t a = 0; a < NodeBench::kDrives; ++a)
      bench.controller_data(a);
    bench.wait(100);
    bench.port_full = false;
    bench.wait(1'700);
  }
  EXPECT_EQ(bench.number(0x2620, 1), 49U);
  EXPECT_EQ(bench.number(0x2620, 2), 200U) << "the next step of the bench";
  EXPECT_EQ(bench.number(0x2620, 5), 200U);
  EXPECT_EQ(bench.number(0x2620, 7), 200U);
  Bytes histogram;
  ASSERT_EQ(bench.read({0x2620, 6}, histogram), canopen::AbortCode::none);
  ASSERT_EQ(histogram.size(), 256U);
  EXPECT_EQ(load_le(&histogram[4 * Latency::bin_of(200)], 4), 49U);
  EXPECT_EQ(bench.set<std::uint32_t>(0x2620, 1, 1), canopen::AbortCode::value_too_high);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2620, 1, 0), canopen::AbortCode::none);
  EXPECT_EQ(bench.number(0x2620, 5), 0U);
}

}  // namespace
}  // namespace volcomp::node
