// Every writer has a reader: what was written, read and evaluated is what was meant, within the
// resolution of the format; and what cannot be meant is refused before a file is written.

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "comp/machine/xyfz.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/volumetric_files.hpp"
#include "tests/oracle/controller_tables.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

using host::write_cec;
using host::write_enc_comp;
using host::write_linuxcnc;
using host::write_ssfk;

constexpr double kRounding_mm = 0.5001e-6;
constexpr double kRounding_rad = 0.5001e-6 * kDegree;

std::vector<double> random_offsets(Random& random, std::size_t n, double most) {
  std::vector<double> t;
  for (std::size_t k = 0; k < n; ++k)
    t.push_back(random.uniform(-most, most));
  return t;
}

host::LinuxcncComp read_linuxcnc(const std::string& text, int type = 1) {
  std::istringstream stream(text);
  return host::read_linuxcnc(stream, "x.comp", type);
}

// What a reader reports about a file.
template <class Read>
std::string complaint(const Read& read) {
  try {
    read();
  } catch (const host::UserError& e) {
    return e.what();
  }
  return "";
}

TEST(EncComp, GivesBackWhatWasWritten) {
  Random random;
  for (const bool rotary : {false, true}) {
    const double most = rotary ? 1e-3 : 0.1;
    const host::EncCompTable table{"Z1",  random_offsets(random, 33, most), -12.5, 0.25, false,
                                   rotary};
    std::string text;
    ASSERT_TRUE(write_enc_comp(table, text).ok());
    const host::EncCompTable back = read_enc_comp(text, rotary);
    EXPECT_EQ(back.axis, "Z1");
    for (int i = 0; i < 100; ++i) {
      const double z = random.uniform(-15.0, -2.0);
      EXPECT_NEAR(offset_at(back, z), offset_at(table, z), rotary ? kRounding_rad : kRounding_mm);
    }
  }
}

// The control adds the entry to the actual value: the axis moves the other way.
TEST(EncComp, EntryIsMinusTheOffset) {
  std::string text;
  ASSERT_TRUE(write_enc_comp({"Z1", {0.010, 0.0}, 0.0, 1.0, false, false}, text).ok());
  EXPECT_NE(text.find("$AA_ENC_COMP[0,0,Z1]=-0.010000\n"), std::string::npos);
}

TEST(EncComp, ModuloTableMustClose) {
  host::EncCompTable table{"C1", {1e-4, 2e-4, 3e-4, 1e-4}, 0.0, 120.0, true, true};
  std::string text = "before";
  ASSERT_TRUE(write_enc_comp(table, text).ok());
  const host::EncCompTable back = read_enc_comp(text, true);
  EXPECT_TRUE(back.modulo);
  EXPECT_NEAR(offset_at(back, 60.0 + 720.0), 1.5e-4, kRounding_rad);
  EXPECT_NEAR(offset_at(back, -60.0), 2e-4, kRounding_rad);
  table.offset.back() = 1.2e-4;
  text = "before";
  EXPECT_EQ(write_enc_comp(table, text).reason, Reason::not_periodic);
  EXPECT_EQ(text, "before");
}

TEST(Cec, GivesBackWhatWasWrittenInItsDirection) {
  Random random;
  for (const int sign : {1, -1}) {
    const host::CecTable up{3,     "Z1", "C1", random_offsets(random, 65, 1e-4), -8.0, 0.25, 1,
                            false, true, sign};
    std::string text;
    ASSERT_TRUE(write_cec(up, text).ok());
    const host::CecTable back = read_cec(text, true, sign);
    EXPECT_EQ(back.number, 3);
    EXPECT_EQ(back.input, "Z1");
    EXPECT_EQ(back.output, "C1");
    EXPECT_EQ(back.direction, 1);
    for (int i = 0; i < 100; ++i) {
      const double z = random.uniform(-10.0, 10.0);
      EXPECT_NEAR(offset_at(back, z, 1), offset_at(up, z, 1), kRounding_rad);
      EXPECT_EQ(offset_at(back, z, -1), 0.0) << "the other table is for the way back";
    }
  }
}

