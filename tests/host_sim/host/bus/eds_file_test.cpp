// EDS files of other people's devices: what CiA 306-1 lets stand there, and what it does not.

#include <gmock/gmock.h>

#include "host_sim/host/bus/device_files/eds.hpp"
#include "host_sim/host/bus/device_files/eds_file.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using canopen::Access;
using sim::complaint_of;
using testing::HasSubstr;

EdsFile file_of(const std::string& text) { return {text, "drive.eds"}; }

std::string object(const std::string& section, const std::string& keys) {
  return "[" + section + "]\nParameterName=x\nObjectType=0x7\nDataType=0x7\n" + keys + "\n";
}

// CiA 306-1, section 4.6.3.
TEST(EdsFile, AccessSaysWhereAnObjectMayBeMapped) {
  const EdsFile eds =
      file_of(object("2001", "AccessType=rww\nPDOMapping=1") +
              object("2002", "AccessType=rwr\nPDOMapping=1") +
              object("2003", "AccessType=rw\nPDOMapping=1") +
              object("2004", "AccessType=ro\nPDOMapping=1") +
              object("2005", "AccessType=wo\nPDOMapping=1") +
              object("2006", "AccessType=RW\nPDOMapping=0") + object("2007", "AccessType=const"));
  struct Expected {
    std::uint16_t index;
    bool to_rpdo;
    bool to_tpdo;
    Access access;
  };
  for (const Expected& e : {Expected{0x2001, true, false, Access::read_write},
                            Expected{0x2002, false, true, Access::read_write},
                            Expected{0x2003, true, true, Access::read_write},
                            Expected{0x2004, false, true, Access::read_only},
                            Expected{0x2005, true, false, Access::write_only},
                            Expected{0x2006, false, false, Access::read_write},
                            Expected{0x2007, false, false, Access::constant}}) {
    const EdsFileObject* const found = eds.find({e.index, 0});
    ASSERT_NE(found, nullptr) << e.index;
    EXPECT_EQ(found->to_rpdo, e.to_rpdo) << e.index;
    EXPECT_EQ(found->to_tpdo, e.to_tpdo) << e.index;
    EXPECT_EQ(found->access, e.access) << e.index;
  }
}

TEST(EdsFile, NumbersAreDecimalHexadecimalOctalOrMadeOfTheNodeId) {
  const EdsFile eds =
      file_of(object("2000", "DefaultValue=100") + object("2001", "DefaultValue=0x1F") +
              object("2002", "DefaultValue=010") + object("2003", "DefaultValue=$NODEID+0x180") +
              object("2004", "DefaultValue=0x200 + $nodeid") + object("2005", "DefaultValue=-2") +
              object("2006", "DefaultValue=") + object("2007", "DefaultValue=1\nParameterValue=7"));
  EXPECT_EQ(eds.number({0x2000, 0}, 5), 100U);
  EXPECT_EQ(eds.number({0x2001, 0}, 5), 0x1FU);
  EXPECT_EQ(eds.number({0x2002, 0}, 5), 8U);
  EXPECT_EQ(eds.number({0x2003, 0}, 5), 0x185U);
  EXPECT_EQ(eds.number({0x2004, 0}, 5), 0x205U);
  EXPECT_EQ(eds.number({0x2005, 0}, 5), static_cast<std::uint64_t>(-2));
  EXPECT_EQ(eds.number({0x2006, 0}, 5), std::nullopt);
  EXPECT_EQ(eds.number({0x2007, 0}, 5), 7U);  // of a DCF
  EXPECT_EQ(eds.number({0x2008, 0}, 5), std::nullopt);
}

TEST(EdsFile, SubIndicesOfARecordAndOfACompactArray) {
  const EdsFile eds =
      file_of("[1016]\nObjectType=0x8\nSubNumber=2\n" + object("1016sub0", "DefaultValue=1") +
              object("1016Sub1", "AccessType=rw") +
              "[2100]\nObjectType=0x8\nDataType=0x7\nCompactSubObj=3\nDefaultValue=9\n");
  EXPECT_EQ(eds.objects().size(), 5U);
  EXPECT_NE(eds.find({0x1016, 1}), nullptr);
  EXPECT_EQ(eds.number({0x2100, 3}, 1), 9U);
  EXPECT_EQ(eds.find({0x2100, 4}), nullptr);
}

TEST(EdsFile, APdoWithoutACountHasAsManyEntriesAsValues) {
  const EdsFile eds =
      file_of(object("1400sub1", "DefaultValue=$NODEID+0x200") +
              object("1400sub2", "DefaultValue=1") + object("1600sub1", "DefaultValue=0x60400010") +
              object("1600sub2", "DefaultValue=0x607A0020") + object("1600sub3", "DefaultValue=0"));
  ASSERT_EQ(eds.pdos(canopen::PdoKind::receive, 3).size(), 1U);
  const canopen::PdoParameters pdo = eds.pdos(canopen::PdoKind::receive, 3)[0];
  EXPECT_EQ(pdo.cob_id, 0x203U);
  EXPECT_EQ(pdo.type, 1);
  EXPECT_EQ(pdo.count, 2);
  EXPECT_EQ(pdo.mapping[1], 0x607A0020U);
}

TEST(EdsFile, ANameMayHoldASemicolonAndKeysAnySpelling) {
  const EdsFile eds =
      file_of("[DeviceInfo]\nPRODUCTNAME=A ; B\n" + object("2000", "ACCESSTYPE=ro"));
  EXPECT_EQ(eds.product(), "A ; B");
}

TEST(EdsFile, WhatIsNoEdsIsRefusedWithItsName) {
  EXPECT_EQ(complaint_of([] { return file_of("hello\n"); }),
            "drive.eds: line 1 is neither a section nor a key with a value");
  EXPECT_EQ(complaint_of([] { return file_of(""); }), "drive.eds: describes no object");
  EXPECT_EQ(complaint_of([] { return file_of("[DeviceInfo]\nVendorName=x\n"); }),
            "drive.eds: describes no object");
  EXPECT_EQ(file_of(object("2000", "DefaultValue=many")).number({0x2000, 0}, 1), std::nullopt);
  EXPECT_EQ(file_of(object("2000", "DefaultValue=0.5")).number({0x2000, 0}, 1), std::nullopt);
  EXPECT_THAT(complaint_of([] { return find_drive_eds("elmo"); }),
              HasSubstr("elmo: no such drive; there are elmo_gold"));
  EXPECT_THAT(complaint_of([] { return find_drive_eds("./none.eds"); }),
              HasSubstr("./none.eds: cannot be opened"));
}

// Our own writer is another implementation of the same standard.
TEST(EdsFile, ReadsTheFileOfTheNode) {
  const EdsFile eds(make_eds(), "volcomp.eds");
  EXPECT_EQ(eds.number({0x2202, 0}, 32).has_value(), true);
  EXPECT_EQ(eds.find({0x1018, 1})->access, Access::constant);
}

}  // namespace
}  // namespace volcomp::host
