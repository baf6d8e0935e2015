// Documents as text and as figures.

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

// A list, because compilers differ about a json in braces: its copy, or an array of it.
json document_of(const std::vector<json>& sections) {
  return {{"title", "any"}, {"sections", sections}};
}

json diagonals() {
  json table = table_section(
      "",
      {plain_column("diagonal", "where"), column("before", "µm", 2, "before/um"),
       column("after", "µm", 1, "after/um"), hidden_column("decides"), plain_column("change")},
      {{"PNP", 41.148, 0.372, true, "better"}, {"face diagonals", 8.0, nullptr, false, "?"}});
  table["name"] = "figures";
  return table;
}

TEST(TextOf, ATableHasAlignedColumnsWithUnitsAndDashes) {
  EXPECT_EQ(text_of(document_of({diagonals()})),
            "diagonal        before, µm  after, µm  change\n"
            "PNP                  41.15        0.4  better\n"
            "face diagonals        8.00          -  ?\n");
}

TEST(TextOf, WidthCountsCharactersAndNotBytes) {
  const json table = table_section(
      "", {plain_column("unit"), plain_column("of")},
      json::array({json::array({"µm/µrad", "lengths"}), json::array({"degrees", "angles"})}));
  EXPECT_EQ(text_of(document_of({table})),
            "unit     of\n"
            "µm/µrad  lengths\n"
            "degrees  angles\n");
}

TEST(TextOf, NumbersAreNeverMinusZeroNorInfinite) {
  const json table = table_section("", {column("a", "", 2), column("b", "", 0), plain_column("c")},
                                   {{-0.004, -0.4, std::numeric_limits<double>::infinity()},
                                    {-0.006, -0.6, 7},
                                    {0.125, 1e6, 0.5},
                                    {1, 2, 650.0}});
  EXPECT_EQ(text_of(document_of({table})),
            "    a        b    c\n"
            " 0.00        0    -\n"
            "-0.01       -1    7\n"
            " 0.12  1000000  0.5\n"
            " 1.00        2  650\n");
}

TEST(TextOf, AColumnMayHaveAPrefixAndAWordForWhatIsMissing) {
  json uncertainty = column("U", "µm", 1);
  uncertainty["prefix"] = "± ";
  uncertainty["missing"] = "± ?";
  EXPECT_EQ(text_of(document_of({table_section("", {column("E", "µm", 2), uncertainty},
                                               {{1.0, 0.5}, {20.0, nullptr}})})),
            "E, µm  U, µm\n"
            " 1.00  ± 0.5\n"
            "20.00    ± ?\n");
}

TEST(TextOf, ATitleHasAnEmptyLineBeforeItAndItsTableIndented) {
  json list = list_section("errors now", {{"node:", "none"}, {"drive X:", "lost"}});
  list["note"] = "newest first";
  EXPECT_EQ(text_of(document_of({list, list_section("", {{"a", "b"}}), list})),
            "errors now\n"
            "  node:     none\n"
            "  drive X:  lost\n"
            "newest first\n"
            "a  b\n"
            "\n"
            "errors now\n"
            "  node:     none\n"
            "  drive X:  lost\n"
            "newest first\n");
}

TEST(TextOf, ParagraphsAreLinesAndChartsAreLeftOut) {
  const json chart{{"type", "lines"}, {"title", "curve"}, {"note", "of a chart"}};
  EXPECT_EQ(text_of(document_of({text_section("", {"one", "two"}), chart})), "one\ntwo\n");
}

TEST(TextOf, TheVerdictIsTheLastLine) {
  json document = document_of({text_section("", {"one"})});
  document["verdict"] = {{"ok", true}, {"text", "within 2 µm"}};
  EXPECT_EQ(text_of(document), "one\nPASS within 2 µm\n");
  document["verdict"]["ok"] = false;
  EXPECT_EQ(text_of(document), "one\nFAIL within 2 µm\n");
}

TEST(TextOf, ATableOfNoRowsIsItsHead) {
  EXPECT_EQ(
      text_of(document_of({table_section("", json::array({plain_column("axis")}), json::array())})),
      "axis\n");
  EXPECT_EQ(text_of(document_of({})), "");
}

TEST(FiguresOf, ATableIsAnArrayOfItsNamedColumns) {
  EXPECT_EQ(figures_of(document_of({diagonals(), text_section("", {"not a figure"})})),
            json::parse(R"({"figures": [
              {"where": "PNP", "before": {"um": 41.148}, "after": {"um": 0.372}, "decides": true},
              {"where": "face diagonals", "before": {"um": 8.0}, "after": {"um": null},
               "decides": false}]})"));
}

TEST(FiguresOf, AKeyedTableIsAnObjectByItsFirstColumn) {
  json table = table_section(
      "", {plain_column("axis"), column("X", "mm", 0, "at/0"), column("Y", "mm", 0, "at/1")},
      {{"first", 1, 2}, {"second", 3, 4}});
  table["name"] = "places";
  table["keyed"] = true;
  EXPECT_EQ(figures_of(document_of({table})),
            json::parse(R"({"places": {"first": {"at": [1, 2]}, "second": {"at": [3, 4]}}})"));
}

TEST(FiguresOf, TablesWithoutNamesHaveNone) {
  json table = diagonals();
  table.erase("name");
  EXPECT_EQ(figures_of(document_of({table})), json::object());
}

TEST(FactTable, RowsAreFactsAndCellsTheirMembers) {
  const json facts = figures_of(document_of({diagonals()}))["figures"];
  const json table =
      fact_table("both", facts,
                 {plain_column("diagonal", "where"), column("after", "µm", 2, "after/um"),
                  plain_column("decides", "decides"), plain_column("unknown", "unknown")});
  EXPECT_EQ(table["rows"], json::parse(R"([["PNP", 0.372, true, null],
                                           ["face diagonals", null, false, null]])"));
  EXPECT_EQ(text_of(document_of({table})),
            "both\n"
            "  diagonal        after, µm  decides\n"
            "  PNP                  0.37  yes\n"
            "  face diagonals          -  no\n");
}

}  // namespace
}  // namespace volcomp::host
