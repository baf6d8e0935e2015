// One record, kept twice: whatever fails and wherever power fails, what is loaded is exactly what
// one save was given.

#include "firmware/node/record_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "comp/tables/crc32.hpp"

namespace volcomp::node {
namespace {

using Bytes = std::vector<std::uint8_t>;

enum class EraseOrder : std::uint8_t { up, down, everywhere };

// NOR flash: erased to ones, and nothing is written twice. A cut leaves the byte it hits with some
// of its bits changed; `everywhere` leaves a half-erased sector with any of its bits.
template <std::size_t kBytes>
class NorFlash {
 public:
  static constexpr std::size_t kSectorBytes = kBytes;
  static constexpr std::size_t kSectors = 2;

  bool read(std::size_t at, Span<std::uint8_t> out) {
    if (!powered || at / kBytes == unreadable || fail_reads) return false;
    std::copy_n(memory.begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
    return true;
  }

  bool write(std::size_t at, Span<const std::uint8_t> bytes) {
    if (!powered || writes_until_failure-- == 0) return false;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      EXPECT_FALSE(programmed[at + i]) << "byte " << at + i << " written twice";
      programmed[at + i] = true;
      const bool alive = step();
      const auto missed = static_cast<std::uint8_t>(alive ? stuck_bits : random());
      memory[at + i] = static_cast<std::uint8_t>(bytes[i] | missed);
      if (!alive) return false;
    }
    return true;
  }

  bool erase(std::size_t sector) {
    if (!powered || fail_erases) return false;
    const std::size_t start = sector * kBytes;
    for (std::size_t i = 0; i < kBytes; ++i) {
      const std::size_t at = start + (order == EraseOrder::down ? kBytes - 1 - i : i);
      if (!step()) {
        memory[at] |= static_cast<std::uint8_t>(random());
        if (order == EraseOrder::everywhere) scramble(start);
        return false;
      }
      memory[at] = 0xFF;
      programmed[at] = false;
    }
    return true;
  }

  void restore_power() {
    powered = true;
    steps_left = SIZE_MAX;
  }

  Bytes memory = Bytes(2 * kBytes, 0xFF);
  std::vector<bool> programmed = std::vector<bool>(2 * kBytes, false);
  std::mt19937 random{1};  // NOLINT(cert-msc51-cpp): the same bytes every time
  EraseOrder order = EraseOrder::up;
  std::size_t steps_left = SIZE_MAX;  // bytes written or erased until power fails
  std::size_t steps = 0;
  std::size_t writes_until_failure = SIZE_MAX;
  std::size_t unreadable = SIZE_MAX;  // sector
  std::uint8_t stuck_bits = 0;        // bits that cannot be programmed
  bool fail_reads = false;
  bool fail_erases = false;
  bool powered = true;

