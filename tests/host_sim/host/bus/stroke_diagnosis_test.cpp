// What a node of a grinder reports of its strokes, in words.

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/strokes/stroke_offsets.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/stroke_diagnosis.hpp"
#include "tests/host_sim/host/bus/service_bench.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::uint8_t> bytes_of(double value) {
  std::vector<std::uint8_t> bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

TEST(StrokeDiagnosis, OfANodeThatWatchesNone) {
  ServiceBench bench;
  const nlohmann::json d = diagnose(bench.client);
  EXPECT_EQ(d.at("strokes").at("on"), false);
  EXPECT_THAT(describe(d), Not(HasSubstr("strokes")));
}

TEST(StrokeDiagnosis, OfANodeThatHasJustBeenToldTo) {
  ServiceBench bench;
  for (std::uint8_t i = 0; i < 3; ++i)
    bench.write({0x2500, static_cast<std::uint8_t>(i + 2)}, {static_cast<std::uint8_t>(i + 1)});
  bench.write({0x2500, 5}, {79, 0});
  bench.write({0x2500, 6}, {181, 0});
  bench.write({0x2501, 1}, bytes_of(1.0 / 305.2));
  bench.write({0x2501, 2}, bytes_of(74.24));
  bench.write({0x2500, 1}, {1});
  const nlohmann::json d = diagnose(bench.client);
  ASSERT_EQ(d.at("strokes").at("on"), true);
  EXPECT_EQ(d.at("strokes").at("samples").at(0), 0);
  EXPECT_THAT(describe(d), HasSubstr("strokes: 0 samples used"));
  EXPECT_THAT(describe(d), HasSubstr("learned tables: none in force"));
  EXPECT_THAT(describe(d), HasSubstr("table slots: no step yet"));
}

node::StrokeObjects grinding() {
  node::StrokeObjects d;
  d.command = 1;
  d.table_state = 2;  // in force
  d.table_feed = 13'400'000;
  for (node::LearnedTable& table : d.learned)
    table.weight = 0.5;
  return d;
}

// Names the feed the tables are for.
TEST(StrokeDiagnosis, NamesTheFeedOfTheTables) {
  node::StrokeObjects d = grinding();
  d.offset_status = kOtherFeed;
  EXPECT_THAT(describe_strokes(stroke_facts(d)), HasSubstr("the tables are for F=13.4 mm/s"));
}

// Names the table whose signal rose.
TEST(StrokeDiagnosis, SaysWhichTableGotWorse) {
  node::StrokeObjects d = grinding();
  d.learned[1].action = 2;  // rolled back
  d.learned[1].flank_rms_um = 4.5;
  d.learned[1].weight = 0.25;
  EXPECT_THAT(describe_strokes(stroke_facts(d)),
              HasSubstr("table backward: got worse (4.50 µm), the best table again, "
                        "weight 0.25"));
  d.learned[0].result = 2;  // no data
  EXPECT_THAT(describe_strokes(stroke_facts(d)),
              HasSubstr("table forward: nothing was seen, unchanged"));
}

// The same: predicted effect of learning from C alone.
TEST(StrokeDiagnosis, SaysWhatOneAxisAloneWouldDo) {
  node::StrokeObjects d = grinding();
  d.learn_reason = static_cast<std::uint8_t>(Reason::breaks_helix);
  d.prediction_um = {-38.9F, 40.2F, 1.3F};
  EXPECT_THAT(describe_strokes(stroke_facts(d)),
              HasSubstr("Z alone -38.9 µm, C alone 40.2 µm, together 1.3 µm"));
  EXPECT_EQ(stroke_facts(d).at("refusal"), "breaks_helix");
}

}  // namespace
}  // namespace volcomp::host
