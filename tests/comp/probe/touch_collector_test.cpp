// Every way an edge can reach the node, in order or not: complete touches are numbered and timed,
// the others are reported by name.

#include "comp/probe/touch_collector.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace volcomp::test {
namespace {

constexpr std::int64_t kPeriod_ns = 2'000'000;

// Three drives that latch one edge after the other.
class Drives {
 public:
  Drives() {
    TouchRules rules;
    rules.axes = 0b111;
    rules.period_ns = kPeriod_ns;
    rules.delay_ns = {2'000, 5'000, 8'000};
    collector.configure(rules);
    delay_ns = rules.delay_ns;
    for (std::size_t a = 0; a < 3; ++a)
      tell[a] = homed[a] = moving[a] = true;
    count = {7, 65'534, 400};
  }

  // An edge of the probe, so long after the last SYNC.
  void edge(std::int64_t after_ns) {
    for (std::size_t a = 0; a < 3; ++a) {
      ++count[a];
      latch(a, after_ns + delay_ns[a]);
    }
  }
  void latch(std::size_t a, std::int64_t after_ns) {
    const bool next = after_ns >= kPeriod_ns;
    (next ? later_ : now_)[a] = static_cast<std::uint32_t>(next ? after_ns - kPeriod_ns : after_ns);
  }

  // The next SYNC, and what is reported after it.
  std::optional<Touch> cycle() {
    for (std::size_t a = 0; a < 3; ++a) {
      LatchReport r;
      r.homed = homed[a];
      r.moving = moving[a];
      if (now_[a] && tell[a]) {
        r.latched = r.counted = true;
        r.time_ns = *now_[a];
        r.edge_count = count[a];
        r.axis = {1000 * static_cast<std::int64_t>(a) + count[a], 5.0, Direction::backward};
      }
      if (on_report) on_report(a, r);
      collector.report(a, r);
    }
    now_ = later_;
    later_ = {};
    const Touch* const touch = collector.finish_cycle();
    if (touch == nullptr) return std::nullopt;
    return *touch;
  }
  std::optional<Touch> cycles(int n) {
    for (int i = 0; i < n; ++i) {
      if (const auto touch = cycle()) return touch;
    }
    return std::nullopt;
  }

  TouchCollector collector;
  std::array<std::uint16_t, 3> count;
  std::array<std::int64_t, kMaxAxes> delay_ns{};
  std::array<bool, 3> tell{};  // otherwise nothing of this edge is reported
  std::array<bool, 3> homed{};
  std::array<bool, 3> moving{};
  std::function<void(std::size_t, LatchReport&)> on_report;

 private:
  std::array<std::optional<std::uint32_t>, 3> now_{};
  std::array<std::optional<std::uint32_t>, 3> later_{};
};

// A bench on which one touch has gone well.
std::unique_ptr<Drives> used() {
  auto drives = std::make_unique<Drives>();
  drives->edge(300'000);
  const auto touch = drives->cycle();
  EXPECT_TRUE(touch && touch->verdict == TouchVerdict::point);
  EXPECT_FALSE(drives->cycles(5));
  return drives;
}

void expect_verdict(const std::optional<Touch>& touch, TouchVerdict verdict, int axis) {
  ASSERT_TRUE(touch);
  EXPECT_STREQ(code(touch->verdict), code(verdict));
  EXPECT_EQ(touch->axis, axis);
}

// Axis 2 does not say when: an edge anywhere in its cycle can have been that of the others, one of
// another cycle cannot.
TEST(TouchCollector, AnUnknownTimeIsTheWholeCycle) {
  for (const std::int64_t after_ns : {0, 700'000, 1'990'000}) {
    const auto d = std::make_unique<Drives>();
    TouchRules rules;
    rules.axes = 0b111;
    rules.untimed = 0b100;
    rules.period_ns = kPeriod_ns;
    d->collector.configure(rules);
    d->delay_ns = {};
    d->on_report = [](std::size_t a, LatchReport& r) {
      if (a == 2) r.time_ns = 0;
    };
    d->edge(after_ns);
    expect_verdict(d->cycle(), TouchVerdict::point, 0);
    d->latch(0, 1'500'000);
    d->latch(1, 1'500'000);
    for (std::size_t a = 0; a < 3; ++a)
      ++d->count[a];
    EXPECT_FALSE(d->cycle());
    EXPECT_FALSE(d->cycle());
    d->latch(2, 500'000);
    expect_verdict(d->cycle(), TouchVerdict::skew, 2);
  }
}

TEST(TouchCollector, ATouchIsWhatEveryAxisLatched) {
  const auto d = used();
  d->edge(1'200'000);
  const auto touch = d->cycle();
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->sequence, 2U);
  EXPECT_EQ(touch->verdict, TouchVerdict::point);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(touch->latched[a].position, static_cast<std::int64_t>(1000 * a) + d->count[a]);
    EXPECT_EQ(touch->latched[a].velocity, 5.0);
    EXPECT_EQ(touch->latched[a].direction, Direction::backward);
  }
  EXPECT_FALSE(d->cycles(10));
}

TEST(TouchCollector, AnEdgeBesideASyncIsReportedInTwoCycles) {
  const auto d = used();
  for (const std::int64_t before_sync : {1'000, 3'000, 6'000, 7'999}) {
    d->edge(kPeriod_ns - before_sync);
    EXPECT_FALSE(d->cycle());
    const auto touch = d->cycle();
    ASSERT_TRUE(touch) << before_sync;
    EXPECT_EQ(touch->verdict, TouchVerdict::point) << before_sync;
    EXPECT_FALSE(d->cycles(3));
  }
}

TEST(TouchCollector, BounceIsTold) {
  const auto d = used();
  d->edge(1'900'000);
  EXPECT_EQ(d->cycle()->verdict, TouchVerdict::point);
  d->edge(800'000);  // 0.9 ms later
  expect_verdict(d->cycle(), TouchVerdict::bounce, 0);
  d->edge(1'800'000);  // 3 ms after the bounce
  expect_verdict(d->cycle(), TouchVerdict::point, 0);
}

TEST(TouchCollector, TwoEdgesInACycleAreTold) {
  const auto d = used();
  d->edge(400'000);
  d->edge(410'000);
  expect_verdict(d->cycle(), TouchVerdict::double_edge, 0);
  d->edge(400'000);
  expect_verdict(d->cycle(), TouchVerdict::point, 0);
}

// A drive may count at once and report the position after the next SYNC.
TEST(TouchCollector, TheCounterMayComeFirst) {
  const auto d = used();
  d->on_report = [&](std::size_t a, LatchReport& r) {
    r.counted = true;
    r.edge_count = d->count[a];
  };
  for (auto& count : d->count)
    ++count;
  EXPECT_FALSE(d->cycle());
  d->on_report = {};
  for (std::size_t a = 0; a < 3; ++a)
    d->latch(a, kPeriod_ns - 6'000 + d->delay_ns[a]);  // that of axis 2 falls into the next cycle
  EXPECT_FALSE(d->cycle());
  expect_verdict(d->cycle(), TouchVerdict::point, 0);
}

TEST(TouchCollector, AMissingAxisIsToldInTheEnd) {
  for (int missing = 0; missing < 3; ++missing) {
    const auto d = used();
    d->tell[static_cast<std::size_t>(missing)] = false;
    d->edge(400'000);
    EXPECT_FALSE(d->cycles(2));
    const auto touch = d->cycle();
    expect_verdict(touch, TouchVerdict::axis_missing, missing);
    EXPECT_EQ(touch->latched[static_cast<std::size_t>(missing)].position, 0);
    const auto other = static_cast<std::size_t>((missing + 1) % 3);
    EXPECT_NE(touch->latched[other].position, 0) << "the raw latch is kept";
  }
}

TEST(TouchCollector, HalfAReportIsTold) {
  auto d = used();
  d->on_report = [](std::size_t a, LatchReport& r) { r.latched = r.latched && a != 1; };
  d->edge(400'000);
  EXPECT_FALSE(d->cycles(2));
  expect_verdict(d->cycle(), TouchVerdict::no_position, 1);

  d = used();
  d->on_report = [](std::size_t a, LatchReport& r) { r.counted = r.counted && a != 2; };
  d->edge(400'000);
  EXPECT_FALSE(d->cycles(2));
  expect_verdict(d->cycle(), TouchVerdict::stale_latch, 2);
}

// A drive that repeats an earlier report.
TEST(TouchCollector, ALatchWithoutAnEdgeIsTold) {
  const auto d = used();
  for (std::size_t a = 0; a < 3; ++a)
    d->latch(a, 300'000);
  EXPECT_FALSE(d->cycles(2));
  expect_verdict(d->cycle(), TouchVerdict::stale_latch, 0);
}

TEST(TouchCollector, LatchesOfDifferentEdgesAreTold) {
  const auto d = used();
  d->edge(400'000);
  d->latch(2, 400'000 + 8'000 + 2'001);  // latched by another edge
  expect_verdict(d->cycle(), TouchVerdict::skew, 2);
  d->edge(400'000);
  d->latch(2, 400'000 + 8'000 + 2'000);
  expect_verdict(d->cycle(), TouchVerdict::point, 0);
}

// 60D1h of a drive that has not seen SYNC for long, or that counts otherwise.
TEST(TouchCollector, TimesBeyondACycleAreTold) {
  const auto d = used();
  for (const std::uint32_t time_ns : {2'000'001U, 4'000'000'000U, 4'294'967'295U}) {
    d->on_report = [=](std::size_t a, LatchReport& r) { r.time_ns = a == 1 ? time_ns : r.time_ns; };
    d->edge(400'000);
    expect_verdict(d->cycle(), TouchVerdict::late_latch, 1);
  }
}

TEST(TouchCollector, UnreferencedAxesAndUnknownSpeedsAreTold) {
  const auto d = used();
  d->homed[1] = false;
  d->edge(400'000);
  expect_verdict(d->cycle(), TouchVerdict::not_homed, 1);
  d->homed[1] = true;
  d->moving[2] = false;
  d->edge(400'000);
  expect_verdict(d->cycle(), TouchVerdict::no_velocity, 2);
}

TEST(TouchCollector, EveryEdgeHasANumber) {
  const auto d = used();
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 50; ++i) {
    d->tell[0] = i % 3 != 0;
    d->edge(400'000);
    if (i % 5 == 0) d->edge(500'000);
    const auto touch = d->cycles(3);
    ASSERT_TRUE(touch);
    EXPECT_TRUE(seen.insert(touch->sequence).second);
    d->tell[0] = true;
    EXPECT_FALSE(d->cycles(2));
  }
  EXPECT_EQ(*seen.begin(), 2U);
  EXPECT_EQ(*seen.rbegin(), 51U);
}

// Counters wrap, and what they count before the node listens does not matter.
TEST(TouchCollector, CountersStartAnywhere) {
  const auto d = used();  // axis 1 has wrapped
  d->collector.restart();
  for (auto& count : d->count)
    count = static_cast<std::uint16_t>(count + 1234);
  d->edge(700'000);
  const auto touch = d->cycle();
  expect_verdict(touch, TouchVerdict::point, 0);
  EXPECT_EQ(touch->sequence, 2U);
}

TEST(TouchCollector, TheFirstCountAfterAStartMayBeAnEdge) {
  Drives d;
  d.on_report = [&](std::size_t a, LatchReport& r) {
    r.counted = true;
    r.edge_count = d.count[a];
  };
  EXPECT_FALSE(d.cycle());
  d.on_report = {};
  for (std::size_t a = 0; a < 3; ++a)
    d.latch(a, 500'000 + d.delay_ns[a]);
  d.on_report = [](std::size_t, LatchReport& r) { r.counted = false; };
  expect_verdict(d.cycle(), TouchVerdict::point, 0);
}

// Drives send their process data once when they start: a counter that stands still is no edge.
TEST(TouchCollector, TheFirstReportIsNoEdge) {
  Drives d;
  d.on_report = [&](std::size_t a, LatchReport& r) {
    r.counted = true;
    r.edge_count = d.count[a];
  };
  EXPECT_FALSE(d.cycles(3));
  d.on_report = {};
  d.edge(700'000);
  expect_verdict(d.cycle(), TouchVerdict::point, 0);
}

TEST(TouchCollector, VerdictsHaveNamesAndSentences) {
  std::set<std::string> codes;
  for (int v = 0; v <= static_cast<int>(TouchVerdict::no_machine); ++v) {
    const auto verdict = static_cast<TouchVerdict>(v);
    EXPECT_TRUE(codes.insert(code(verdict)).second);
    EXPECT_EQ(std::string(sentence(verdict)).back(), '.');
    EXPECT_EQ(accepted(verdict), v <= 3);
  }
}

}  // namespace
}  // namespace volcomp::test