 private:
  bool step() {
    ++steps;
    powered = steps_left-- != 0;
    return powered;
  }
  void scramble(std::size_t start) {
    for (std::size_t i = 0; i < kBytes; ++i)
      memory[start + i] = static_cast<std::uint8_t>(random());
  }
};

struct Record {
  Bytes parameters;
  Bytes image;
  bool operator==(const Record& o) const { return parameters == o.parameters && image == o.image; }
};

Record make_record(std::size_t parameters_size, std::size_t image_size, unsigned seed) {
  std::mt19937 random{seed};  // NOLINT(cert-msc51-cpp): the same bytes every time
  Record record{Bytes(parameters_size), Bytes(image_size)};
  for (std::uint8_t& byte : record.parameters)
    byte = static_cast<std::uint8_t>(random());
  for (std::uint8_t& byte : record.image)
    byte = static_cast<std::uint8_t>(random());
  return record;
}

template <class Flash>
StoreResult save(Flash& flash, const Record& record) {
  return RecordStore<Flash>(flash).save(record.parameters, record.image);
}

// What a device finds after a restart.
struct Loaded {
  StoreResult result = StoreResult::nothing_stored;
  Record record{};
};

template <class Flash>
Loaded load(Flash& flash) {
  RecordStore<Flash> store(flash);
  Loaded loaded{store.load(), {Bytes(Flash::kSectorBytes), Bytes(Flash::kSectorBytes)}};
  std::size_t parameters = 0;
  std::size_t image = 0;
  const bool found =
      loaded.result == StoreResult::loaded || loaded.result == StoreResult::loaded_older;
  const StoreResult expected = found ? StoreResult::done : StoreResult::nothing_stored;
  EXPECT_EQ(store.read_parameters(loaded.record.parameters, parameters), expected);
  EXPECT_EQ(store.read_image(loaded.record.image, image), expected);
  loaded.record.parameters.resize(parameters);
  loaded.record.image.resize(image);
  return loaded;
}

template <class Flash>
void expect_loads(Flash& flash, StoreResult result, const Record& record) {
  const Loaded loaded = load(flash);
  EXPECT_EQ(loaded.result, result) << sentence(loaded.result);
  EXPECT_TRUE(loaded.record == record);
}

using Small = NorFlash<1024>;

const Record kOld = make_record(100, 300, 11);
const Record kNew = make_record(90, 310, 12);

// Every way to cut a save of `next` over what is in `before`.
template <class Visit>
void cut_everywhere(const Small& before, const Record& next, const Visit& visit) {
  for (const EraseOrder order : {EraseOrder::up, EraseOrder::down, EraseOrder::everywhere}) {
    Small whole = before;
    ASSERT_EQ(save(whole, next), StoreResult::done);
    const std::size_t all = whole.steps - before.steps;
    for (std::size_t cut = 0; cut < all; ++cut) {
      SCOPED_TRACE("power cut at byte " + std::to_string(cut));
      Small flash = before;
      flash.order = order;
      flash.random.seed(static_cast<unsigned>(cut));
      flash.steps_left = cut;
      EXPECT_NE(save(flash, next), StoreResult::done);
      flash.restore_power();
      visit(flash);
    }
  }
}

TEST(RecordStore, HasTheDocumentedLayout) {
  Small flash;
  const std::string check = "123456789";  // its CRC-32 is CBF43926 in every catalogue
  const Record record{Bytes(check.begin(), check.end()), Bytes{0xAB}};
  ASSERT_EQ(save(flash, record), StoreResult::done);
  const Bytes start(flash.memory.begin(), flash.memory.begin() + 20);
  EXPECT_THAT(start, ::testing::ElementsAre('V', 'C', 'R', '1', 1, 0, 0, 0, 9, 0, 0, 0,  //
                                            0x26, 0x39, 0xF4, 0xCB, 1, 0, 0, 0));
  EXPECT_EQ(flash.memory[32], '1');
  EXPECT_EQ(flash.memory[40], '9');
  EXPECT_EQ(flash.memory[64], 0xAB);
}

TEST(RecordStore, ContinuesACrc) {
  for (std::size_t first = 0; first <= 5; ++first) {
    std::string head = "123456789";
    std::string tail = head.substr(first);
    head.resize(first);
    const Bytes a(head.begin(), head.end());
    const Bytes b(tail.begin(), tail.end());
    EXPECT_EQ(crc32(b, crc32(a)), 0xCBF43926U);
  }
}

TEST(RecordStore, ABlankDeviceHasNothingStored) {
  Small flash;
  EXPECT_EQ(load(flash).result, StoreResult::nothing_stored);
}

TEST(RecordStore, ReturnsEverySizeUpToAFullSector) {
  using Large = NorFlash<32768>;
  const std::vector<std::pair<std::size_t, std::size_t>> sizes{
      {0, 0},     {1, 0},     {0, 1},       {2, 3},       {31, 32},   {32, 33},
      {33, 31},   {255, 256}, {256, 257},   {511, 513},   {600, 1},   {600, 31744},
      {0, 32736}, {1, 32704}, {32, 32704},  {33, 32672},  {32736, 0}, {32704, 32},
      {32705, 0}, {700, 509}, {1000, 4096}, {1000, 4097},
  };
  Large flash;
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
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  const std::size_t steps = flash.steps;
  for (const auto& [parameters, image] : std::vector<std::pair<std::size_t, std::size_t>>{
           {0, 993}, {993, 0}, {1, 961}, {961, 1}, {5000, 0}, {0, 5000}})
    EXPECT_EQ(save(flash, make_record(parameters, image, 1)), StoreResult::too_large);
  EXPECT_EQ(flash.steps, steps);
  expect_loads(flash, StoreResult::loaded, kOld);
}

TEST(RecordStore, ReadsItsOwnSaveWithoutLoading) {
  Small flash;
  RecordStore<Small> store(flash);
  Bytes out(1024);
  std::size_t size = 7;
  EXPECT_EQ(store.read_image(out, size), StoreResult::nothing_stored);
  EXPECT_EQ(size, 0U);
  ASSERT_EQ(store.save(kOld.parameters, kOld.image), StoreResult::done);
  EXPECT_EQ(store.record().sequence, 1U);
  ASSERT_EQ(store.read_image(out, size), StoreResult::done);
  out.resize(size);
  EXPECT_EQ(out, kOld.image);
}

TEST(RecordStore, SaysHowLargeABufferMustBe) {
  Small flash;
  RecordStore<Small> store(flash);
  ASSERT_EQ(store.save(kOld.parameters, kOld.image), StoreResult::done);
  Bytes out(299, 0x55);
  std::size_t size = 0;
  EXPECT_EQ(store.read_image(out, size), StoreResult::buffer_too_small);
  EXPECT_EQ(size, 300U);
  EXPECT_EQ(out, Bytes(299, 0x55));
}

TEST(RecordStore, PartsAreCheckedAgainWhenTheyAreRead) {
  Small flash;
  RecordStore<Small> store(flash);
  ASSERT_EQ(store.save(kOld.parameters, kOld.image), StoreResult::done);
  flash.memory[kParametersAt] ^= 1U;
  Bytes out(1024);
  std::size_t size = 0;
  EXPECT_EQ(store.read_parameters(out, size), StoreResult::damaged);
  EXPECT_EQ(store.read_image(out, size), StoreResult::done);
}

TEST(RecordStore, PowerMayFailAtEveryByteOfASave) {
  for (const auto& [parameters, image] : std::vector<std::pair<std::size_t, std::size_t>>{
           {0, 0}, {1, 0}, {0, 1}, {33, 257}, {100, 300}, {480, 512}}) {
    SCOPED_TRACE(std::to_string(parameters) + " and " + std::to_string(image));
    const Record next = make_record(parameters, image, 3);
    Small before;
    ASSERT_EQ(save(before, kNew), StoreResult::done);
    ASSERT_EQ(save(before, kOld), StoreResult::done);
    const Bytes newest(before.memory.begin() + 1024, before.memory.end());
    cut_everywhere(before, next, [&](Small& flash) {
      const Loaded found = load(flash);
      EXPECT_TRUE(found.record == kOld || found.record == next);
      EXPECT_EQ(Bytes(flash.memory.begin() + 1024, flash.memory.end()), newest);
      EXPECT_EQ(save(flash, kNew), StoreResult::done);
      expect_loads(flash, StoreResult::loaded, kNew);
    });
  }
}

TEST(RecordStore, PowerMayFailAtEveryByteOfTheFirstSave) {
  cut_everywhere(Small{}, kOld, [&](Small& flash) {
    const Loaded found = load(flash);
    EXPECT_TRUE(found.record == Record{} || found.record == kOld);
    EXPECT_EQ(save(flash, kNew), StoreResult::done);
    EXPECT_TRUE(load(flash).record == kNew);
    EXPECT_EQ(save(flash, kOld), StoreResult::done);
    expect_loads(flash, StoreResult::loaded, kOld);
  });
}

TEST(RecordStore, AnErasedStoreNeverFallsBackToTheRecordBefore) {
  for (const unsigned saves : {2U, 3U}) {  // the newest in either slot
    Small before;
    for (unsigned i = 1; i < saves; ++i)
      ASSERT_EQ(save(before, kOld), StoreResult::done);
    ASSERT_EQ(save(before, kNew), StoreResult::done);
    for (const EraseOrder order : {EraseOrder::up, EraseOrder::down, EraseOrder::everywhere}) {
      for (std::size_t cut = 0; cut < 2048; ++cut) {
        SCOPED_TRACE("power cut at byte " + std::to_string(cut));
        Small flash = before;
        flash.order = order;
        flash.steps_left = cut;
        EXPECT_NE(RecordStore<Small>(flash).erase_all(), StoreResult::done);
        flash.restore_power();
        const Loaded found = load(flash);
        EXPECT_TRUE(found.record == kNew || found.record == Record{});
        ASSERT_EQ(RecordStore<Small>(flash).erase_all(), StoreResult::done);
        EXPECT_EQ(load(flash).result, StoreResult::nothing_stored);
      }
    }
  }
}

TEST(RecordStore, NoFlippedBitGivesWrongData) {
  Small before;
  ASSERT_EQ(save(before, kOld), StoreResult::done);
  ASSERT_EQ(save(before, kNew), StoreResult::done);
  std::size_t fell_back = 0;
  for (std::size_t at = 1024; at < 2048; ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      SCOPED_TRACE("byte " + std::to_string(at) + " bit " + std::to_string(bit));
      Small flash = before;
      flash.memory[at] ^= static_cast<std::uint8_t>(1U << bit);
      const Loaded found = load(flash);
      const bool older = found.result == StoreResult::loaded_older;
      EXPECT_TRUE(older || found.result == StoreResult::loaded);
      EXPECT_TRUE(found.record == (older ? kOld : kNew));
      fell_back += older ? 1U : 0U;
    }
  }
  EXPECT_EQ(fell_back, 8 * (kRecordHeaderBytes + 90 + 310)) << "every bit of the record counts";
}

TEST(RecordStore, DamageToTheOlderRecordIsNoLoss) {
  Small flash;
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  ASSERT_EQ(save(flash, kNew), StoreResult::done);
  flash.memory[kParametersAt] ^= 1U;
  expect_loads(flash, StoreResult::loaded, kNew);
}

TEST(RecordStore, DamageToBothIsSaidAndCanBeSavedOver) {
  Small flash;
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  ASSERT_EQ(save(flash, kNew), StoreResult::done);
  flash.memory[0] ^= 1U;
  flash.memory[1024 + kParametersAt] ^= 1U;
  EXPECT_EQ(load(flash).result, StoreResult::damaged);
  EXPECT_EQ(save(flash, kNew), StoreResult::done);
  EXPECT_TRUE(load(flash).record == kNew);
}

TEST(RecordStore, ADamagedNewestRecordIsReplacedAndTheOlderKept) {
  Small flash;
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  flash.memory[1024 + kParametersAt] ^= 1U;
  const Bytes older(flash.memory.begin(), flash.memory.begin() + 1024);
  ASSERT_EQ(save(flash, kNew), StoreResult::done);
  EXPECT_EQ(Bytes(flash.memory.begin(), flash.memory.begin() + 1024), older);
  expect_loads(flash, StoreResult::loaded, kNew);
}

TEST(RecordStore, SizesBeyondTheSectorAreNotBelieved) {
  for (const RecordPart huge : {RecordPart{993, 0}, RecordPart{UINT32_MAX, 0}}) {
    const auto a = encode_record_header({1, huge, {}});
    const auto b = encode_record_header({1, {}, huge});
    EXPECT_EQ(decode_record_header(a, 1024).state, SlotState::headless);
    EXPECT_EQ(decode_record_header(b, 1024).state, SlotState::headless);
  }
}

TEST(RecordStore, TheSequenceNumberWraps) {
  Small flash;
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  RecordHeaderBytes bytes{};
  std::copy_n(flash.memory.begin(), bytes.size(), bytes.begin());
  RecordHeader header = decode_record_header(bytes, 1024).header;
  header.sequence = UINT32_MAX - 1;
  bytes = encode_record_header(header);
  std::copy_n(bytes.begin(), bytes.size(), flash.memory.begin());
  for (unsigned i = 0; i < 4; ++i) {
    const Record record = make_record(10 + i, 20, i);
    ASSERT_EQ(save(flash, record), StoreResult::done);
    RecordStore<Small> store(flash);
    EXPECT_EQ(store.load(), StoreResult::loaded);
    EXPECT_EQ(store.record().sequence, UINT32_MAX + i);
    expect_loads(flash, StoreResult::loaded, record);
  }
}

class FailingDevice : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(save(flash, kOld), StoreResult::done); }

  // As soon as the device works again, so does the store.
  void TearDown() override {
    expect_loads(flash, StoreResult::loaded, kOld);
    EXPECT_EQ(save(flash, kNew), StoreResult::done);
    expect_loads(flash, StoreResult::loaded, kNew);
  }

  Small flash;
};

