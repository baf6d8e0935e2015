#include "firmware/node/store/record_layout.hpp"

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"
#include "hal/block_device.hpp"

namespace volcomp::node {
namespace {

constexpr std::uint64_t kMagic = 0x32504D4F434C4F56;  // "VOLCOMP2"
constexpr std::size_t kFieldsAt = 8;
constexpr std::size_t kHeaderCrcAt = kRecordHeaderBytes - 4;

// RFC 1982: half of the numbers are ahead of any other.
bool is_newer(const RecordHeader& a, const RecordHeader& b) {
  const std::uint32_t ahead = a.sequence - b.sequence;
  return ahead != 0 && ahead < 0x8000'0000U;
}

bool any(const Slots& slots, SlotState state) {
  return slots[0].state == state || slots[1].state == state;
}

// A slot without its header gets no benefit of the doubt: that may have been the newest record.
bool cannot_be_newer(const Slot& slot, const Slot& used) {
  if (slot.state == SlotState::blank) return true;
  const bool has_header = slot.state == SlotState::valid || slot.state == SlotState::damaged;
  return has_header && !is_newer(slot.header, used.header);
}

StoreResult why_none(const Slots& slots) {
  if (any(slots, SlotState::unreadable)) return StoreResult::read_failed;
  if (any(slots, SlotState::headless) || any(slots, SlotState::damaged))
    return StoreResult::damaged;
  return StoreResult::nothing_stored;
}

}  // namespace

RecordHeaderBytes encode_record_header(const RecordHeader& header) {
  const std::array<std::uint32_t, 5> fields{header.sequence, header.parameters.size,
                                            header.parameters.crc, header.image.size,
                                            header.image.crc};
  RecordHeaderBytes bytes{};
  store_le(bytes.data(), 8, kMagic);
  for (std::size_t i = 0; i < fields.size(); ++i)
    store_le(bytes.data() + kFieldsAt + 4 * i, 4, fields[i]);
  store_le(bytes.data() + kHeaderCrcAt, 4, crc32c({bytes.data(), kHeaderCrcAt}));
  return bytes;
}

Slot decode_record_header(const RecordHeaderBytes& bytes, std::size_t sector_bytes) {
  if (hal::is_erased(bytes)) return {SlotState::blank, {}, false};
  if (load_le(bytes.data(), 8) != kMagic) return {SlotState::headless, {}, false};
  if (load_u32(&bytes[kHeaderCrcAt]) != crc32c({bytes.data(), kHeaderCrcAt}))
    return {SlotState::headless, {}, false};
  const RecordHeader header{load_u32(&bytes[8]),
                            {load_u32(&bytes[12]), load_u32(&bytes[16])},
                            {load_u32(&bytes[20]), load_u32(&bytes[24])}};
  if (!record_fits(header.parameters.size, header.image.size, sector_bytes))
    return {SlotState::headless, {}, false};
  return {SlotState::valid, header, false};
}

std::size_t record_to_use(const Slots& slots) {
  const bool first = slots[0].state == SlotState::valid;
  const bool second = slots[1].state == SlotState::valid;
  if (!first && !second) return kNoSlot;
  if (first != second) return first ? 0 : 1;
  const std::size_t newest = is_newer(slots[1].header, slots[0].header) ? 1 : 0;
  return slots[newest].sealed ? newest : 1 - newest;
}

StoreResult verdict(const Slots& slots) {
  const std::size_t used = record_to_use(slots);
  if (used == kNoSlot) return why_none(slots);
  return cannot_be_newer(slots[1 - used], slots[used]) ? StoreResult::loaded
                                                       : StoreResult::loaded_older;
}

}  // namespace volcomp::node
