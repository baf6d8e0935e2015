// What another version stored, or none: values that do not fit are left out, the others apply.

#include <algorithm>

#include "tests/firmware/node/strokes/stroke_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;

constexpr std::uint8_t kWholePdo = 0xFF;  // firmware/node/store/node_store.cpp: a record of a PDO
constexpr std::uint16_t kLearned = 0x2526;

// Bytes in place of a memory.
class KeptBytes final : public Storage {
 public:
  StoreResult save(Span<const std::uint8_t> values, Span<const std::uint8_t> tables) override {
    parameters.assign(values.begin(), values.end());
    image.assign(tables.begin(), tables.end());
    return StoreResult::done;
  }
  StoreResult load(Span<std::uint8_t>& values, Span<std::uint8_t>& tables) override {
    if (parameters.empty()) return StoreResult::nothing_stored;
    if (parameters.size() > values.size()) return StoreResult::buffer_too_small;
    std::copy(parameters.begin(), parameters.end(), values.begin());
    values = {values.data(), parameters.size()};
    if (tables.empty()) return StoreResult::loaded;
    if (image.size() > tables.size()) return StoreResult::buffer_too_small;
    std::copy(image.begin(), image.end(), tables.begin());
    tables = {tables.data(), image.size()};
    return StoreResult::loaded;
  }
  StoreResult erase() override {
    parameters.clear();
    return StoreResult::done;
  }

  void append(std::uint16_t index, std::uint8_t sub, const Bytes& value) {
    parameters.push_back(static_cast<std::uint8_t>(index));
    parameters.push_back(static_cast<std::uint8_t>(index >> 8U));
    parameters.push_back(sub);
    parameters.push_back(static_cast<std::uint8_t>(value.size()));
    parameters.insert(parameters.end(), value.begin(), value.end());
  }
  // First byte of the value of a record.
  std::uint8_t& value_of(std::uint16_t index, std::uint8_t sub) {
    std::size_t at = 0;
    while (at < parameters.size() &&
           (load_le(&parameters[at], 2) != index || parameters[at + 2] != sub))
      at += 4U + parameters[at + 3];
    return parameters.at(at + 4);
  }

  Bytes parameters;
  Bytes image;
};

class StoredValues : public ::testing::Test {
 protected:
  void save() { ASSERT_EQ(bench.set<std::uint32_t>(0x1010, 1, kSave), AbortCode::none); }

  KeptBytes kept;
  NodeBench bench{&kept};
};

// --- PDOs

constexpr auto kStatus = static_cast<std::uint16_t>(0x1800 + kStatusPdo);
constexpr auto kStatusMapping = static_cast<std::uint16_t>(0x1A00 + kStatusPdo);

TEST_F(StoredValues, APdoOfOnesOwnComesBackWhole) {
  ASSERT_EQ(bench.set<std::uint16_t>(kStatus, 5, 250), AbortCode::none);  // event timer
  ASSERT_EQ(bench.set<std::uint8_t>(0x1400, 2, 1), AbortCode::none);      // with every SYNC
  const std::uint64_t mapped = bench.number(kStatusMapping, 1);
  save();
  bench.power_on();
  EXPECT_EQ(bench.number(kStatus, 5), 250U);
  EXPECT_EQ(bench.number(0x1400, 2), 1U);
  EXPECT_EQ(bench.number(kStatusMapping, 1), mapped);
}

// Stored by a version that let it be changed.
TEST_F(StoredValues, AnotherMappingOfAnOffsetIsLeftOut) {
  ASSERT_EQ(bench.set<std::uint8_t>(0x2010, 1, 1), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint8_t>(0x1800, 2, 255), AbortCode::none);
  save();
  ASSERT_EQ(kept.value_of(0x1800, kWholePdo), 0x01);
  std::uint8_t* const mapping = &kept.value_of(0x1800, kWholePdo) + 10;
  store_le(mapping, 4, 0x2112'0720);
  bench.power_on();
  EXPECT_EQ(bench.number(0x1800, 2), 255U);
  EXPECT_EQ(bench.number(0x1A00, 1), 0x2020'0120U);
}

// Stored by a version that let a TPDO promise answers to remote requests.
TEST_F(StoredValues, RemoteRequestsOfATpdoAreNotPromised) {
  ASSERT_EQ(bench.set<std::uint16_t>(kStatus, 5, 500), AbortCode::none);
  const std::uint64_t cob_id = bench.number(kStatus, 1);
  save();
  std::uint8_t* const stored = &kept.value_of(kStatus, kWholePdo);
  ASSERT_EQ(load_le(stored, 4), cob_id);
  store_le(stored, 4, cob_id & ~std::uint64_t{canopen::kPdoNoRtr});
  bench.power_on();
  EXPECT_EQ(bench.number(kStatus, 5), 500U);
  EXPECT_EQ(bench.number(kStatus, 1), cob_id);
}

TEST_F(StoredValues, TheIdentifierOfSyncComesBack) {
  for (const std::uint32_t id : {0x4000'0080U, 0x81U, 0x80U}) {
    ASSERT_EQ(bench.set<std::uint32_t>(0x1005, 0, 0x80), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint32_t>(0x1005, 0, id), AbortCode::none);
    save();
    ASSERT_EQ(bench.set<std::uint32_t>(0x1005, 0, 0x80), AbortCode::none);
    bench.power_on();
    EXPECT_EQ(bench.number(0x1005, 0), id);
  }
}

// 1006h is applied before 1019h.
TEST_F(StoredValues, TheOverflowOfTheCounterComesBackBesideACyclePeriod) {
  ASSERT_EQ(bench.set<std::uint8_t>(0x1019, 0, 100), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 4000), AbortCode::none);
  save();
  bench.power_on();
  EXPECT_EQ(bench.number(0x1019, 0), 100U);
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
}

TEST_F(StoredValues, PdosThisVersionDoesNotHaveAreLeftOut) {
  const std::uint64_t type = bench.number(0x1400, 2);
  const std::uint64_t timer = bench.number(0x1800, 5);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 4000), AbortCode::none);
  save();
  const Bytes whole(10 + 4 * canopen::kMostMapped, 0x01);
  const Bytes half(whole.begin(), whole.begin() + 10);
  kept.append(0x1400, kWholePdo, half);
  kept.append(0x1800, kWholePdo, half);
  kept.append(0x1280, kWholePdo, whole);  // an SDO client
  kept.append(0x1400 + 0x1FF, kWholePdo, whole);
  kept.append(0x1800 + 0x1FF, kWholePdo, whole);
  kept.append(0x1008, 0, {'x'});  // read only
  kept.append(0x1777, 1, {1, 2, 3, 4});
  bench.power_on();
  EXPECT_EQ(bench.number(0x1400, 2), type);
  EXPECT_EQ(bench.number(0x1800, 5), timer);
  EXPECT_EQ(bench.number(0x1006, 0), 4000U) << "the rest applies";
}

