// What a node of a grinder reports of its strokes, in words.

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/strokes/stroke_offsets.hpp"
#include "host_sim/host/bus/diagnosis.hpp"
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
  const Diagnosis d = diagnose(bench.client);
  ASSERT_TRUE(d.strokes);
  EXPECT_FALSE(d.strokes->on);
  EXPECT_THAT(describe(d), Not(HasSubstr("strokes")));
  EXPECT_EQ(to_json(d).at("strokes").at("on"), false);
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
  const Diagnosis d = diagnose(bench.client);
  ASSERT_TRUE(d.strokes && d.strokes->on);
  EXPECT_EQ(d.strokes->frames[0], 0U);
  EXPECT_THAT(describe(d), HasSubstr("strokes: 0 samples used"));
  EXPECT_THAT(describe(d), HasSubstr("learned tables: none in force"));
  EXPECT_THAT(describe(d), HasSubstr("table slots: no step yet"));
}

StrokeDiagnosis grinding() {
  StrokeDiagnosis d;
  d.on = true;
  d.tables = node::StrokeTableState::in_force;
  d.table_feed_mm_per_s = 13.4;
  for (LearnedTableDiagnosis& table : d.table)
    table.weight = 0.5;
  return d;
}

// Names the feed the tables are for.
TEST(StrokeDiagnosis, NamesTheFeedOfTheTables) {
  StrokeDiagnosis d = grinding();
  d.offset_status = kOtherFeed;
  EXPECT_THAT(describe(d), HasSubstr("the tables are for F=13.4 mm/s"));
}

// Names the table whose signal rose.
TEST(StrokeDiagnosis, SaysWhichTableGotWorse) {
  StrokeDiagnosis d = grinding();
  d.table[1].action = GuardAction::roll_back;
  d.table[1].flank_rms_um = 4.5;
  d.table[1].weight = 0.25;
  EXPECT_THAT(describe(d), HasSubstr("table backward: got worse (4.50 µm), the best table again, "
                                     "weight 0.25"));
  d.table[0].result = LearningResult::nodata;
  EXPECT_THAT(describe(d), HasSubstr("table forward: nothing was seen, unchanged"));
}

// The same: predicted effect of learning from C alone.
TEST(StrokeDiagnosis, SaysWhatOneAxisAloneWouldDo) {
  StrokeDiagnosis d = grinding();
  d.learning = Reason::breaks_helix;
  d.prediction_um = {-38.9, 40.2, 1.3};
  EXPECT_THAT(describe(d), HasSubstr("Z alone -38.9 µm, C alone 40.2 µm, together 1.3 µm"));
  EXPECT_EQ(to_json(d).at("refusal"), "breaks_helix");
}

}  // namespace
}  // namespace volcomp::host