TEST(Linuxcnc, BothTypesMeanTheSame) {
  Random random;
  std::vector<double> nominal(40);
  for (std::size_t k = 0; k < nominal.size(); ++k)
    nominal[k] = static_cast<double>(k) - 20.0 + random.uniform(0.0, 0.4);
  const std::vector<double> up = random_offsets(random, 40, 0.05);
  const std::vector<double> down = random_offsets(random, 40, 0.05);
  for (const int type : {0, 1}) {
    const host::LinuxcncComp table{type, nominal, up, down};
    std::string text;
    ASSERT_TRUE(write_linuxcnc(table, text).ok());
    const host::LinuxcncComp back = read_linuxcnc(text, type);
    for (std::size_t k = 0; k < nominal.size(); ++k) {
      EXPECT_NEAR(offset_at(back, back.nominal[k], 1), up[k], 2.0 * kRounding_mm);
      EXPECT_NEAR(offset_at(back, back.nominal[k], -1), down[k], 2.0 * kRounding_mm);
    }
    EXPECT_NEAR(offset_at(back, 1000.0, 1), up.back(), 2.0 * kRounding_mm);
  }
}

TEST(Ssfk, GivesBackWhatWasWrittenToATenthOfAMicrometre) {
  Random random;
  for (const bool rotary : {false, true}) {
    const host::SsfkTable table{2,
                                "Z",
                                {-10.0, -5.0, 0.0, 5.0},
                                random_offsets(random, 4, 1e-3),
                                random_offsets(random, 4, 1e-3),
                                rotary};
    std::string text;
    ASSERT_TRUE(write_ssfk(table, text).ok());
    const host::SsfkTable back = read_ssfk(text, rotary);
    const double half = rotary ? 0.5001e-4 * kDegree : 0.5001e-4;
    for (int k = 0; k < 30; ++k) {
      const double z = -12.0 + 0.7 * k;
      EXPECT_NEAR(offset_at(back, z, 1), offset_at(table, z, 1), half);
      EXPECT_NEAR(offset_at(back, z, -1), offset_at(table, z, -1), half);
    }
    EXPECT_EQ(back.axis_number, 2);
  }
}

TEST(ControllerTableRefusal, BeforeAnythingIsWritten) {
  std::string text = "before";
  const auto linuxcnc = [&text](const host::LinuxcncComp& table) {
    return write_linuxcnc(table, text).reason;
  };
  EXPECT_EQ(linuxcnc({1, {0, 1}, {0, 0}, {0}}), Reason::length_mismatch);
  EXPECT_EQ(linuxcnc({1, {0, 1, 2}, {0, 0}, {0, 0}}), Reason::length_mismatch);
  EXPECT_EQ(linuxcnc({1, {0, 0}, {0, 0}, {0, 0}}), Reason::positions_duplicate);
  EXPECT_EQ(linuxcnc({1, {0, -1}, {0, 0}, {0, 0}}), Reason::positions_not_monotone);
  EXPECT_EQ(linuxcnc({1, {0, 1}, {0, std::nan("")}, {0, 0}}), Reason::not_finite);
  EXPECT_EQ(linuxcnc({2, {0, 1}, {0, 0}, {0, 0}}), Reason::bad_setting);
  const std::vector<double> many(257, 0.0);
  EXPECT_EQ(linuxcnc({1, many, many, many}), Reason::too_many_knots);
  EXPECT_EQ(write_enc_comp({"Z1", {0.0}, 0, 1, false, false}, text).reason, Reason::too_few_knots);
  EXPECT_EQ(write_enc_comp({"Z1", {0, 0}, 0, 0, false, false}, text).reason, Reason::bad_setting);
  EXPECT_EQ(write_enc_comp({"", {0, 0}, 0, 1, false, false}, text).reason, Reason::bad_setting);
  host::CecTable cec{0, "Z1", "C1", {0, 0}, 0, 1, 2, false, true, 1};
  EXPECT_STREQ(write_cec(cec, text).where.field, "direction");
  cec.direction = 0;
  cec.sign = 0;
  EXPECT_STREQ(write_cec(cec, text).where.field, "sign");
  EXPECT_EQ(write_ssfk({1, "", {0, 1}, {0, 0}, {0, 0}, false}, text).reason, Reason::bad_setting);
  EXPECT_EQ(text, "before");
}