// Places that hold no value of their own: a count of elements, a domain.
TEST_F(StoredValues, PlacesWithoutAValueAreLeftOut) {
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 4000), AbortCode::none);
  save();
  const std::uint64_t axes = bench.number(0x2201, 0);
  kept.append(0x2201, 0, {1});
  kept.append(0x2110, 1, {1, 2, 3});
  kept.append(0x2110, 1, {});
  bench.power_on();
  EXPECT_EQ(bench.number(0x2201, 0), axes);
  EXPECT_EQ(bench.number(0x2112, 1), static_cast<std::uint64_t>(TableState::empty));
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
}

// More objects than there are are mapped by none.
TEST_F(StoredValues, APdoThatMapsTooMuchIsLeftOut) {
  ASSERT_EQ(bench.set<std::uint16_t>(kStatus, 5, 250), AbortCode::none);
  save();
  std::uint8_t* const pdo = &kept.value_of(kStatus, kWholePdo);
  pdo[9] = 200;  // objects mapped
  bench.power_on();
  EXPECT_LE(bench.number(kStatusMapping, 0), canopen::kMostMapped);
  EXPECT_EQ(bench.number(kStatus, 5), 1000U) << "as delivered";
}

TEST_F(StoredValues, ALastValueThatIsCutOffIsLeftOut) {
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 4000), AbortCode::none);
  save();
  kept.append(0x1017, 0, Bytes(2, 0x10));
  kept.parameters.pop_back();
  bench.power_on();
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
  EXPECT_EQ(bench.number(0x1017, 0), 100U);
}

// --- strokes

class StoredStrokeValues : public ::testing::Test {
 protected:
  void SetUp() override {
    grinder.configure();
    grinder.start();
  }
  void learn() {
    grinder.grind([](auto, bool, double) { return StrokeBench::Errors{0.0, 40e-6}; });
    ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
    image = grinder.image();
  }
  void save() {
    grinder.bench.nmt(canopen::NmtCommand::enter_pre_operational);
    ASSERT_EQ(grinder.bench.set<std::uint32_t>(0x1010, 1, kSave), AbortCode::none);
  }
  Reason reason(std::uint16_t index, std::uint8_t sub) {
    return static_cast<Reason>(grinder.bench.number(index, sub));
  }
  void expect_nothing_learned() {
    Bytes none;
    EXPECT_EQ(grinder.bench.read({0x2526, 1}, none), AbortCode::no_data);
    EXPECT_EQ(grinder.bench.number(0x2524, 1), 0U);
  }

  KeptBytes kept;
  StrokeBench grinder{&kept};
  Bytes image;
};

TEST_F(StoredStrokeValues, SwitchedOnWithoutTablesTheyStartFromNothing) {
  save();
  grinder.bench.power_on();
  EXPECT_EQ(grinder.bench.number(0x2500, 1), 1U);
  EXPECT_EQ(reason(0x2526, 2), Reason::ok) << "nobody asked for tables";
  expect_nothing_learned();
}

TEST_F(StoredStrokeValues, SettingsThatNoLongerFitSwitchThemOff) {
  learn();
  save();
  kept.value_of(0x2500, 6) = 1;  // nodes
  grinder.bench.power_on();
  EXPECT_EQ(grinder.bench.number(0x2500, 1), 0U);
  EXPECT_EQ(reason(0x2500, 11), Reason::too_few_knots);
  EXPECT_NE(grinder.bench.number(0x2112, 7), 0U) << "the tables of the machine are there";
}

TEST_F(StoredStrokeValues, DamagedTablesAreNotUsed) {
  learn();
  save();
  kept.value_of(kLearned, 0) ^= 1U;
  grinder.bench.power_on();
  EXPECT_EQ(grinder.bench.number(0x2500, 1), 1U);
  EXPECT_EQ(reason(0x2526, 2), Reason::bad_magic);
  expect_nothing_learned();
}

// More pieces than tables can have: those that do not fit are dropped, the first are complete.
TEST_F(StoredStrokeValues, NoPieceGoesBeyondTheMemoryOfTheTables) {
  learn();
  save();
  for (std::uint8_t piece = 1; piece < 13; ++piece)
    kept.append(kLearned, piece, Bytes(240, 0x55));
  grinder.bench.power_on();
  EXPECT_EQ(reason(0x2526, 2), Reason::image_truncated);
  expect_nothing_learned();
}

}  // namespace
}  // namespace volcomp::node
