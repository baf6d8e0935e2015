// Power fails at every single flash operation of 1010h and 1011h of a node with tables: the node
// that starts afterwards has the old parameters and tables or the new ones, never some of each,
// reports which, and can save again.

#include "firmware/node/store/record_storage.hpp"
#include "tests/firmware/node/node_bench.hpp"
#include "tests/hal/memory_blocks.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using test::Torn;

using Blocks = test::MemoryBlocks<16384, 2>;

// What a node starts with.
struct Content {
  std::uint64_t period_us = 0;
  std::uint64_t table_crc = 0;
  bool operator==(const Content& o) const {
    return period_us == o.period_us && table_crc == o.table_crc;
  }
};

class NodePowerFailure : public ::testing::Test {
 protected:
  static Content content(NodeBench& bench) {
    return {bench.number(0x1006, 0), bench.number(0x2112, 7)};
  }
  static AbortCode save(NodeBench& bench) { return bench.set<std::uint32_t>(0x1010, 1, kSave); }
  static AbortCode restore(NodeBench& bench) { return bench.set<std::uint32_t>(0x1011, 1, kLoad); }
  static void take(NodeBench& bench, std::uint32_t period_us, std::uint64_t tables) {
    ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, period_us), AbortCode::none);
    bench.load(bench_tables(tables));
  }

  // Cuts `act` short on a device that holds `before`, everywhere and in every way, and shows what a
  // node finds afterwards.
  template <class Act, class Visit>
  void cut_everywhere(const Blocks& before, const Act& act, const Visit& visit) {
    *blocks = before;
    ASSERT_EQ(act(writer), AbortCode::none);
    const std::size_t all = blocks->operations() - before.operations();
    for (std::size_t at = 0; at < all; ++at) {
      for (const Torn torn : test::kEveryTorn) {
        SCOPED_TRACE("power cut at operation " + std::to_string(at) + " of " + std::to_string(all) +
                     ", state " + std::to_string(static_cast<int>(torn)));
        *blocks = before;
        blocks->cut_power_at(at, torn);
        ASSERT_EQ(act(writer), AbortCode::hardware);
        blocks->power_on();
        NodeBench reader(&storage);
        visit(reader);
        ASSERT_EQ(save(reader), AbortCode::none);
        const Content saved = content(reader);
        reader.power_on();
        EXPECT_TRUE(content(reader) == saved);
        EXPECT_EQ(reader.number(0x2600, 11), 1U);
        EXPECT_EQ(blocks->misuses(), 0U);
      }
    }
  }

  std::unique_ptr<Blocks> blocks = std::make_unique<Blocks>();
  RecordStorage<Blocks> storage{*blocks};
  NodeBench writer{&storage};
};

TEST_F(NodePowerFailure, ASaveLeavesTheOldParametersAndTablesOrTheNew) {
  take(writer, 3000, 0);
  ASSERT_EQ(save(writer), AbortCode::none);
  take(writer, 4000, 1);
  ASSERT_EQ(save(writer), AbortCode::none);
  const Content old = content(writer);
  take(writer, 5000, 2);
  const Content wanted = content(writer);
  ASSERT_NE(old.table_crc, wanted.table_crc);

  cut_everywhere(*blocks, save, [&](NodeBench& reader) {
    const Content found = content(reader);
    EXPECT_TRUE(found == old || found == wanted);
    EXPECT_EQ(reader.number(0x2112, 1), static_cast<std::uint8_t>(TableState::active));
    const std::uint64_t says = reader.number(0x2600, 11);
    EXPECT_TRUE(says == 1 || (says == 2 && found == old));
    reader.wait(20'000);
    EXPECT_EQ(reader.emergency(ErrorCode::parameters_lost, 2), says == 2);
  });
}

TEST_F(NodePowerFailure, TheFirstSaveLeavesTheDefaultsOrEverything) {
  const Blocks blank;
  take(writer, 5000, 2);
  const Content wanted = content(writer);
  cut_everywhere(blank, save, [&](NodeBench& reader) {
    const Content found = content(reader);
    const std::uint64_t says = reader.number(0x2600, 11);
    const bool everything = found == wanted && says == 1;
    const bool defaults = found == Content{} && (says == 0 || says == 3);
    EXPECT_TRUE(everything || defaults) << says;
    const TableState state = everything ? TableState::active : TableState::empty;
    EXPECT_EQ(reader.number(0x2112, 1), static_cast<std::uint8_t>(state));
  });
}

TEST_F(NodePowerFailure, ARestoreLeavesTheNewestOrTheDefaults) {
  take(writer, 4000, 1);
  ASSERT_EQ(save(writer), AbortCode::none);
  take(writer, 5000, 2);
  ASSERT_EQ(save(writer), AbortCode::none);
  const Content newest = content(writer);
  cut_everywhere(*blocks, restore, [&](NodeBench& reader) {
    const Content found = content(reader);
    EXPECT_TRUE(found == newest || found == Content{});
  });
}

// Every bit of a stored table, on the way through the node.
TEST_F(NodePowerFailure, EveryFlippedBitOfTheNewestRecordGivesTheOlderTables) {
  take(writer, 4000, 1);
  ASSERT_EQ(save(writer), AbortCode::none);
  const Content old = content(writer);
  take(writer, 5000, 2);
  ASSERT_EQ(save(writer), AbortCode::none);
  const Blocks before = *blocks;
  RecordStore<Blocks> store(*blocks);
  ASSERT_EQ(store.load(), StoreResult::loaded);
  const RecordHeader record = store.record();
  const std::size_t image = image_at(record.parameters.size);
  for (std::size_t at = 0; at < image + record.image.size; at = at == 31 ? kParametersAt : at + 1) {
    const bool padding = at >= kParametersAt + record.parameters.size && at < image;
    if (padding) continue;
    *blocks = before;
    blocks->flip(Blocks::kSectorBytes + at, static_cast<std::uint8_t>(1U << at % 8));
    writer.power_on();
    ASSERT_TRUE(content(writer) == old) << at;
    ASSERT_EQ(writer.number(0x2600, 11), 2U) << at;
  }
}

}  // namespace
}  // namespace volcomp::node
