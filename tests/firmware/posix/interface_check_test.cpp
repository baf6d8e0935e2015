#include "firmware/posix/interface_check.hpp"

#include <gtest/gtest.h>

namespace volcomp::posix {
namespace {

// As docs/linux-node.md sets it up, for offsets.
hal::CanInterface good() {
  hal::CanInterface found;
  found.known = found.controller = found.echoes = true;
  found.bit_rate = 1'000'000;
  found.queue = 16;
  found.restart_ms = 100;
  return found;
}

// The only remark about it has this in it.
void expect_remark(const hal::CanInterface& found, bool forwards, const char* text) {
  const std::vector<std::string> said = remarks(found, forwards);
  ASSERT_EQ(said.size(), 1U) << text;
  EXPECT_NE(said[0].find(text), std::string::npos) << said[0];
}

TEST(InterfaceCheck, SaysNothingWhereAllIsWell) {
  hal::CanInterface found = good();
  EXPECT_TRUE(remarks(found, false).empty());
  found.echoes = false;
  EXPECT_TRUE(remarks(found, false).empty()) << "a late offset is harmless";
  found = good();
  found.restart_ms = 0;
  EXPECT_TRUE(remarks(found, true).empty());
}

TEST(InterfaceCheck, SaysNothingOfVcan) {
  hal::CanInterface found;
  found.known = true;
  found.queue = 1000;
  EXPECT_TRUE(remarks(found, true).empty());
}

TEST(InterfaceCheck, HasOneSentenceForEachThing) {
  hal::CanInterface found = good();
  found.bit_rate = 500'000;
  expect_remark(found, false, "500000 bit/s");
  found.bit_rate = 0;
  expect_remark(found, false, "not known");
  found = good();
  found.queue = 17;
  expect_remark(found, false, "17 frames");
  found = good();
  found.restart_ms = 0;
  expect_remark(found, false, "restart-ms 100");
  found = good();
  expect_remark(found, true, "restart-ms 0");
  found.reports_bus_errors = true;
  expect_remark(found, false, "berr-reporting off");
  found = good();
  found.restart_ms = 0;
  found.echoes = false;
  expect_remark(found, true, "late target");
  expect_remark({}, false, "cannot be read");
}

}  // namespace
}  // namespace volcomp::posix