TEST_F(FailingDevice, Erasing) {
  flash.fail_erases = true;
  EXPECT_EQ(save(flash, kNew), StoreResult::erase_failed);
  EXPECT_EQ(RecordStore<Small>(flash).erase_all(), StoreResult::erase_failed);
  flash.fail_erases = false;
}

TEST_F(FailingDevice, Writing) {
  for (const std::size_t good : {0U, 1U, 2U}) {  // parameters, image, header
    flash.writes_until_failure = good;
    EXPECT_EQ(save(flash, kNew), StoreResult::write_failed);
    expect_loads(flash, StoreResult::loaded, kOld);
  }
  flash.writes_until_failure = SIZE_MAX;
}

TEST_F(FailingDevice, Reading) {
  const std::size_t steps = flash.steps;
  flash.fail_reads = true;
  EXPECT_EQ(load(flash).result, StoreResult::read_failed);
  EXPECT_EQ(save(flash, kNew), StoreResult::read_failed);
  EXPECT_EQ(flash.steps, steps) << "nothing is erased that cannot be read";
  flash.fail_reads = false;
}

TEST_F(FailingDevice, ABitThatCannotBeProgrammed) {
  flash.stuck_bits = 0x10;
  EXPECT_EQ(save(flash, kNew), StoreResult::verify_failed);
  expect_loads(flash, StoreResult::loaded, kOld);  // no header was written
  EXPECT_EQ(save(flash, Record{}), StoreResult::verify_failed) << "in the header";
  expect_loads(flash, StoreResult::loaded_older, kOld);
  flash.stuck_bits = 0;
  EXPECT_EQ(save(flash, kOld), StoreResult::done);
}

