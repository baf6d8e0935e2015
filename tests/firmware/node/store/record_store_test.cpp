// One record, stored twice: layout, sizes, damage and devices that fail. Power failures stand in
// record_store_power_test.cpp.

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "comp/core/crc32.hpp"
#include "tests/firmware/node/store/record_store_support.hpp"

namespace volcomp::node {
namespace {

using Small = test::MemoryBlocks<1024, 2>;
using test::Torn;

const Record kFirst = make_record(100, 300, 11);
const Record kSecond = make_record(90, 310, 12);

// kFirst in slot 0, then kSecond in slot 1.
Small with_both() {
  Small flash;
  EXPECT_EQ(save(flash, kFirst), StoreResult::done);
  EXPECT_EQ(save(flash, kSecond), StoreResult::done);
  return flash;
}

Bytes slot_of(const Small& flash, std::size_t slot) {
  const auto first = flash.content().begin() + static_cast<std::ptrdiff_t>(1024 * slot);
  return {first, first + 1024};
}

TEST(RecordStore, HasTheDocumentedLayout) {
  Small flash;
  const std::string check = "123456789";  // its CRC-32C is E3069283 in every catalogue
  const Record record{Bytes(check.begin(), check.end()), Bytes{0xAB}};
  ASSERT_EQ(save(flash, record), StoreResult::done);
  const Bytes slot = slot_of(flash, 0);
  EXPECT_THAT(Bytes(slot.begin(), slot.begin() + 24),
              ::testing::ElementsAre('V', 'O', 'L', 'C', 'O', 'M', 'P', '2', 1, 0, 0, 0, 9, 0, 0, 0,
                                     0x83, 0x92, 0x06, 0xE3, 1, 0, 0, 0));
  EXPECT_EQ(Bytes(slot.begin() + 32, slot.begin() + 64), Bytes(32, 0)) << "the seal";
  EXPECT_EQ(slot[64], '1');
  EXPECT_EQ(slot[72], '9');
  EXPECT_EQ(slot[96], 0xAB);
  EXPECT_EQ(slot[97], 0xFF);
}

TEST(RecordStore, ContinuesACrc) {
  for (std::size_t first = 0; first <= 5; ++first) {
    std::string head = "123456789";
    std::string tail = head.substr(first);
    head.resize(first);
    const Bytes a(head.begin(), head.end());
    const Bytes b(tail.begin(), tail.end());
    EXPECT_EQ(crc32c(b, crc32c(a)), 0xE3069283U);
  }
}

TEST(RecordStore, ABlankDeviceHasNothingStored) {
  Small flash;
  EXPECT_EQ(load(flash).result, StoreResult::nothing_stored);
}

// The largest unit the layout allows, and that of flash programmed byte by byte.
template <class Flash>
class RecordStoreOf : public ::testing::Test {};
using UnitsOfLargeBlocks =
    ::testing::Types<test::MemoryBlocks<32768, 2, 32>, test::MemoryBlocks<32768, 2, 8>,
                     test::MemoryBlocks<32768, 2, 1>>;
TYPED_TEST_SUITE(RecordStoreOf, UnitsOfLargeBlocks, );

TYPED_TEST(RecordStoreOf, ReturnsEverySizeUpToAFullSector) {
  const std::vector<std::pair<std::size_t, std::size_t>> sizes{
      {0, 0},     {1, 0},     {0, 1},       {2, 3},       {31, 32},   {32, 33},
      {33, 31},   {255, 256}, {256, 257},   {511, 513},   {600, 1},   {600, 31744},
      {0, 32704}, {1, 32672}, {32, 32672},  {33, 32640},  {32704, 0}, {32672, 32},
      {32673, 0}, {700, 509}, {1000, 4096}, {1000, 4097},
  };
  TypeParam flash;
  unsigned seed = 0;
  for (const auto& [parameters, image] : sizes) {
    SCOPED_TRACE(std::to_string(parameters) + " and " + std::to_string(image));
    const Record record = make_record(parameters, image, ++seed);
    ASSERT_EQ(save(flash, record), StoreResult::done);
    expect_loads(flash, StoreResult::loaded, record);
  }
}

TEST(RecordStore, RefusesWhatDoesNotFitAndTouchesNothing) {
  Small flash;
  ASSERT_EQ(save(flash, kFirst), StoreResult::done);
  const std::size_t operations = flash.operations();
  for (const auto& [parameters, image] : std::vector<std::pair<std::size_t, std::size_t>>{
           {0, 961}, {961, 0}, {1, 929}, {929, 1}, {5000, 0}, {0, 5000}})
    EXPECT_EQ(save(flash, make_record(parameters, image, 1)), StoreResult::too_large);
  EXPECT_EQ(flash.operations(), operations);
  expect_loads(flash, StoreResult::loaded, kFirst);
}

TEST(RecordStore, ReadsItsOwnSaveWithoutLoading) {
  Small flash;
  RecordStore<Small> store(flash);
  Bytes out(1024);
  std::size_t size = 7;
  EXPECT_EQ(store.read_image(out, size), StoreResult::nothing_stored);
  EXPECT_EQ(size, 0U);
  ASSERT_EQ(store.save(kFirst.parameters, kFirst.image), StoreResult::done);
  EXPECT_EQ(store.record().sequence, 1U);
  ASSERT_EQ(store.read_image(out, size), StoreResult::done);
  out.resize(size);
  EXPECT_EQ(out, kFirst.image);
}

TEST(RecordStore, SaysHowLargeABufferMustBe) {
  Small flash;
  RecordStore<Small> store(flash);
  ASSERT_EQ(store.save(kFirst.parameters, kFirst.image), StoreResult::done);
  Bytes out(299, 0x55);
  std::size_t size = 0;
  EXPECT_EQ(store.read_image(out, size), StoreResult::buffer_too_small);
  EXPECT_EQ(size, 300U);
  EXPECT_EQ(out, Bytes(299, 0x55));
}

TEST(RecordStore, PartsAreCheckedAgainWhenTheyAreRead) {
  Small flash;
  RecordStore<Small> store(flash);
  ASSERT_EQ(store.save(kFirst.parameters, kFirst.image), StoreResult::done);
  flash.flip(kParametersAt, 1);
  Bytes out(1024);
  std::size_t size = 0;
  EXPECT_EQ(store.read_parameters(out, size), StoreResult::damaged);
  EXPECT_EQ(store.read_image(out, size), StoreResult::done);
}

TEST(RecordStore, TheSequenceNumberWraps) {
  Small flash;
  ASSERT_EQ(save(flash, kFirst), StoreResult::done);
  RecordHeaderBytes bytes{};
  ASSERT_EQ(flash.read(0, bytes), hal::BlockRead::done);
  RecordHeader header = decode_record_header(bytes, 1024).header;
  header.sequence = UINT32_MAX - 1;
  const RecordHeaderBytes late = encode_record_header(header);
  for (std::size_t i = 0; i < late.size(); ++i)
    flash.flip(i, static_cast<std::uint8_t>(bytes[i] ^ late[i]));
  for (unsigned i = 0; i < 4; ++i) {
    const Record record = make_record(10 + i, 20, i);
    ASSERT_EQ(save(flash, record), StoreResult::done);
    RecordStore<Small> store(flash);
    EXPECT_EQ(store.load(), StoreResult::loaded);
    EXPECT_EQ(store.record().sequence, UINT32_MAX + i);
    expect_loads(flash, StoreResult::loaded, record);
  }
}

// --- damage

// Every bit of the newest record counts; the seal and what lies behind the record do not.
TEST(RecordStore, EveryFlippedBitOfTheNewestRecordGivesTheOlderAndIsSaid) {
  const Small before = with_both();
  const std::size_t image = image_at(90);
  for (std::size_t at = 0; at < 1024; ++at) {
    const bool of_record = at < kSealAt || (at >= kParametersAt && at < kParametersAt + 90) ||
                           (at >= image && at < image + 310);
    for (unsigned bit = 0; bit < 8; ++bit) {
      SCOPED_TRACE("byte " + std::to_string(at) + " bit " + std::to_string(bit));
      Small flash = before;
      flash.flip(1024 + at, static_cast<std::uint8_t>(1U << bit));
      expect_loads(flash, of_record ? StoreResult::loaded_older : StoreResult::loaded,
                   of_record ? kFirst : kSecond);
    }
  }
}

TEST(RecordStore, EveryFlippedBitOfTheOnlyRecordIsRefusedAsDamage) {
  Small before;
  ASSERT_EQ(save(before, kFirst), StoreResult::done);
  std::size_t refused = 0;
  for (std::size_t at = 0; at < 1024; ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Small flash = before;
      flash.flip(at, static_cast<std::uint8_t>(1U << bit));
      const Loaded found = load(flash);
      const bool intact = found.result == StoreResult::loaded && found.record == kFirst;
      EXPECT_TRUE(intact || found.result == StoreResult::damaged) << at;
      refused += intact ? 0U : 1U;
    }
  }
  EXPECT_EQ(refused, 8 * (kRecordHeaderBytes + 100 + 300));
}

// Data that end with their own CRC-32, as an image does, all have the same CRC-32.
TEST(RecordStore, AnotherImageInThePlaceOfTheStoredOneIsDamage) {
  const auto closed = [](Bytes bytes) {
    const std::uint32_t crc = crc32(bytes);
    for (unsigned i = 0; i < 4; ++i)
      bytes.push_back(static_cast<std::uint8_t>(crc >> (8 * i)));
    return bytes;
  };
  const Bytes stored = closed(kFirst.image);
  const Bytes other = closed(make_record(0, 300, 14).image);
  ASSERT_EQ(crc32(stored), crc32(other));
  Small flash;
  ASSERT_EQ(save(flash, {kFirst.parameters, stored}), StoreResult::done);
  for (std::size_t i = 0; i < stored.size(); ++i)
    flash.flip(image_at(100) + i, static_cast<std::uint8_t>(stored[i] ^ other[i]));
  EXPECT_EQ(load(flash).result, StoreResult::damaged);
}

TEST(RecordStore, DamageToTheOlderRecordIsNoLoss) {
  Small flash = with_both();
  flash.flip(kParametersAt, 1);
  expect_loads(flash, StoreResult::loaded, kSecond);
}

TEST(RecordStore, DamageToBothIsSaidAndCanBeSavedOver) {
  Small flash = with_both();
  flash.flip(0, 1);
  flash.flip(1024 + kParametersAt, 1);
  EXPECT_EQ(load(flash).result, StoreResult::damaged);
  EXPECT_EQ(save(flash, kSecond), StoreResult::done);
  expect_loads(flash, StoreResult::loaded, kSecond);
}

TEST(RecordStore, ADamagedNewestRecordIsReplacedAndTheOlderKept) {
  Small flash = with_both();
  flash.flip(1024 + kParametersAt, 1);
  const Bytes older = slot_of(flash, 0);
  ASSERT_EQ(save(flash, kSecond), StoreResult::done);
  EXPECT_EQ(slot_of(flash, 0), older);
  expect_loads(flash, StoreResult::loaded, kSecond);
}

TEST(RecordStore, SizesBeyondTheSectorAreNotBelieved) {
  for (const RecordPart huge : {RecordPart{961, 0}, RecordPart{UINT32_MAX, 0}}) {
    const auto a = encode_record_header({1, huge, {}});
    const auto b = encode_record_header({1, {}, huge});
    EXPECT_EQ(decode_record_header(a, 1024).state, SlotState::headless);
    EXPECT_EQ(decode_record_header(b, 1024).state, SlotState::headless);
  }
}

// --- devices that fail

class FailingDevice : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(save(flash, kFirst), StoreResult::done); }

  // As soon as the device works again, so does the store.
  void TearDown() override {
    EXPECT_TRUE(load(flash).record == kFirst);
    EXPECT_EQ(save(flash, kSecond), StoreResult::done);
    expect_loads(flash, StoreResult::loaded, kSecond);
  }

  Small flash;
};

