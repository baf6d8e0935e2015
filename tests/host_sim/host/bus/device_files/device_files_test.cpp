// The EDS in firmware/ matches the code: it is made from it and, read again by other code, agrees
// with what a node answers over SDO.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "host_sim/host/bus/device_files/eds.hpp"
#include "tests/host_sim/host/bus/device_files/device_files_support.hpp"

namespace volcomp::node::test {
namespace {

using canopen::AbortCode;
using canopen::ObjectId;
using ::testing::AnyOf;
using ::testing::Not;

bool is_pdo_parameter(ObjectId object) { return object.index >= 0x1400 && object.index < 0x1C00; }

class CommittedEds : public ::testing::Test {
 protected:
  const Ini eds = parse_ini(project_file("firmware/volcomp.eds"));
  const std::vector<EdsEntry> entries = entries_of(eds);

  void SetUp() override { ASSERT_GT(entries.size(), 100U) << "firmware/volcomp.eds"; }
};

TEST_F(CommittedEds, IsTheOneTheCodeMakes) {
  EXPECT_TRUE(project_file("firmware/volcomp.eds") == host::make_eds()) << kRegenerate;
}

// --- every value of the EDS is in the node

TEST_F(CommittedEds, ValuesAfterPowerOnAreTheDefaults) {
  NodeOnTheBus node;
  for (const EdsEntry& entry : entries) {
    SCOPED_TRACE(name_of(entry.object));
    Bytes value;
    const AbortCode why = node.read(entry.object, value);
    const auto expected = entry.default_value(NodeOnTheBus::kId);
    EXPECT_EQ(why, expected || entry.is_real() ? AbortCode::none : AbortCode::no_data);
    if (!expected) continue;
    EXPECT_EQ(value, *expected);
  }
}

// No error has happened, no image was staged, no point waits; of reals see below. Nothing else may
// lack a default.
TEST_F(CommittedEds, OnlyTheErrorHistoryTheDomainsAndRealsHaveNoDefault) {
  int reals = 0;
  for (const EdsEntry& entry : entries) {
    const bool history = entry.object.index == 0x1003 && entry.object.sub > 0;
    reals += entry.is_real() ? 1 : 0;
    EXPECT_EQ(entry.has("DefaultValue"), !history && !entry.is_domain() && !entry.is_real())
        << name_of(entry.object);
  }
  EXPECT_GT(reals, 5);
}

// lely's dcfgen refuses the whole file for a default of 0.5: a default that is no string is a whole
// number, decimal or hexadecimal.
TEST_F(CommittedEds, DefaultsThatAreNoStringsAreWholeNumbers) {
  const std::regex whole(R"((\$NODEID\+)?(-?[0-9]+|0x[0-9A-F]+))");
  for (const EdsEntry& entry : entries) {
    if (!entry.has("DefaultValue") || entry.is_string()) continue;
    EXPECT_TRUE(std::regex_match(entry.keys.at("DefaultValue"), whole))
        << name_of(entry.object) << ": " << entry.keys.at("DefaultValue");
  }
}

// CiA 301, sections 7.5.2.36 and 7.5.2.38: a PDO is changed while it is not valid, its mapping
// while it has no entries.
void prepare_pdo(NodeOnTheBus& node, ObjectId object) {
  const bool mapping = (object.index & 0x0200U) != 0;
  const ObjectId cob_id{static_cast<std::uint16_t>(object.index & ~0x0200U), 1};
  const std::int64_t invalid = node.number(cob_id) | 0x8000'0000U;
  ASSERT_EQ(node.write(cob_id, little_endian(invalid, 4)), AbortCode::none);
  if (!mapping || object.sub == 0) return;
  ASSERT_EQ(node.write({object.index, 0}, {0}), AbortCode::none);
}

// 1010h and 1011h want the words "save" and "load", 2411h the number of a point that waits.
AbortCode answer_to_writing(const EdsEntry& entry) {
  if (entry.access() == "ro" || entry.access() == "const") return AbortCode::read_only;
  if (entry.object.index == 0x2411) return AbortCode::invalid_value;
  const bool signature = entry.object.index == 0x1010 || entry.object.index == 0x1011;
  return signature ? AbortCode::cannot_store : AbortCode::none;
}

TEST_F(CommittedEds, ValuesCanBeWrittenWhereTheAccessTypeSaysSo) {
  for (const EdsEntry& entry : entries) {
    const auto value = entry.default_value(NodeOnTheBus::kId);
    if (!value) continue;
    SCOPED_TRACE(name_of(entry.object) + " " + entry.access());
    NodeOnTheBus node;
    if (is_pdo_parameter(entry.object)) prepare_pdo(node, entry.object);
    EXPECT_EQ(node.write(entry.object, *value), answer_to_writing(entry));
  }
}

TEST_F(CommittedEds, ValuesOfAnotherSizeAreRefused) {
  for (const EdsEntry& entry : entries) {
    if (entry.access() != "rw" || entry.bytes() == 0) continue;
    SCOPED_TRACE(name_of(entry.object));
    NodeOnTheBus node;
    const Bytes longer(entry.bytes() + 1);
    EXPECT_EQ(node.write(entry.object, longer), AbortCode::too_long);
  }
}

// Strokes want to know their axes first, and learning that they are on.
AbortCode answer_to_highest(const EdsEntry& entry) {
  if (entry.object == ObjectId{0x2500, 1}) return AbortCode::invalid_value;
  return entry.object == ObjectId{0x2520, 1} ? AbortCode::device_state : AbortCode::none;
}

TEST_F(CommittedEds, LimitsAreThoseOfTheNode) {
  int limits = 0;
  for (const EdsEntry& entry : entries) {
    ASSERT_EQ(entry.has("LowLimit"), entry.has("HighLimit"));
    if (!entry.has("HighLimit")) continue;
    ++limits;
    SCOPED_TRACE(name_of(entry.object));
    const std::int64_t low = entry.number("LowLimit");
    const std::int64_t high = entry.number("HighLimit");
    const bool is_signed = entry.number("DataType") < 0x05 || entry.number("DataType") == 0x15;
    const auto write = [&](std::int64_t value) {
      NodeOnTheBus node;
      // A probe needs to know the cycle period; the counter changes only where there is none.
      const bool counter = entry.object == ObjectId{0x1019, 0};
      EXPECT_EQ(node.write({0x1006, 0}, little_endian(counter ? 0 : 1'000, 4)), AbortCode::none);
      return node.write(entry.object, little_endian(value, entry.bytes()));
    };
    EXPECT_EQ(write(low), AbortCode::none);
    EXPECT_EQ(write(high + 1), AbortCode::value_too_high);
    EXPECT_EQ(write(high), answer_to_highest(entry));
    if (low == 0 && !is_signed) continue;
    EXPECT_EQ(write(low - 1), AbortCode::value_too_low);
  }
  EXPECT_GT(limits, 50);
}

// Where there are no limits, no value of the type is out of them.
TEST_F(CommittedEds, OtherValuesHaveNoLimits) {
  for (const EdsEntry& entry : entries) {
    if (entry.has("HighLimit") || entry.bytes() == 0) continue;
    SCOPED_TRACE(name_of(entry.object));
    Bytes extreme(entry.bytes(), 0xFF);
    for (const unsigned top : {0x00U, 0x7FU, 0x80U, 0xFFU}) {
      extreme.back() = static_cast<std::uint8_t>(top);
      NodeOnTheBus node;
      EXPECT_THAT(node.write(entry.object, extreme),
                  Not(AnyOf(AbortCode::value_too_high, AbortCode::value_too_low)));
    }
  }
}

// --- process data

constexpr auto kStatusMapping = static_cast<std::uint16_t>(0x1A00 + node::kStatusPdo);

// Tries to map the object into a PDO with a mapping that may change.
AbortCode map(std::uint16_t mapping_parameter, ObjectId object, std::size_t bytes) {
  NodeOnTheBus node;
  const std::int64_t mapping = std::int64_t{object.index} << 16 | std::int64_t{object.sub} << 8 |
                               static_cast<std::int64_t>(8 * bytes);
  const auto communication = static_cast<std::uint16_t>(mapping_parameter - 0x200);
  EXPECT_EQ(node.write({communication, 1}, little_endian(0x8000'0000, 4)), AbortCode::none);
  EXPECT_EQ(node.write({mapping_parameter, 0}, {0}), AbortCode::none);
  return node.write({mapping_parameter, 1}, little_endian(mapping, 4));
}

TEST_F(CommittedEds, ObjectsCanBeMappedWhereTheyAreSaidToBeMappable) {
  for (const EdsEntry& entry : entries) {
    if (entry.bytes() == 0) continue;
    SCOPED_TRACE(name_of(entry.object));
    const bool mappable = entry.number("PDOMapping") != 0;
    const bool in = mappable && entry.access() == "rww";
    const bool out = mappable && entry.access() != "rww";
    const AbortCode no =
        is_pdo_parameter(entry.object) ? AbortCode::no_object : AbortCode::not_mappable;
    EXPECT_EQ(map(0x1600, entry.object, entry.bytes()), in ? AbortCode::none : no);
    EXPECT_EQ(map(kStatusMapping, entry.object, entry.bytes()), out ? AbortCode::none : no);
  }
}

TEST_F(CommittedEds, DummiesAreThoseTheNodeSkips) {
  constexpr std::array<std::size_t, 8> kBytes{0, 1, 1, 2, 4, 1, 2, 4};
  for (std::uint16_t type = 1; type <= 7; ++type) {
    const bool usable = eds.at("DummyUsage").at("Dummy000" + std::to_string(type)) == "1";
    EXPECT_EQ(map(0x1600, {type, 0}, kBytes.at(type)) == AbortCode::none, usable) << type;
  }
}

TEST_F(CommittedEds, CountsOfPdosAreThoseOfTheirObjects) {
  const auto count = [this](std::uint16_t first) {
    return std::count_if(entries.begin(), entries.end(), [first](const EdsEntry& entry) {
      return entry.object.sub == 1 && entry.object.index >= first &&
             entry.object.index < first + 0x200;
    });
  };
  const Section& info = eds.at("DeviceInfo");
  EXPECT_EQ(std::to_string(count(0x1400)), info.at("NrOfRXPDO"));
  EXPECT_EQ(std::to_string(count(0x1600)), info.at("NrOfRXPDO"));
  EXPECT_EQ(std::to_string(count(0x1800)), info.at("NrOfTXPDO"));
  EXPECT_EQ(std::to_string(count(0x1A00)), info.at("NrOfTXPDO"));
}

// --- nothing in the node is missing from the EDS

TEST_F(CommittedEds, HoldsEverythingTheNodeAnswersFor) {
  std::set<std::string> described;
  for (const EdsEntry& entry : entries)
    described.insert(name_of(entry.object));
  std::set<std::string> found;
  NodeOnTheBus node;
  const auto look = [&](unsigned index, unsigned sub) {
    const ObjectId object{static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)};
    if (node.exists(object)) found.insert(name_of(object));
  };
  for (unsigned index = 0x1000; index <= 0x2FFF; ++index) {
    for (unsigned sub = 0; sub <= 20; ++sub)
      look(index, sub);
  }
  for (unsigned index = 0x0000; index <= 0xFFFF; ++index)
    look(index, 0);
  for (const auto& [section, keys] : eds) {
    if (keys.count("ObjectType") == 0 || section.size() != 4) continue;
    for (unsigned sub = 0; sub <= 0xFF; ++sub)
      look(static_cast<unsigned>(std::stoul(section, nullptr, 16)), sub);
  }
  EXPECT_EQ(found, described);
}

// CiA 306-1, section 4.6.2: every object is in one of three lists, numbered from 1.
TEST_F(CommittedEds, ListsNameEveryObjectOnce) {
  std::set<std::string> listed;
  for (const char* const list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"}) {
    const Section& objects = eds.at(list);
    const int count = std::stoi(objects.at("SupportedObjects"));
    EXPECT_EQ(objects.size(), static_cast<std::size_t>(count) + 1);
    for (int i = 1; i <= count; ++i)
      EXPECT_TRUE(listed.insert(objects.at(std::to_string(i)).substr(2)).second) << list << i;
  }
  std::set<std::string> sections;
  for (const auto& section : eds) {
    if (std::regex_match(section.first, std::regex("[0-9A-F]{4}"))) sections.insert(section.first);
  }
  EXPECT_EQ(listed, sections);
}

TEST_F(CommittedEds, SubNumberCountsTheSubIndices) {
  for (const auto& [section, keys] : eds) {
    if (keys.count("SubNumber") == 0) continue;
    const std::string prefix = section + "sub";
    const auto subs = std::count_if(eds.begin(), eds.end(), [&prefix](const auto& other) {
      return other.first.rfind(prefix, 0) == 0;
    });
    EXPECT_EQ(std::to_string(subs), keys.at("SubNumber")) << section;
  }
}

}  // namespace
}  // namespace volcomp::node::test