// Nothing overflows, and no two positions become one.
TEST(ControllerTableRefusal, OfNumbersThatTheFormatDoesNotHold) {
  std::string text = "before";
  const auto refused = [](const Status& s, Reason reason, const char* field) {
    EXPECT_EQ(s.reason, reason);
    EXPECT_EQ(s.where.index, 1);
    EXPECT_STREQ(s.where.field, field);
  };
  const std::vector<double> none{0, 0};
  for (const double huge : {3e32, -3e32}) {
    refused(write_linuxcnc({1, {0, 1}, {0, huge}, none}, text), Reason::bad_setting, "offset");
    refused(write_ssfk({1, "X", {0, 1}, none, {0, huge}, false}, text), Reason::bad_setting,
            "offset");
    refused(write_enc_comp({"Z1", {0, huge}, 0, 1, false, false}, text), Reason::bad_setting,
            "offset");
    refused(write_cec({0, "Z1", "C1", {0, huge}, 0, 1, 0, false, true, 1}, text),
            Reason::bad_setting, "offset");
    EXPECT_STREQ(write_enc_comp({"Z1", none, huge, 1, false, false}, text).where.field, "min");
    EXPECT_STREQ(write_cec({0, "Z1", "C1", none, huge, 1, 0, false, true, 1}, text).where.field,
                 "min");
  }
  refused(write_linuxcnc({1, {0, 3e32}, none, none}, text), Reason::bad_setting, "position");
  // 2^31 - 1 times 0.1 µm.
  refused(write_ssfk({1, "X", {0, 214748.4}, none, none, false}, text), Reason::bad_setting,
          "position");
  refused(write_ssfk({1, "X", {0, 1}, {0, 214748.4}, none, false}, text), Reason::bad_setting,
          "offset");
  refused(write_linuxcnc({1, {0, 1e-7}, none, none}, text), Reason::positions_duplicate, nullptr);
  refused(write_ssfk({1, "X", {0, 1e-5}, none, none, false}, text), Reason::positions_duplicate,
          nullptr);
  EXPECT_EQ(text, "before");
  EXPECT_TRUE(write_ssfk({1, "X", {0, 214748.3}, {0, -214748.3}, none, false}, text).ok());
  EXPECT_NE(text.find("kw.ssfk.table[1].pos 2147483000\n"), std::string::npos);
}

TEST(ControllerTableFile, ComplaintsNameTheLine) {
  std::string text;
  ASSERT_TRUE(write_enc_comp({"Z1", {0.01, 0.02, 0.03}, 0, 1, false, false}, text).ok());
  const auto changed = [&text](const std::string& from, const std::string& to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    return complaint([&other] { (void)read_enc_comp(other, false); });
  };
  EXPECT_EQ(changed("-0.020000", "-0,02"), "line 4: '-0,02' is not a number");
  EXPECT_EQ(changed("[0,1,Z1]", "[0,0,Z1]"), "line 4: an entry is there twice");
  EXPECT_EQ(changed("[0,1,Z1]", "[0,5,Z1]"), "$AA_ENC_COMP: entry 1 is missing");
  EXPECT_EQ(changed("[0,1,Z1]", "[0,1,Z2]"), "line 4: another axis than before");
  EXPECT_EQ(changed("_STEP", "_STOP"), "line 6: unknown variable AA_ENC_COMP_STOP");
  EXPECT_EQ(changed("M17", "M30"), "line 10: expected $NAME[index]=value");
  EXPECT_EQ(changed("CHANDATA(1)", "CHANDATA(2)"), "line 2: expected CHANDATA(1)");
  EXPECT_NE(changed("MAX[0,Z1]=2", "MAX[0,Z1]=3"), "");
  const auto linuxcnc = [](const std::string& file, int type = 1) {
    return complaint([&] { (void)read_linuxcnc(file, type); });
  };
  EXPECT_EQ(linuxcnc("0 0 0\n1 2\n"), "x.comp:2: expected: nominal forward reverse");
  EXPECT_EQ(linuxcnc("0 0 0\n0 0 0\n"), "x.comp:2: nominal positions must ascend");
  EXPECT_EQ(linuxcnc("0 0 0\n\n1 0 0\n"), "x.comp:3: LinuxCNC reads nothing after an empty line");
  EXPECT_EQ(linuxcnc("0 \xFF\x01 0\n"), "x.comp:1: \"?\?\" is not a number");
  EXPECT_EQ(linuxcnc("0 +-1 0\n"), "x.comp:1: \"+-1\" is not a number");
  EXPECT_EQ(linuxcnc("0 0 nan\n"), "x.comp:1: a number must be finite");
  EXPECT_EQ(linuxcnc("1.7e308 -1.7e308 0\n", 0), "x.comp:1: a number must be finite");
  EXPECT_EQ(linuxcnc("0 0 0\n"), "x.comp: 1 entries; 2 to 256 are allowed");
  EXPECT_EQ(linuxcnc(std::string("\xFF\xFE") + "0"),
            "x.comp:1: the file is UTF-16; it must be saved as UTF-8 or ASCII");
  EXPECT_EQ(complaint([] { (void)read_ssfk("kopf.log_achs_nr 1\nkopf.log_achs_nr 1\n", false); }),
            "line 2: kopf.log_achs_nr is there twice");
  EXPECT_EQ(complaint([] { (void)read_ssfk("a b c\n", false); }), "line 1: expected: key value");
}