TEST_F(FailingDevice, Erasing) {
  flash.refuse_erases(true);
  EXPECT_EQ(save(flash, kSecond), StoreResult::erase_failed);
  EXPECT_EQ(erase_all(flash), StoreResult::erase_failed);
  expect_loads(flash, StoreResult::loaded, kFirst);
  flash.refuse_erases(false);
}

TEST_F(FailingDevice, Programming) {
  flash.refuse_programs(true);
  EXPECT_EQ(save(flash, kSecond), StoreResult::write_failed);
  expect_loads(flash, StoreResult::loaded, kFirst);
  flash.refuse_programs(false);
}

TEST_F(FailingDevice, Reading) {
  const std::size_t operations = flash.operations();
  flash.refuse_reads(0, true);
  flash.refuse_reads(1, true);
  EXPECT_EQ(load(flash).result, StoreResult::read_failed);
  EXPECT_EQ(save(flash, kSecond), StoreResult::read_failed);
  EXPECT_EQ(flash.operations(), operations) << "nothing is erased that does not answer";
  flash.refuse_reads(0, false);
  flash.refuse_reads(1, false);
}

TEST_F(FailingDevice, ABitThatCannotBeProgrammed) {
  flash.set_stuck_bits(0x10);
  EXPECT_EQ(save(flash, kSecond), StoreResult::verify_failed);
  expect_loads(flash, StoreResult::loaded_older, kFirst);  // no header was written
  EXPECT_EQ(save(flash, Record{}), StoreResult::verify_failed) << "in the header";
  expect_loads(flash, StoreResult::loaded_older, kFirst);
  flash.set_stuck_bits(0);
}

