// What a cycle takes of the bus by the ways of its axes, and what it leaves the node. The figures
// are worked out by hand from frame lengths with the most stuff bits (ISO 11898-1): SYNC 65, 4
// bytes 95, 6 bytes 115, 7 bytes 125, 8 bytes 135 bits, at 1 Mbit/s µs.

#include "host_sim/host/bus/bus_cycle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/latency_diagnosis.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "tests/host_sim/host/bus/service_bench.hpp"

namespace volcomp::host {
namespace {

using node::Way;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

CycleAxes axes_of(std::size_t count, Way way, bool confirmed = true) {
  return CycleAxes(count, CycleAxis{way, confirmed});
}

// --- load

struct CycleRow {
  const char* name;
  CycleAxes axes;
  bool with_status;
  std::uint32_t worst_us;
  double largest_hz;
};
void PrintTo(const CycleRow& row, std::ostream* os) { *os << row.name; }

class CycleLoad : public testing::TestWithParam<CycleRow> {};

TEST_P(CycleLoad, IsTheSumOfItsFrames) {
  const CycleRow& row = GetParam();
  EXPECT_EQ(bits_of_cycle(row.axes, row.with_status).worst, row.worst_us);
  EXPECT_NEAR(largest_rate_hz(row.axes, row.with_status), row.largest_hz, 0.5);
}

CycleAxes three_forwarded_two_offsets() {
  CycleAxes axes = axes_of(3, Way::forwarded_target);
  axes.resize(5);
  return axes;
}

INSTANTIATE_TEST_SUITE_P(
    Ways, CycleLoad,
    testing::Values(
        CycleRow{"confirmed 3", axes_of(3, Way::offset), false, 1385, 505},
        CycleRow{"confirmed 5", axes_of(5, Way::offset), false, 2265, 309},
        CycleRow{"unconfirmed 3", axes_of(3, Way::offset, false), false, 1100, 636},
        CycleRow{"unconfirmed 5", axes_of(5, Way::offset, false), false, 1790, 391},
        CycleRow{"forwarded 3", axes_of(3, Way::forwarded_target), false, 1070, 654},
        CycleRow{"forwarded 3 and status", axes_of(3, Way::forwarded_target), true, 1205, 581},
        CycleRow{"forwarded 5", axes_of(5, Way::forwarded_target), false, 1740, 402},
        CycleRow{"forwarded 5 and status", axes_of(5, Way::forwarded_target), true, 1875, 373},
        CycleRow{"controller 3", axes_of(3, Way::controller_adds), false, 1085, 645},
        CycleRow{"controller 3 and status", axes_of(3, Way::controller_adds), true, 1220, 574},
        CycleRow{"controller 5", axes_of(5, Way::controller_adds), false, 1720, 407},
        CycleRow{"controller 5 and status", axes_of(5, Way::controller_adds), true, 1855, 377},
        CycleRow{"mixed", three_forwarded_two_offsets(), false, 1950, 359},
        CycleRow{"mixed and status", three_forwarded_two_offsets(), true, 2085, 336}));

TEST(CycleLoad, OnlyWaysThatRestOnTheNodeNeedItsStatus) {
  EXPECT_FALSE(needs_status(axes_of(3, Way::offset)));
  EXPECT_FALSE(needs_status(axes_of(3, Way::none)));
  EXPECT_TRUE(needs_status(axes_of(3, Way::controller_adds)));
  EXPECT_TRUE(needs_status(three_forwarded_two_offsets()));
}

// --- latency

struct BudgetRow {
  const char* name;
  std::size_t axes;
  std::uint32_t period_us;
  std::int64_t last_target_us;
  std::int64_t usual_us;
  std::int64_t with_edge_us;
  std::int64_t after_deadline_us;
};
void PrintTo(const BudgetRow& row, std::ostream* os) { *os << row.name; }

class Budget : public testing::TestWithParam<BudgetRow> {};

TEST_P(Budget, IsWhatTheFramesLeave) {
  const BudgetRow& row = GetParam();
  const LatencyBudget budget =
      latency_budget(axes_of(row.axes, Way::forwarded_target), {row.period_us, 0, 0});
  EXPECT_EQ(budget.last_target, row.last_target_us);
  EXPECT_EQ(budget.usual, row.usual_us);
  EXPECT_EQ(budget.with_edge, row.with_edge_us);
  EXPECT_EQ(budget.after_deadline, row.after_deadline_us);
}

// 300 Hz is a period of 3333 µs (1006h), and 60 % of it 1999 µs.
INSTANTIATE_TEST_SUITE_P(
    Rates, Budget,
    testing::Values(BudgetRow{"3 axes, 500 Hz", 3, 2000, 785, 525, 120, 110},
                    BudgetRow{"3 axes, 400 Hz", 3, 2500, 785, 1025, 620, 310},
                    BudgetRow{"3 axes, 333 Hz", 3, 3000, 785, 1525, 1120, 510},
                    BudgetRow{"5 axes, 250 Hz", 5, 4000, 1265, 1855, 1180, 720},
                    BudgetRow{"5 axes, 300 Hz", 5, 3333, 1265, 1188, 513, 454}));

// 3 axes at 500 Hz with a node that takes 250 µs leave 1055 to 1060 µs for the deadline.
TEST(Budget, DeadlineLiesBetweenLastTargetAndLastFrames) {
  const LatencyBudget budget = latency_budget(axes_of(3, Way::forwarded_target), {2000, 1058, 0});
  EXPECT_EQ(budget.deadline_from, 1055);
  EXPECT_EQ(budget.deadline_until(250), 1060);
  EXPECT_EQ(budget.deadline, 1058);
}

TEST(Budget, TargetsThatComeLateLeaveLess) {
  const CycleAxes axes = axes_of(3, Way::forwarded_target);
  EXPECT_EQ(latency_budget(axes, {2000, 0, 885}).usual, 425);
  EXPECT_EQ(latency_budget(axes, {2000, 0, 300}).usual, 525) << "a bus may be fuller than measured";
}

// --- verdict

std::vector<std::string> problems(Way way, const CycleTimes& times, std::uint32_t largest_us,
                                  bool probing = false) {
  const CycleAxes axes = axes_of(3, way);
  return latency_problems(axes, latency_budget(axes, times), {1000, largest_us}, probing);
}

TEST(LatencyVerdict, FitsUpToTheLast) {
  EXPECT_THAT(problems(Way::forwarded_target, {2000, 1058, 785}, 250), IsEmpty());
  EXPECT_THAT(problems(Way::offset, {2000, 0, 785}, 495), IsEmpty());
  EXPECT_THAT(problems(Way::offset, {2000, 0, 785}, 496),
              ElementsAre(HasSubstr("1 us too long when every target has come")));
}

TEST(LatencyVerdict, EdgesCountWhereThereIsAProbe) {
  EXPECT_THAT(problems(Way::forwarded_target, {2000, 1058, 785}, 250, true),
              ElementsAre(HasSubstr("130 us too long while the drives report an edge")));
}

// The default of 60 % leaves 110 µs.
TEST(LatencyVerdict, DeadlineCountsForForwardedTargets) {
  EXPECT_THAT(problems(Way::forwarded_target, {2000, 0, 785}, 250),
              ElementsAre(HasSubstr("140 us too long after a deadline"),
                          AllOf(HasSubstr("1200 us after SYNC"), HasSubstr("1055 and 1060 us"))));
  EXPECT_THAT(problems(Way::forwarded_target, {2000, 0, 785}, 300),
              ElementsAre(HasSubstr("190 us too long"), HasSubstr("no deadline")));
}

// The deadline must not come while targets still do.
TEST(LatencyVerdict, EarlyDeadlineIsTold) {
  EXPECT_THAT(problems(Way::forwarded_target, {3000, 1000, 785}, 200),
              ElementsAre(HasSubstr("1000 us after SYNC and must lie between 1055 and 2110 us")));
}

// --- of a node

TEST(LatencyDiagnosis, HasNothingToCompareBeforeTheFirstCycle) {
  ServiceBench bench;
  const nlohmann::json none = diagnose(bench.client).at("latency");
  EXPECT_TRUE(none.at("fits").is_null());
  bench.write({0x1019, 0}, {0});
  bench.write({0x1006, 0}, {0xB8, 0x0B, 0, 0});  // 3000 µs
  for (std::uint8_t axis = 1; axis <= 3; ++axis)
    bench.write({0x2010, axis}, {axis});
  for (std::uint8_t axis = 1; axis <= 3; ++axis)
    bench.write({0x2034, axis}, {1});
  const nlohmann::json d = diagnose(bench.client);
  EXPECT_TRUE(d.at("latency").at("fits").is_null());
  EXPECT_EQ(d.at("latency").at("allowed").at("usual_us"), 1525);
  EXPECT_EQ(d.at("latency").at("allowed").at("after_deadline_us"), 510);
  EXPECT_THAT(describe(d), HasSubstr("not measured yet; at most 1525 us"));
}

// Frames of this bench are 1 ms apart.
void bus_cycle(ServiceBench& bench) {
  bench.send({0x080, 0, {}});
  for (std::uint16_t axis = 1; axis <= 3; ++axis) {
    bench.send({static_cast<std::uint16_t>(0x180 + axis), 8, {0, 0, 0, 0, 0x37, 0x01}});
    bench.send({static_cast<std::uint16_t>(0x480 + axis), 4, {}});
    bench.send({static_cast<std::uint16_t>(0x200 + axis), 6, {0x0F}});
  }
  bench.pass_us(10'000);
}

// The node answers at once.
TEST(LatencyDiagnosis, ANodeThatAnswersAtOnceFits) {
  ServiceBench bench;
  bench.write({0x1019, 0}, {0});
  bench.write({0x1006, 0}, {0x20, 0x4E, 0, 0});  // 20 000 µs
  for (std::uint8_t axis = 1; axis <= 3; ++axis)
    bench.write({0x2010, axis}, {axis});
  send_image(bench.client, known_machine().image);
  activate_tables(bench.client);
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  for (int i = 0; i < 30; ++i)
    bus_cycle(bench);
  const nlohmann::json d = diagnose(bench.client);
  EXPECT_GT(d.at("latency").at("latency_cycles"), 0);
  EXPECT_EQ(d.at("latency").at("fits"), true);
  EXPECT_TRUE(d.at("forwarding").is_null());
  EXPECT_THAT(describe(d), HasSubstr("fits, at most"));
}

TEST(ForwardingDiagnosis, NamesTheAxisThatIsNotServed) {
  ServiceBench bench;
  bench.write({0x1029, 1}, {1});
  bench.write({0x2010, 1}, {1});
  bench.write({0x2010, 2}, {2});
  bench.write({0x2034, 2}, {1});
  bench.send({0x000, 2, {1, ServiceBench::kNodeId}});
  for (int i = 0; i < 3; ++i)
    bus_cycle(bench);
  const nlohmann::json d = diagnose(bench.client);
  EXPECT_EQ(d.at("forwarding").at("incomplete"), true);
  EXPECT_EQ(d.at("forwarding").at("axes"), nlohmann::json::array({"2"}));
  EXPECT_EQ(d.at("forwarding").at("not_served"), nlohmann::json::array({"2"}));
  EXPECT_TRUE(d.at("axes").at(0).at("not_served").is_null());
  EXPECT_THAT(describe(d), AllOf(HasSubstr("NOT SERVED (bit 15 of 2600h:03): axis 2"),
                                 HasSubstr("has not been read back")));
}

}  // namespace
}  // namespace volcomp::host
