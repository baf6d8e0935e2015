#include "firmware/node/record_store.hpp"

#include <algorithm>

#include "firmware/canopen/bytes.hpp"

namespace volcomp::node {
namespace {

constexpr std::uint32_t kMagic = 0x31524356;  // "VCR1"
constexpr std::size_t kHeaderCrcAt = kRecordHeaderBytes - 4;

std::uint32_t load_u32(const RecordHeaderBytes& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(canopen::load_le(bytes.data() + at, 4));
}

bool is_blank(const RecordHeaderBytes& bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0xFF; });
}

// RFC 1982: half of the numbers are ahead of any other.
bool is_newer(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t ahead = a - b;
  return ahead != 0 && ahead < 0x8000'0000U;
}

bool any(const Slots& slots, SlotState state) {
  return slots[0].state == state || slots[1].state == state;
}

// A slot without its header gets no benefit of the doubt: that may have been the newest record.
bool cannot_be_newer(const Slot& slot, const Slot& newest) {
  if (slot.state == SlotState::blank || slot.state == SlotState::valid) return true;
  return slot.state == SlotState::damaged &&
         !is_newer(slot.header.sequence, newest.header.sequence);
}

StoreResult why_none(const Slots& slots) {
  if (any(slots, SlotState::unreadable)) return StoreResult::read_failed;
  if (any(slots, SlotState::headless) || any(slots, SlotState::damaged))
    return StoreResult::damaged;
  return StoreResult::nothing_stored;
}

}  // namespace

const char* sentence(StoreResult result) {
  switch (result) {
    case StoreResult::nothing_stored:
      return "Nothing is stored.";
    case StoreResult::loaded:
      return "The newest record was found intact.";
    case StoreResult::loaded_older:
      return "The last save was cut short or its record is damaged; the one before is used.";
    case StoreResult::damaged:
      return "What is stored is damaged and cannot be used.";
    case StoreResult::done:
      return "Done.";
    case StoreResult::too_large:
      return "The record does not fit a sector.";
    case StoreResult::buffer_too_small:
      return "The buffer is smaller than what is stored.";
    case StoreResult::read_failed:
      return "The memory reported a failure while reading.";
    case StoreResult::erase_failed:
      return "The memory reported a failure while erasing.";
    case StoreResult::write_failed:
      return "The memory reported a failure while writing.";
    case StoreResult::verify_failed:
      return "The memory does not hold what was written to it.";
  }
  return "Unknown result.";
}

RecordHeaderBytes encode_record_header(const RecordHeader& header) {
  const std::array<std::uint32_t, 6> fields{kMagic,
                                            header.sequence,
                                            header.parameters.size,
                                            header.parameters.crc,
                                            header.image.size,
                                            header.image.crc};
  RecordHeaderBytes bytes{};
  for (std::size_t i = 0; i < fields.size(); ++i)
    canopen::store_le(bytes.data() + 4 * i, 4, fields[i]);
  canopen::store_le(bytes.data() + kHeaderCrcAt, 4, crc32({bytes.data(), kHeaderCrcAt}));
  return bytes;
}

Slot decode_record_header(const RecordHeaderBytes& bytes, std::size_t sector_bytes) {
  if (is_blank(bytes)) return {SlotState::blank, {}};
  if (load_u32(bytes, 0) != kMagic) return {SlotState::headless, {}};
  if (load_u32(bytes, kHeaderCrcAt) != crc32({bytes.data(), kHeaderCrcAt}))
    return {SlotState::headless, {}};
  const RecordHeader header{load_u32(bytes, 4),
                            {load_u32(bytes, 8), load_u32(bytes, 12)},
                            {load_u32(bytes, 16), load_u32(bytes, 20)}};
  if (!record_fits(header.parameters.size, header.image.size, sector_bytes))
    return {SlotState::headless, {}};
  return {SlotState::valid, header};
}

std::size_t newest_valid(const Slots& slots) {
  const bool first = slots[0].state == SlotState::valid;
  const bool second = slots[1].state == SlotState::valid;
  if (!first && !second) return kNoSlot;
  if (!first) return 1;
  return second && is_newer(slots[1].header.sequence, slots[0].header.sequence) ? 1 : 0;
}

StoreResult verdict(const Slots& slots) {
  const std::size_t newest = newest_valid(slots);
  if (newest == kNoSlot) return why_none(slots);
  return cannot_be_newer(slots[1 - newest], slots[newest]) ? StoreResult::loaded
                                                           : StoreResult::loaded_older;
}

}  // namespace volcomp::node