// Once, at every operation, whatever the device has done by then.
TEST(RecordStore, AFailureOfEveryOperationIsReportedAndLosesNothing) {
  const Small before = with_both();
  const Record next = make_record(77, 222, 13);
  Small whole = before;
  ASSERT_EQ(save(whole, next), StoreResult::done);
  for (std::size_t at = 0; at < whole.operations() - before.operations(); ++at) {
    for (const Torn torn : test::kEveryTorn) {
      SCOPED_TRACE("operation " + std::to_string(at) + ", " +
                   std::to_string(static_cast<int>(torn)));
      Small flash = before;
      flash.fail_at(at, torn);
      const StoreResult result = save(flash, next);
      EXPECT_EQ(result, at == 0 ? StoreResult::erase_failed : StoreResult::write_failed);
      const Loaded found = load(flash);
      EXPECT_TRUE(found.record == kSecond || found.record == next);
      EXPECT_EQ(save(flash, next), StoreResult::done);
      expect_loads(flash, StoreResult::loaded, next);
    }
  }
}

TEST(RecordStore, AnUnreadableSlotIsReplacedWhenTheOtherIsIntact) {
  Small flash = with_both();
  flash.refuse_reads(1, true);
  expect_loads(flash, StoreResult::loaded_older, kFirst);
  EXPECT_EQ(save(flash, kFirst), StoreResult::read_failed) << "it cannot be verified";
  flash.refuse_reads(1, false);
  EXPECT_TRUE(load(flash).record == kFirst);
}

