// docs/reason-codes.md explains every code once, under the name and number it is reported with.

#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/bus/explain/catalogue.hpp"

namespace volcomp::host::test {
namespace {

std::string heading(const CodeEntry& e) {
  const std::string what = fmt::format("## {}: {} {}", title(e.kind), e.label, e.what);
  return e.name.empty() ? what : fmt::format("{} ({})", what, e.name);
}

// The headings of the page as heading() writes them; each once.
std::set<std::string> headings_of_page() {
  const std::regex named(R"(\*\*`(.*)`\*\* \((.*?)\) (.*))");
  const std::regex numbered(R"(\*\*(.*)\*\* (.*))");
  std::set<std::string> found;
  std::string section;
  std::istringstream page{std::string(reason_page())};
  for (std::string line; std::getline(page, line);) {
    std::smatch part;
    if (line.rfind("## ", 0) == 0) section = line;
    std::string entry;
    if (std::regex_match(line, part, named)) {
      entry = fmt::format("{}: {} {} ({})", section, part.str(2), part.str(3), part.str(1));
    } else if (std::regex_match(line, part, numbered)) {
      entry = fmt::format("{}: {} {}", section, part.str(1), part.str(2));
    } else {
      continue;
    }
    EXPECT_TRUE(found.insert(entry).second) << "twice: " << line;
  }
  return found;
}

TEST(ReasonPage, HasAHeadingForEveryCodeAndNoOther) {
  std::set<std::string> codes;
  for (const CodeEntry& e : code_catalogue())
    codes.insert(heading(e));
  EXPECT_EQ(codes.size(), 193U) << "105 reasons, 15 bits, 31 emergencies, 15 verdicts, 27 aborts";
  EXPECT_EQ(headings_of_page(), codes);
}

TEST(ReasonPage, ExplainsEveryCodeButThoseOfAborts) {
  for (const CodeEntry& e : code_catalogue()) {
    EXPECT_EQ(e.why.empty(), e.kind == CodeKind::abort) << heading(e);
    EXPECT_EQ(e.remedy.empty(), e.kind == CodeKind::abort) << heading(e);
  }
}

// The lines of one paragraph, not of a neighbour.
TEST(ReasonPage, IsReadByParagraph) {
  const Meaning meaning = meaning_of("no_authority");
  ASSERT_EQ(meaning.codes.size(), 2U);
  EXPECT_THAT(meaning.codes[0].why, testing::StartsWith("Two correcting axes point"));
  EXPECT_THAT(meaning.codes[0].remedy, testing::EndsWith("the last correction is held."));
  EXPECT_EQ(meaning.codes[1].why, "In this pose the correcting axes cannot produce the motion.");
  EXPECT_EQ(meaning.codes[1].remedy, "See the reason no_authority.");
}

}  // namespace
}  // namespace volcomp::host::test
