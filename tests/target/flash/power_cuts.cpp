// The processor restarts in the middle of every single flash operation of a save, one per life, and
// finds the old record or the new one afterwards. The host tests the same with every state such a
// failure can leave; here the restart and the memory are those of a board.

#include <array>

#include "firmware/boards/mps2/exit_code.hpp"
#include "firmware/boards/mps2/reset_cause.hpp"
#include "firmware/node/store/record_store.hpp"
#include "hal/mps2/console.hpp"
#include "tests/target/flash/lives.hpp"

namespace {

namespace console = volcomp::hal::mps2::console;
using volcomp::Span;
using volcomp::hal::BlockRead;
using volcomp::hal::mps2::FlashBlocks;
using volcomp::node::RecordStore;
using volcomp::node::StoreResult;

// The flash of the board, with a restart in the middle of one operation: half of the unit or sector
// is done.
class Interrupted {
 public:
  static constexpr std::size_t kUnitBytes = FlashBlocks::kUnitBytes;
  static constexpr std::size_t kSectorBytes = FlashBlocks::kSectorBytes;
  static constexpr std::size_t kSectors = FlashBlocks::kSectors;

  Interrupted(FlashBlocks& flash, std::uint32_t operation)
      : flash_(flash), operations_left_(operation) {}

  BlockRead read(std::size_t at, Span<std::uint8_t> out) { return flash_.read(at, out); }

  bool program(std::size_t at, Span<const std::uint8_t> bytes) {
    for (std::size_t i = 0; i < bytes.size(); i += kUnitBytes) {
      if (operations_left_-- == 0) {
        std::copy_n(&bytes[i], kUnitBytes / 2, &volcomp::test::flash_memory()[at + i]);
        volcomp::boards::restart();
      }
      if (!flash_.program(at + i, {&bytes[i], kUnitBytes})) return false;
    }
    return true;
  }

  bool erase(std::size_t sector) {
    if (operations_left_-- != 0) return flash_.erase(sector);
    std::fill_n(&volcomp::test::flash_memory()[sector * kSectorBytes], kSectorBytes / 2,
                volcomp::hal::kErasedByte);
    volcomp::boards::restart();
  }

 private:
  FlashBlocks& flash_;
  std::uint32_t operations_left_;
};

constexpr std::size_t kParameterBytes = 100;
constexpr std::size_t kImageBytes = 1000;
// The sector, four units of parameters, 32 of image, header and seal.
constexpr std::uint32_t kOperations = 1 + 4 + 32 + 2;

using Parameters = std::array<std::uint8_t, kParameterBytes>;
using Image = std::array<std::uint8_t, kImageBytes>;

struct Record {
  Parameters parameters{};
  Image image{};
};

Record make_record(std::uint8_t seed) {
  Record record;
  for (std::size_t i = 0; i < kParameterBytes; ++i)
    record.parameters[i] = static_cast<std::uint8_t>(seed + 3 * i);
  for (std::size_t i = 0; i < kImageBytes; ++i)
    record.image[i] = static_cast<std::uint8_t>(seed + 7 * i);
  return record;
}

template <class Blocks>
bool save(Blocks& blocks, const Record& record) {
  return RecordStore<Blocks>(blocks).save(record.parameters, record.image) == StoreResult::done;
}

bool finds(FlashBlocks& flash, const Record& record, StoreResult how) {
  Record found;
  std::size_t parameters = 0;
  std::size_t image = 0;
  RecordStore<FlashBlocks> store(flash);
  return store.load() == how &&
         store.read_parameters(found.parameters, parameters) == StoreResult::done &&
         store.read_image(found.image, image) == StoreResult::done &&
         parameters == kParameterBytes && image == kImageBytes &&
         found.parameters == record.parameters && found.image == record.image;
}

// After the cut of the life before: which record is there, and does it match its mark?
bool judge(FlashBlocks& flash, volcomp::test::Lives& lives, const Record& old_record,
           const Record& new_record) {
  const bool sector_cut = lives.number() == 2;  // nothing programmed yet
  if (finds(flash, new_record, StoreResult::loaded)) {
    lives.count_new();
    return true;
  }
  lives.count_old();
  return finds(flash, old_record, StoreResult::loaded_older) ||
         (sector_cut && finds(flash, old_record, StoreResult::loaded));
}

int complain(const char* what, std::uint32_t life) {
  console::put(what);
  console::put(" in life ");
  console::put_unsigned(life);
  console::put("\n");
  return volcomp::boards::kCheckFailed;
}

}  // namespace

int main() {
  volcomp::test::Lives lives;
  const Record old_record = make_record(1);
  const Record new_record = make_record(2);
  FlashBlocks flash;
  if (!flash.attach(volcomp::test::flash_memory())) return complain("no flash", lives.number());
  if (lives.number() > 1 && !judge(flash, lives, old_record, new_record))
    return complain("neither the old record nor the new one", lives.number());
  if (!save(flash, old_record)) return complain("nothing can be saved", lives.number());

  Interrupted interrupted(flash, lives.number() - 1);
  if (!save(interrupted, new_record)) return complain("nothing can be saved", lives.number());
  console::put("restarts in the middle of a flash operation: ");
  console::put_unsigned(lives.number() - 1);
  console::put("\nthe old record afterwards:                   ");
  console::put_unsigned(lives.found_old());
  console::put("\nthe new record afterwards:                   ");
  console::put_unsigned(lives.found_new());
  console::put("\n");
  // Only the seal can be cut with the new record already complete.
  const bool all = lives.number() - 1 == kOperations && lives.found_new() == 1 &&
                   lives.found_old() == kOperations - 1;
  return all ? volcomp::boards::kFine : volcomp::boards::kCheckFailed;
}