// Files that come from a control end their lines as Windows does.
TEST(ControllerTableFile, CarriageReturnsDoNotMatter) {
  std::string text;
  ASSERT_TRUE(write_enc_comp({"Z1", {0.01, 0.02, 0.03}, 0, 1, false, false}, text).ok());
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2))
    text.insert(at, 1, '\r');
  EXPECT_DOUBLE_EQ(read_enc_comp(text, false).offset.at(1), 0.02);
  EXPECT_EQ(read_linuxcnc("0 0 0\r\n1 2 3\r\n").reverse.at(1), 3.0);
}

// What sscanf("%lf") takes, and what an editor puts in front of a file.
TEST(ControllerTableFile, SignsAndMarksOfEditorsAreRead) {
  const host::LinuxcncComp table = read_linuxcnc("\xEF\xBB\xBF-1 +0.5 -.5\n+2 +1e-3 1.\n");
  EXPECT_EQ(table.nominal, (std::vector<double>{-1.0, 2.0}));
  EXPECT_EQ(table.forward, (std::vector<double>{0.5, 1e-3}));
  EXPECT_EQ(table.reverse, (std::vector<double>{-0.5, 1.0}));
}

// Nine tables of the XYFZ machine: what they miss is what they report.
TEST(VolumetricFiles, AreTheModelUpToTheirRemainder) {
  Random random;
  VolumetricModel model;
  model.chain = chain_of(xyfz_optimised({{-200, -150, 180}, {20, 520, 1130}, {30, -380, -300}}));
  model.directions = xyfz_directions({127e-6, 222e-6, 17e-6});
  model.tool_point = Vec3(30, -380, -300);
  std::array<ErrorTable, 3> tables;
  std::array<KnotGrid, 3> grid;
  for (std::size_t a = 0; a < 3; ++a) {
    tables[a].q0 = -100.0;
    tables[a].pitch = 50.0;
    tables[a].knots = 5;
    for (std::size_t k = 0; k < 5; ++k)
      tables[a].forward[k] = tables[a].backward[k] = random.error(0.01, 3e-5);
    model.table[a] = &tables[a];
    grid[a] = {-100.0, 50.0, 5};
  }
  host::VolumetricFiles files;
  ASSERT_TRUE(volumetric_files(model, grid, files).ok());

  // Through the files and back.
  std::array<host::EncCompTable, 3> own;
  std::array<host::CecTable, 6> cross;
  for (std::size_t a = 0; a < own.size(); ++a) {
    std::string text;
    ASSERT_TRUE(write_enc_comp(files.own[a], text).ok());
    own[a] = read_enc_comp(text, false);
  }
  for (std::size_t i = 0; i < cross.size(); ++i) {
    std::string text;
    ASSERT_TRUE(write_cec(files.cross[i], text).ok());
    cross[i] = read_cec(text, false, 1);
  }

  Vec3 worst = Vec3::Zero();
  double squares = 0.0;
  for (int n = 0; n < 125; ++n) {
    const std::array<int, 3> knot{n % 5, n / 5 % 5, n / 25};
    Pose q{};
    for (std::size_t a = 0; a < 3; ++a)
      q[a] = -100.0 + 50.0 * knot[a];
    Vec3 left = model.first_order(q, kUnknownTravels, Beyond::stand_at_end);
    for (std::size_t a = 0; a < own.size(); ++a)
      left(static_cast<Eigen::Index>(a)) += offset_at(own[a], q[a]);
    for (const host::CecTable& table : cross)
      left(table.output[0] - 'X') +=
          offset_at(table, q[static_cast<std::size_t>(table.input[0] - 'X')], 1);
    worst = worst.cwiseMax(left.cwiseAbs());
    squares += left.squaredNorm();
  }
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_NEAR(kUmPerMm * worst(k), files.remainder_max_um(k), 3.0 * 0.5e-3);
  EXPECT_NEAR(kUmPerMm * std::sqrt(squares / 375.0), files.remainder_rms_um, 1e-3);
  EXPECT_GT(files.remainder_rms_um, 0.1) << "angles with levers are no sum of functions";
}

}  // namespace
}  // namespace volcomp::test
