#pragma once
// A node on its bench with a probe: edges at the drives, settings, points as they are read.

#include <cstring>

#include <gtest/gtest.h>

#include "comp/core/bytes.hpp"
#include "comp/tick/touch.hpp"
#include "firmware/node/probe/point_fifo.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {

using canopen::AbortCode;

inline constexpr std::uint32_t kLatch_ns = 700'000;

template <class T>
T value_at(const Bytes& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, &bytes.at(at), sizeof value);
  return value;
}

// A point as 2410h gives it.
struct ReadPoint {
  explicit ReadPoint(const Bytes& b)
      : sequence(value_at<std::uint32_t>(b, 0)),
        feature(value_at<std::uint32_t>(b, 4)),
        verdict(static_cast<TouchVerdict>(b[8])),
        axis(b[9]),
        flank_verdict(b[10]),
        foot_verdict(b[11]),
        side(static_cast<std::int8_t>(b[12])),
        row(b[13]),
        column(b[14]),
        slot(value_at<std::uint16_t>(b, 76)),
        distance(value_at<double>(b, 160)) {
    for (std::size_t k = 0; k < 3; ++k) {
      machine[k] = value_at<std::int64_t>(b, 16 + 8 * k);
      workpiece[k] = value_at<std::int64_t>(b, 40 + 8 * k);
      uncertainty[k] = value_at<float>(b, 64 + 4 * k);
      latched[k] = value_at<std::int64_t>(b, 80 + 8 * k);
      speed[k] = value_at<double>(b, 120 + 8 * k);
      foot[static_cast<int>(k)] = value_at<double>(b, 168 + 8 * k);
    }
  }
  std::uint32_t sequence;
  std::uint32_t feature;
  TouchVerdict verdict;
  std::uint8_t axis;
  std::uint8_t flank_verdict;
  std::uint8_t foot_verdict;
  std::int8_t side;
  std::uint8_t row;
  std::uint8_t column;
  std::uint16_t slot;
  double distance;  // mm
  Vec3 foot = Vec3::Zero();
  std::array<std::int64_t, 3> machine{};
  std::array<std::int64_t, 3> workpiece{};
  std::array<float, 3> uncertainty{};
  std::array<std::int64_t, 3> latched{};
  std::array<double, 3> speed{};
};

class NodeProbe : public testing::Test {
 protected:
  AbortCode set_real(std::uint16_t index, std::uint8_t sub, double value) {
    Bytes bytes(sizeof value);
    std::memcpy(bytes.data(), &value, sizeof value);
    return bench.write({index, sub}, bytes);
  }
  AbortCode switch_on() { return bench.set<std::uint8_t>(0x2300, 1, 1); }
  void start(const MachineTables& tables = bench_tables()) {
    bench.bring_up(tables);
    ASSERT_EQ(switch_on(), AbortCode::none);
    bench.cycles(3);
  }

  // An edge in this cycle, reported after the next SYNC; the axes move on by `step`.
  void edge(std::int32_t step = -1000) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (counts[a]) send(0x381U + a, ++edges[a], 6);
      bench.drive[a].target += step;
    }
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      bench.drive_data(a);
      if (latches[a]) send_latch(a);
      bench.offset_report(a);
      bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
    bench.cycle();
  }
  void send(std::size_t id, std::uint32_t value, std::uint8_t size) {
    hal::CanFrame f = bench_frame(static_cast<unsigned>(id), size);
    store_le(f.data.data(), size, value);
    bench.give(f);
  }
  void send_latch(std::size_t a) {
    hal::CanFrame f = bench_frame(static_cast<unsigned>(0x281U + a), 8);
    store_le(f.data.data(), 4, static_cast<std::uint32_t>(position(a)));
    store_le(&f.data[4], 4, kLatch_ns);
    bench.give(f);
  }
  [[nodiscard]] std::int32_t position(std::size_t a) const {
    return bench.drive[a].target + bench.drive[a].held + 321;
  }

  ReadPoint oldest() {
    Bytes bytes;
    EXPECT_EQ(bench.read({0x2410, 1}, bytes), AbortCode::none);
    EXPECT_EQ(bytes.size(), kPointBytes);
    bytes.resize(kPointBytes);
    return ReadPoint(bytes);
  }
  ReadPoint take() {
    const ReadPoint point = oldest();
    EXPECT_EQ(bench.set<std::uint32_t>(0x2411, 0, point.sequence), AbortCode::none);
    return point;
  }
  // The last process data with this identifier.
  [[nodiscard]] const hal::CanFrame* sent(unsigned id) const {
    for (auto f = bench.sent.rbegin(); f != bench.sent.rend(); ++f) {
      if (f->id == id) return &*f;
    }
    return nullptr;
  }

  NodeBench bench;
  std::array<std::uint16_t, 3> edges{5, 6, 7};
  std::array<bool, 3> counts{true, true, true};
  std::array<bool, 3> latches{true, true, true};
};

}  // namespace volcomp::node
