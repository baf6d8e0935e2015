// A chain as one writes it down, and the machine that comes of it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/tick/instances.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "tests/host_sim/host/machine/changed_machine.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

TEST(ChainString, ReadsTheWaysPeopleWriteIt) {
  for (const char* text : {"w-X-Y-b-Z-t", "wXYbZt", "[w X Y b Z t]", "t-Z-b-Y-X-w", "w X' Y' b Z t",
                           "[t Z b Y\u2032 X\u2032 w]", " w - X - Y - b - Z - t "}) {
    ChainLetters letters;
    EXPECT_EQ(parse_chain(text, letters), "") << text;
    EXPECT_EQ(letters.work, "YX") << text;
    EXPECT_EQ(letters.tool, "Z") << text;
  }
}

TEST(ChainString, OneSideMayBeEmpty) {
  ChainLetters letters;
  EXPECT_EQ(parse_chain("w-b-X-Y-Z-C-B-t", letters), "");
  EXPECT_EQ(letters.work, "");
  EXPECT_EQ(letters.tool, "XYZCB");
}

std::string wrong(const std::string& text) {
  ChainLetters letters{"unchanged", ""};
  const std::string said = parse_chain(text, letters);
  EXPECT_EQ(letters.work, "unchanged") << text;
  return said;
}

TEST(ChainString, SaysWhatIsWrong) {
  EXPECT_THAT(wrong("w-X-Q-b-Z-t"), HasSubstr("'Q' is not known"));
  EXPECT_THAT(wrong("w-x-Y-b-Z-t"), HasSubstr("axes are capital letters"));
  EXPECT_THAT(wrong("T-X-Y-b-Z-w"), HasSubstr("w, b and t stand for"));
  EXPECT_THAT(wrong("w-X-Y-b-Z-(C1)-t"), HasSubstr("a spindle in round brackets"));
  EXPECT_THAT(wrong("w-X-Y-b-X-t"), HasSubstr("'X' appears more than once"));
  EXPECT_THAT(wrong("w-X-Y-Z-t"), HasSubstr("'b' is missing"));
  EXPECT_THAT(wrong("X-Y-b-Z-t"), HasSubstr("'w' is missing"));
  EXPECT_THAT(wrong("w-X-Y-b-Z"), HasSubstr("'t' is missing"));
  EXPECT_THAT(wrong("X-w-Y-b-Z-t"), HasSubstr("from w to t"));
  EXPECT_THAT(wrong("b-w-X-t"), HasSubstr("from w to t"));
  EXPECT_THAT(wrong("w-b-t"), HasSubstr("no axis"));
  EXPECT_THAT(wrong("w-X-Y-b-Z'-t"), HasSubstr("on the side of the tool"));
  EXPECT_THAT(wrong("w-X'-Y-b-Z-t"), HasSubstr("Y has no prime"));
  EXPECT_THAT(wrong("'w-b-Z-t"), HasSubstr("a prime follows no axis"));
  EXPECT_THAT(wrong(""), HasSubstr("'w' is missing"));
}

// The trunnion machine, once by its chain and once body by body.
constexpr const char* kHead = R"(
name = "five axes"
id = 5
convention = "relative"
side = "moving"
)";
constexpr const char* kChain = R"(
chain = "w-C-A-Y-b-X-Z-t"
tool = { point_mm = [0.0, 0.0, -150.0] }
)";
constexpr const char* kBodies = R"(
tool = { body = "Z", point_mm = [0.0, 0.0, -150.0] }
work = { body = "C" }
body = [
  { name = "bed" },
  { name = "Y", on = "bed", joint = "linear", axis = "Y", moves_along = "Y", sign = -1, offset_mm = [1.0, 2.0, 3.0] },
  { name = "A", on = "Y", joint = "rotary", axis = "A", turns_about = "X", sign = -1, zero_deg = 20.0 },
  { name = "C", on = "A", joint = "rotary", axis = "C", turns_about = "Z", sign = 1 },
  { name = "X", on = "bed", joint = "linear", axis = "X", moves_along = "X", sign = 1, offset_mm = [0.0, 0.0, 650.0] },
  { name = "Z", on = "X", joint = "linear", axis = "Z", moves_along = "Z", sign = 1 },
]
)";

// `in_chain`: how an [[axis]] describes its joint.
std::string axes(bool in_chain) {
  std::string text = "correction = { axes = [\"X\", \"Y\", \"Z\"] }\n";
  const auto axis = [&](const std::string& name, bool rotary, const std::string& joint) {
    text += "[[axis]]\nname = \"" + name + "\"\n" +
            (rotary ? "travel_rad = [-1.0, 0.5]\nreference_rad = 0.0\n"
                    : "travel_mm = [-100.0, 100.0]\nreference_mm = 0.0\n") +
            "sensed_point_mm = [0.0, 0.0, 0.0]\nkappa = 0\n" + (in_chain ? joint : "");
  };
  axis("X", false, "offset_mm = [0.0, 0.0, 650.0]\n");
  axis("Y", false, "offset_mm = [1.0, 2.0, 3.0]\n");
  axis("Z", false, "");
  axis("A", true, "sign = -1\nzero_deg = 20.0\n");
  axis("C", true, "sign = 1\n");
  return text;
}

