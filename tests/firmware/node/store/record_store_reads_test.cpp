// A memory whose reads fail now and then: what is loaded is what was saved, or is reported not to
// be.

#include "firmware/node/store/record_storage.hpp"
#include "tests/firmware/node/store/record_store_support.hpp"

namespace volcomp::node {
namespace {

// Memory of which one read goes wrong, once.
class UnsteadyBlocks {
 public:
  using Memory = test::MemoryBlocks<1024, 2>;
  static constexpr std::size_t kUnitBytes = Memory::kUnitBytes;
  static constexpr std::size_t kSectorBytes = Memory::kSectorBytes;
  static constexpr std::size_t kSectors = Memory::kSectors;

  // Read number n from now, 0 the next.
  void fail_read(int n, hal::BlockRead how) {
    left_ = n;
    how_ = how;
  }
  // Whether that read has come.
  [[nodiscard]] bool failed() const { return left_ < 0; }
  void stick(bool erases) { erases_stick_ = erases; }

  hal::BlockRead read(std::size_t at, Span<std::uint8_t> out) {
    return left_-- == 0 ? how_ : memory_.read(at, out);
  }
  bool program(std::size_t at, Span<const std::uint8_t> bytes) {
    return memory_.program(at, bytes);
  }
  bool erase(std::size_t sector) { return erases_stick_ || memory_.erase(sector); }

 private:
  Memory memory_;
  int left_ = -1;
  hal::BlockRead how_ = hal::BlockRead::done;
  bool erases_stick_ = false;
};

const Record kBefore = make_record(100, 300, 21);
const Record kAfter = make_record(90, 310, 22);

StoreResult save_record(RecordStorage<UnsteadyBlocks>& storage, const Record& record) {
  return storage.save({record.parameters.data(), record.parameters.size()},
                      {record.image.data(), record.image.size()});
}

class UnsteadyReads : public ::testing::TestWithParam<hal::BlockRead> {
 protected:
  Record loaded(StoreResult& found) {
    Record record{Bytes(512), Bytes(512)};
    Span<std::uint8_t> parameters{record.parameters.data(), record.parameters.size()};
    Span<std::uint8_t> image{record.image.data(), record.image.size()};
    found = storage.load(parameters, image);
    record.parameters.resize(parameters.size());
    record.image.resize(image.size());
    return record;
  }
  static bool is_good(StoreResult found) {
    return found == StoreResult::loaded || found == StoreResult::loaded_older;
  }

  UnsteadyBlocks blocks;
  RecordStorage<UnsteadyBlocks> storage{blocks};
};

TEST_P(UnsteadyReads, WhileLoadingGiveARecordOrAReason) {
  ASSERT_EQ(save_record(storage, kBefore), StoreResult::done);
  ASSERT_EQ(save_record(storage, kAfter), StoreResult::done);
  int reasons = 0;
  for (int n = 0;; ++n) {
    blocks.fail_read(n, GetParam());
    StoreResult found{};
    const Record record = loaded(found);
    if (!blocks.failed()) break;
    if (is_good(found)) {
      EXPECT_TRUE(record == kAfter || record == kBefore) << n;
    } else {
      ++reasons;
    }
    EXPECT_TRUE(loaded(found) == kAfter) << n << ": nothing is lost by it";
  }
  EXPECT_GT(reasons, 0);
}

TEST_P(UnsteadyReads, WhileSavingLoseNothing) {
  for (int n = 0;; ++n) {
    UnsteadyBlocks fresh;
    blocks = fresh;
    RecordStorage<UnsteadyBlocks> writer{blocks};
    ASSERT_EQ(save_record(writer, kBefore), StoreResult::done);
    blocks.fail_read(n, GetParam());
    const StoreResult saved = save_record(writer, kAfter);
    if (!blocks.failed()) break;
    blocks.fail_read(-1, GetParam());
    StoreResult found{};
    const Record record = loaded(found);
    ASSERT_TRUE(is_good(found)) << n;
    EXPECT_TRUE(record == kAfter || (saved != StoreResult::done && record == kBefore)) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(How, UnsteadyReads,
                         ::testing::Values(hal::BlockRead::failed, hal::BlockRead::uncorrectable));

// A chip that reports an erase it has not done.
TEST(UnsteadyErase, ThatLeavesSomethingIsNoErase) {
  UnsteadyBlocks blocks;
  RecordStorage<UnsteadyBlocks> storage{blocks};
  ASSERT_EQ(save_record(storage, kBefore), StoreResult::done);
  blocks.stick(true);
  EXPECT_EQ(storage.erase(), StoreResult::verify_failed);
  blocks.stick(false);
  EXPECT_EQ(storage.erase(), StoreResult::done);
}

}  // namespace
}  // namespace volcomp::node