TEST(RecordStore, AnUnreadableSlotIsReplacedWhenTheOtherIsIntact) {
  Small flash;
  ASSERT_EQ(save(flash, kOld), StoreResult::done);
  ASSERT_EQ(save(flash, kNew), StoreResult::done);
  flash.unreadable = 1;
  expect_loads(flash, StoreResult::loaded_older, kOld);
  EXPECT_EQ(save(flash, kOld), StoreResult::read_failed) << "it cannot be verified";
  flash.unreadable = SIZE_MAX;
  EXPECT_TRUE(load(flash).record == kOld);
}

TEST(RecordStore, AnUnreadableRecordIsErasedOnlyAfterItsSuccessorIsComplete) {
  Small before;
  for (int i = 0; i < 3; ++i)
    ASSERT_EQ(save(before, kOld), StoreResult::done);
  std::fill_n(before.memory.begin() + 1024, 1024, std::uint8_t{0xFF});
  std::fill_n(before.programmed.begin() + 1024, 1024, false);
  before.unreadable = 0;
  Small cut = before;
  cut.steps_left = 1024 + 90 + 310;  // all but the header
  EXPECT_EQ(save(cut, kNew), StoreResult::write_failed);
  cut.restore_power();
  cut.unreadable = SIZE_MAX;
  EXPECT_TRUE(load(cut).record == kOld);

  Small whole = before;
  EXPECT_EQ(save(whole, kNew), StoreResult::done);
  whole.unreadable = SIZE_MAX;
  EXPECT_TRUE(load(whole).record == kNew);
}

TEST(RecordStore, EveryResultHasItsOwnSentence) {
  std::set<std::string> sentences;
  for (std::uint8_t i = 0; i <= 10; ++i)
    sentences.insert(sentence(static_cast<StoreResult>(i)));
  EXPECT_EQ(sentences.size(), 11U);
}

}  // namespace
}  // namespace volcomp::node