TEST(RecordStore, AnUnreadableRecordIsErasedOnlyAfterItsSuccessorIsComplete) {
  Small before;
  ASSERT_EQ(save(before, kFirst), StoreResult::done);
  before.refuse_reads(0, true);
  Small whole = before;
  ASSERT_EQ(save(whole, kSecond), StoreResult::done);
  const std::size_t all = whole.operations() - before.operations();
  whole.refuse_reads(0, false);
  expect_loads(whole, StoreResult::loaded, kSecond);

  for (std::size_t at = 0; at < all; ++at) {
    Small cut = before;
    cut.cut_power_at(at, Torn::random);
    EXPECT_NE(save(cut, kSecond), StoreResult::done);
    cut.power_on();
    cut.refuse_reads(0, false);
    const Loaded found = load(cut);
    EXPECT_TRUE(found.record == kFirst || (found.record == kSecond && at >= all - 2)) << at;
  }
}

TEST(RecordStore, EveryResultHasItsOwnSentence) {
  std::set<std::string> sentences;
  for (std::uint8_t i = 0; i < kStoreResults; ++i)
    sentences.insert(sentence(static_cast<StoreResult>(i)));
  EXPECT_EQ(sentences.size(), kStoreResults);
  EXPECT_EQ(sentences.count(sentence(static_cast<StoreResult>(kStoreResults))), 0U);
}

}  // namespace
}  // namespace volcomp::node
