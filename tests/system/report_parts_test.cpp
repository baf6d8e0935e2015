// Parts of reports and of the live page, with data made by hand.

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "comp/core/units.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/positioning.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/volume_map.hpp"
#include "host_sim/sim/controller/tick_statistics.hpp"
#include "host_sim/sim/live/host_header.hpp"
#include "host_sim/sim/live/live_feed.hpp"

namespace volcomp::sim {
namespace {

using nlohmann::json;

// A machine with a slide and a table, on a bus.
MachineSnapshot snapshot(std::uint64_t cycle) {
  MachineSnapshot s;
  s.cycle = cycle;
  s.period_s = 0.002;
  s.axes = 2;
  s.axis[0].letter = 'X';
  s.axis[1].letter = 'C';
  s.axis[1].rotary = true;
  for (std::size_t a = 0; a < 2; ++a)
    s.axis[a].correction_status = static_cast<std::uint16_t>(kValid);
  s.bus = BusState{};
  s.bus->now_ns = cycle * 2'000'000U;
  s.bus->busy_ns = cycle * 500'000U;
  return s;
}

TEST(ReportParts, TickStatisticsCountWhatWentBy) {
  TickStatistics ticks;
  MachineTicks first;
  MachineTicks second;
  ticks.enter();
  ticks.enter();
  MachineSnapshot s = snapshot(1);
  s.axis[0].offset = -7;
  first.cycle(s);
  s = snapshot(2);
  s.axis[0].offset = 5;
  s.axis[0].correction_status = static_cast<std::uint16_t>(kValid | kClamped);
  s.axis[1].latches = 2;
  ticks.take(first);
  first.cycle(s);
  s = snapshot(1);  // its counters begin again
  s.axis[0].offset = 6;
  s.axis[1].latches = 1;
  second.cycle(s);
  for (int again = 0; again < 2; ++again) {  // what was taken is not taken twice
    ticks.take(second);
    ticks.take(first);
  }

  EXPECT_EQ(ticks.machines(), 2U);
  EXPECT_EQ(ticks.periods(), 3U);
  EXPECT_DOUBLE_EQ(ticks.machine_time_s(), 0.006);
  ASSERT_EQ(ticks.axes().size(), 2U);
  const AxisTicks& x = ticks.axes()[0];
  EXPECT_EQ(x.letter, 'X');
  EXPECT_EQ(x.largest_offset, 7);
  EXPECT_EQ(x.largest_change, 12);  // never from one machine to another
  EXPECT_EQ(x.reported, 3U);
  EXPECT_EQ(x.periods[bit_of(kClamped)], 1U);
  EXPECT_EQ(x.periods[bit_of(kValid)], 3U);
  EXPECT_EQ(ticks.latches(), 3U);
  EXPECT_DOUBLE_EQ(ticks.bus_load(), 0.25);
}

TEST(ReportParts, LiveStateIsThatOfTheLastPeriod) {
  LiveFeed feed("volcomp run something", "by hand");
  EXPECT_EQ(feed.state()["phase"], "running");
  EXPECT_TRUE(feed.state()["outcome"].is_null());
  const std::unique_ptr<MachineObserver> machine = feed.enter();
  machine->cycle(snapshot(1));
  for (std::uint64_t cycle = 2; cycle <= 100; ++cycle) {
    MachineSnapshot s = snapshot(cycle);
    s.axis[0].target = 12'345'678;
    s.axis[0].offset = -1'500;
    s.axis[0].position = 12.344178;
    s.axis[0].latches = s.axis[1].latches = cycle >= 50 ? 1 : 0;
    s.axis[1].target = kUnitsPerTurn / 4;
    s.axis[1].position = kPi / 2.0;
    s.axis[1].correction_status = static_cast<std::uint16_t>(kValid | kOutOfRange);
    machine->cycle(s);
  }
  const json state = feed.state();
  const json& x = state["axes"][0];
  EXPECT_EQ(x["axis"], "X");
  EXPECT_DOUBLE_EQ(x["target"], 12.345678);
  EXPECT_DOUBLE_EQ(x["position"], 12.344178);
  EXPECT_DOUBLE_EQ(x["correction"], -1.5);
  EXPECT_EQ(x["correction_unit"], "µm");
  EXPECT_TRUE(x["drive"].is_null());
  EXPECT_EQ(x["states"], json({"valid"}));
  const json& c = state["axes"][1];
  EXPECT_NEAR(c["target"], 90.0, 1e-12);
  EXPECT_NEAR(c["position"], 90.0, 1e-12);
  EXPECT_EQ(c["states"], json({"valid", "out of range"}));
  EXPECT_NEAR(state["bus"]["load_percent"], 25.0, 1e-12);
  EXPECT_NEAR(state["time_s"], 0.2, 1e-12);
  // One touch, seen by two latches in period 50.
  EXPECT_EQ(state["probe_edges"], 2);
  ASSERT_EQ(state["hits"].size(), 1U);
  EXPECT_EQ(state["hits"][0]["axes"], "X C");
  EXPECT_NEAR(state["hits"][0]["time_s"], 0.1, 1e-12);
}

TEST(ReportParts, LivePageTellsTheOutcome) {
  LiveFeed feed("", "");
  host::ReportParts parts;
  parts.verdict = {true, "as good as it gets"};
  parts.before_after = host::before_after_table({{"error", 8.0, 2.0}}, "");
  parts.provenance = host::provenance({}, {});
  feed.ended(host::report_document(parts), false);
  const json state = feed.state();
  EXPECT_EQ(state["phase"], "ended");
  EXPECT_EQ(state["outcome"]["verdict"]["text"], "as good as it gets");
  EXPECT_EQ(state["outcome"]["result"]["id"], "before-after");
  LiveFeed broken("", "");
  broken.failed("the node has stopped");
  EXPECT_EQ(broken.state()["phase"], "failed");
  EXPECT_EQ(broken.state()["outcome"]["verdict"]["text"], "the node has stopped");
}

TEST(ReportParts, OnlyOwnNamesReachTheServer) {
  EXPECT_TRUE(names_this_server("localhost:8470", 8470));
  EXPECT_TRUE(names_this_server("127.0.0.1:8470", 8470));
  EXPECT_TRUE(names_this_server("LocalHost:8470", 8470));
  EXPECT_TRUE(names_this_server("localhost", 80));
  for (const char* host : {"", ":8470", "localhost", "127.0.0.1", "localhost:8471",
                           "localhost:", "localhost:08470", "localhost:8470 ", "localhost.:8470",
                           "127.0.0.1.example.com:8470", "[::1]:8470", "127.1:8470"})
    EXPECT_FALSE(names_this_server(host, 8470)) << host;
}

TEST(ReportParts, ChangeIsOfTheAmountBefore) {
  const json table = host::before_after_table({{"error", 8.0, 2.0}, {"nothing", 0.0, 1.0}}, "");
  const json& rows = table["rows"];
  EXPECT_DOUBLE_EQ(rows[0][4], -75.0);
  EXPECT_TRUE(rows[1][4].is_null());
  EXPECT_EQ(table["columns"].size(), 5U);  // no truth, no grades
}

// A round factor, and arrows as long as they may be but not longer.
TEST(ReportParts, MagnificationIsRoundAndFits) {
  const std::vector<Vec3> points{{0.0, 0.0, 0.0}, {500.0, 300.0, 400.0}};
  for (const double longest_mm : {1e-5, 0.013, 0.041, 0.3, 2.0}) {
    const json map =
        host::volume_map("", points, {{"a", {{longest_mm, 0.0, 0.0}, {0.0, 0.0, 0.0}}}}, "");
    const double factor = map["magnification"];
    const double drawn_mm = factor * longest_mm;
    EXPECT_LE(drawn_mm, 60.0 * (1.0 + 1e-9));
    EXPECT_GT(drawn_mm, 60.0 / 2.5 * (1.0 - 1e-9));
    const double digit = factor / std::pow(10.0, std::floor(std::log10(factor) + 1e-9));
    EXPECT_NEAR(std::min({std::abs(digit - 1.0), std::abs(digit - 2.0), std::abs(digit - 5.0)}),
                0.0, 1e-9);
    EXPECT_DOUBLE_EQ(map["series"][0]["vectors"][0][0], 1e3 * longest_mm);
  }
}

// Three runs at two targets, worked out by hand after ISO 230-2.
TEST(ReportParts, PositioningFromReadings) {
  const host::Positioning p = host::evaluate_positioning(
      'X', false, "before", {0.0, 100.0}, {{0.001, 0.004}, {0.002, 0.004}, {0.003, 0.004}},
      {{0.000, 0.002}, {0.000, 0.003}, {0.000, 0.004}});
  EXPECT_NEAR(p.up.mean[0], 0.002, 1e-15);
  EXPECT_NEAR(p.up.deviation[0], 0.001, 1e-15);
  EXPECT_NEAR(p.down.mean[1], 0.003, 1e-15);
  EXPECT_NEAR(p.down.deviation[1], 0.001, 1e-15);
  EXPECT_NEAR(p.figures.B, 0.002, 1e-12);
  EXPECT_NEAR(p.figures.E, 0.004, 1e-12);   // means from 0 to 4 µm
  EXPECT_NEAR(p.figures.M, 0.0025, 1e-12);  // 1 to 3.5 µm
  EXPECT_NEAR(p.figures.A, 0.005, 1e-12);   // bands from 0 to 5 µm
  EXPECT_NEAR(p.figures.R, 0.004, 1e-12);   // 4 s
}

// FIPS 180-4, examples of NIST.
TEST(ReportParts, Sha256OfKnownTexts) {
  EXPECT_EQ(host::sha256("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(host::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace volcomp::sim