std::string by_chain() { return std::string(kHead) + kChain + axes(true); }
std::string by_bodies() { return std::string(kHead) + kBodies + axes(false); }

TEST(ChainString, IsTheSameMachineAsItsBodies) {
  const MachineFile chain = parse_machine(by_chain(), "chain.toml");
  const MachineFile bodies = parse_machine(by_bodies(), "bodies.toml");
  const MachineDescription& a = chain.chain.description();
  const MachineDescription& b = bodies.chain.description();
  ASSERT_EQ(a.body_count, b.body_count);
  for (std::size_t k = 0; k < a.body_count; ++k)
    EXPECT_EQ(a.body.at(k).lower, b.body.at(k).lower) << k;
  EXPECT_TRUE(same_chain(make_runtime_chain(a), make_runtime_chain(b)));
  EXPECT_EQ(a.tool_point, b.tool_point);
  const Pose q{12.0, -30.0, 45.0, -0.3, 0.2};
  for (const auto branch : {&MachineChain::tool, &MachineChain::work}) {
    const Frame one = chain.chain.ideal((chain.chain.*branch)(), q);
    const Frame other = bodies.chain.ideal((bodies.chain.*branch)(), q);
    EXPECT_EQ(one.t, other.t);
    EXPECT_EQ(one.R, other.R);
  }
}

TEST(ChainString, IsWrittenBackAsItIsRead) {
  EXPECT_EQ(chain_text(parse_machine(by_chain(), "chain.toml").chain), "w-C-A-Y-b-X-Z-t");
  EXPECT_EQ(chain_text(read_machine_file(bundled_machine("xyfz")).chain), "w-X-Y-b-Z-t");
  EXPECT_EQ(chain_text(read_machine_file(bundled_machine("l300g")).chain), "w-A-b-X-Y-B-t");
  EXPECT_EQ(chain_text(read_machine_file(bundled_machine("trunnion")).chain), "w-C-A-Y-b-X-Z-t");
}

// An NC coordinate counts the tool against the work: +Y of a table moves the table to -Y.
TEST(ChainString, AnAxisUnderTheWorkpieceCountsTheTool) {
  const MachineFile file = parse_machine(by_chain(), "chain.toml");
  const auto tool_at = [&](const Pose& q) -> Vec3 {
    return file.chain.ideal(file.chain.work(), q)
        .apply_inverse(file.chain.ideal(file.chain.tool(), q).apply(file.chain.tool_point()));
  };
  const Pose level{0.0, 0.0, 0.0, 20.0 * kPi / 180.0, 0.0};
  Pose further = level;
  further[1] = 10.0;
  further[0] = 5.0;
  EXPECT_LT((tool_at(further) - tool_at(level) - Vec3(5.0, 10.0, 0.0)).norm(), 1e-12);
}

TEST(ChainString, RefusalsNameLineAndAxis) {
  const std::string text = by_chain();
  EXPECT_THAT(refusal_of(text, "w-C-A-Y-b-X-Z-t", "w-C-A-Y-b-X-Q-t"),
              HasSubstr("m.toml:7: 'chain' is \"w-C-A-Y-b-X-Q-t\": 'Q' is not known"));
  EXPECT_THAT(refusal_of(text, "w-C-A-Y-b-X-Z-t", "w-C-A-Y-b-X-B-Z-t"),
              HasSubstr("axis B of 'chain' has no [[axis]] table"));
  EXPECT_THAT(refusal_of(text, "w-C-A-Y-b-X-Z-t", "w-C-A-Y-b-X-t"),
              HasSubstr("axis Z has no place in it"));
  EXPECT_THAT(refusal_of(text, "sign = -1\nzero_deg", "zero_deg"),
              HasSubstr("'sign' of axis A, which turns the workpiece"));
  EXPECT_THAT(refusal_of(text, "\"Z\"\ntravel_mm = [-100.0, 100.0]\nreference_mm",
                         "\"Z\"\ntravel_rad = [-1.0, 1.0]\nreference_rad"),
              HasSubstr("in a chain Z is linear: its [[axis]] needs 'travel_mm'"));
  EXPECT_THAT(refusal_of(text, "point_mm", "body = \"Z\", point_mm"),
              HasSubstr("unknown field 'body'"));
  EXPECT_THAT(refusal_of(text, "name = \"C\"", "name = \"A\""), HasSubstr("there are two axes A"));
  EXPECT_THAT(refusal_of(text, "chain = \"w", "work = { body = \"C\" }\nchain = \"w"),
              HasSubstr("'chain' and [work] cannot be used together"));
  EXPECT_THAT(refusal_of(text, "chain = \"w-C-A-Y-b-X-Z-t\"", ""),
              HasSubstr("missing mandatory field 'chain' (or a list [[body]])"));
  EXPECT_THAT(refusal_of(by_bodies(), "kappa = 0", "kappa = 0\nsign = 1"),
              HasSubstr("unknown field 'sign'"));
}

}  // namespace
}  // namespace volcomp::host
