#pragma once
// Settings and tables through a power failure: one record of two parts, kept twice in turn.
//
// Each slot is one sector (0 and 1), little-endian:
//
//     0  magic "VCR1"; the digit is the version of this layout
//     4  sequence number, one more than the record before (RFC 1982 arithmetic: it may wrap)
//     8  size of the parameters, CRC-32 of the parameters
//    16  size of the image, CRC-32 of the image
//    24  CRC-32 of bytes 0…23
//    32  parameters
//     …  image, from the next multiple of 32
//
// Why so:
//   - Two slots: a save erases only the slot that does not hold the newest valid record. Wherever
//     power fails, that record is still there, and both parts always come from the same save.
//   - Header last, after the parts were read back: without it the slot holds no record, so an
//     intact header means that the save got to its end.
//   - A CRC of its own for the header, so that its sizes are never trusted unchecked; one for each
//     part, so that a part is checked in the memory it was read into.
//   - Parts at multiples of 32 bytes: flash is programmed in units of up to 256 bits, and a unit
//   can
//     be programmed only once after an erase.
//   - Nothing is remembered between calls that flash could contradict: every save looks again.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/span.hpp"
#include "comp/tables/crc32.hpp"
#include "hal/block_device.hpp"

namespace volcomp::node {

// What load() can say has the values 0…3 that a node reports about its start.
enum class [[nodiscard]] StoreResult : std::uint8_t{
    nothing_stored = 0, loaded = 1,
    loaded_older = 2,  // beside it is what may have been a newer record
    damaged = 3,       // there was something, none of it can be used
    done = 4,          // saved, read or erased as asked
    too_large = 5,      buffer_too_small = 6, read_failed = 7, erase_failed = 8, write_failed = 9,
    verify_failed = 10,  // what was read back is not what was written
};

// One plain sentence for a person.
[[nodiscard]] const char* sentence(StoreResult result);

struct RecordPart {
  std::uint32_t size = 0;  // bytes
  std::uint32_t crc = 0;   // CRC-32
};

struct RecordHeader {
  std::uint32_t sequence = 0;
  RecordPart parameters{};
  RecordPart image{};
};

inline constexpr std::size_t kRecordHeaderBytes = 28;
inline constexpr std::size_t kParametersAt = 32;  // in the slot, as is image_at()

constexpr std::size_t image_at(std::size_t parameters_size) {
  return kParametersAt + (parameters_size + 31) / 32 * 32;
}

// Whether parts of these sizes fit a sector, whose size is a multiple of 32.
constexpr bool record_fits(std::size_t parameters_size, std::size_t image_size,
                           std::size_t sector_bytes) {
  return parameters_size <= sector_bytes - kParametersAt &&
         image_size <= sector_bytes - image_at(parameters_size);
}

enum class SlotState : std::uint8_t {
  blank,       // erased, or a save got no further than the parts
  headless,    // a header was begun, erased halfway or hit
  damaged,     // the header is intact, a part is not
  unreadable,  // the device reported a failure
  valid,
};

struct Slot {
  SlotState state = SlotState::blank;
  RecordHeader header{};  // where the state is damaged or valid
};

using Slots = std::array<Slot, 2>;
inline constexpr std::size_t kNoSlot = 2;

using RecordHeaderBytes = std::array<std::uint8_t, kRecordHeaderBytes>;
[[nodiscard]] RecordHeaderBytes encode_record_header(const RecordHeader& header);
// valid, blank or headless; headless also when the record does not fit the sector.
[[nodiscard]] Slot decode_record_header(const RecordHeaderBytes& bytes, std::size_t sector_bytes);

// 0, 1 or kNoSlot.
[[nodiscard]] std::size_t newest_valid(const Slots& slots);
// What load() says about slots in these states.
StoreResult verdict(const Slots& slots);

// All calls block for as long as the device does and belong to the background. Stack: below 1 KiB
// besides the device's own. One store per device, no calls from two contexts.
template <class Blocks>
class RecordStore {
  static_assert(hal::IsBlockDevice<Blocks>::value);
  static_assert(Blocks::kSectors >= 2);
  static_assert(Blocks::kSectorBytes > kParametersAt && Blocks::kSectorBytes % 32 == 0);

 public:
  explicit RecordStore(Blocks& blocks) : blocks_(blocks) {}

  // Finds the newest intact record for the calls below: loaded, loaded_older, nothing_stored,
  // damaged, or read_failed when there is none but a slot could not be read. Reads up to both
  // slots.
  StoreResult load() {
    const Slots slots = inspect();
    hold(slots);
    return verdict(slots);
  }

  // The parts of the record that load() found or save() wrote: done, nothing_stored, read_failed,
  // buffer_too_small (nothing is read, `size` says what is needed) or damaged (since load(); `out`
  // holds bytes not to be used).
  StoreResult read_parameters(Span<std::uint8_t> out, std::size_t& size) {
    return read_part(kParametersAt, header_.parameters, out, size);
  }
  StoreResult read_image(Span<std::uint8_t> out, std::size_t& size) {
    return read_part(image_at(header_.parameters.size), header_.image, out, size);
  }

  // Both parts, or what was stored before stays: done; too_large or, if no slot could be read,
  // read_failed with nothing touched; otherwise the step that failed. Then load() finds the record
  // before, or the new one if only its confirmation failed, and save() can be called again.
  StoreResult save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) {
    if (!record_fits(parameters.size(), image.size(), Blocks::kSectorBytes))
      return StoreResult::too_large;
    const Slots slots = inspect();
    hold(slots);
    if (all_unreadable(slots)) return StoreResult::read_failed;
    const std::size_t target = slot_to_replace(slots);
    const RecordHeader header{header_.sequence + 1, describe(parameters), describe(image)};
    if (const StoreResult r = replace(target, header, parameters, image); r != StoreResult::done)
      return r;
    held_ = target;
    header_ = header;
    return retire(1 - target, slots);
  }

  // Both slots, the older first: cut short, it never brings back the record before the newest.
  // done, erase_failed or verify_failed. Also the way out when neither slot can be read.
  StoreResult erase_all() {
    const std::size_t first = newest_valid(inspect()) == 0 ? 1 : 0;
    held_ = kNoSlot;
    header_ = {};
    if (!blocks_.erase(first) || !blocks_.erase(1 - first)) return StoreResult::erase_failed;
    return verdict(inspect()) == StoreResult::nothing_stored ? StoreResult::done
                                                             : StoreResult::verify_failed;
  }

  // Sequence number and sizes of that record; zeros if there is none.
  [[nodiscard]] const RecordHeader& record() const { return header_; }

 private:
  static constexpr std::size_t kChunkBytes = 256;

  static std::size_t start_of(std::size_t slot) { return slot * Blocks::kSectorBytes; }

  static RecordPart describe(Span<const std::uint8_t> part) {
    return {static_cast<std::uint32_t>(part.size()), crc32(part)};
  }

  static bool all_unreadable(const Slots& slots) {
    return slots[0].state == SlotState::unreadable && slots[1].state == SlotState::unreadable;
  }

  // Without a valid record, what cannot be read right now may be one.
  [[nodiscard]] std::size_t slot_to_replace(const Slots& slots) const {
    if (held_ != kNoSlot) return 1 - held_;
    return slots[0].state == SlotState::unreadable ? 1 : 0;
  }

  void hold(const Slots& slots) {
    held_ = newest_valid(slots);
    header_ = held_ != kNoSlot ? slots[held_].header : RecordHeader{};
  }

  Slots inspect() { return {inspect(0), inspect(1)}; }

  Slot inspect(std::size_t slot) {
    RecordHeaderBytes bytes{};
    if (!blocks_.read(start_of(slot), bytes)) return {SlotState::unreadable, {}};
    Slot found = decode_record_header(bytes, Blocks::kSectorBytes);
    const RecordHeader& header = found.header;
    if (found.state == SlotState::valid)
      found.state = part_state(start_of(slot) + kParametersAt, header.parameters);
    if (found.state == SlotState::valid)
      found.state = part_state(start_of(slot) + image_at(header.parameters.size), header.image);
    return found;
  }

  // valid, damaged or unreadable.
  SlotState part_state(std::size_t at, const RecordPart& part) {
    std::array<std::uint8_t, kChunkBytes> buffer{};
    std::uint32_t crc = 0;
    for (std::size_t done = 0; done < part.size; done += kChunkBytes) {
      const std::size_t rest = part.size - done;
      const Span<std::uint8_t> chunk{buffer.data(), rest < kChunkBytes ? rest : kChunkBytes};
      if (!blocks_.read(at + done, chunk)) return SlotState::unreadable;
      crc = crc32({chunk.data(), chunk.size()}, crc);
    }
    return crc == part.crc ? SlotState::valid : SlotState::damaged;
  }

  StoreResult read_part(std::size_t at, const RecordPart& part, Span<std::uint8_t> out,
                        std::size_t& size) {
    size = part.size;
    if (held_ == kNoSlot) return StoreResult::nothing_stored;
    if (out.size() < size) return StoreResult::buffer_too_small;
    const Span<std::uint8_t> bytes{out.data(), size};
    if (size != 0 && !blocks_.read(start_of(held_) + at, bytes)) return StoreResult::read_failed;
    return crc32({bytes.data(), size}) == part.crc ? StoreResult::done : StoreResult::damaged;
  }

  StoreResult replace(std::size_t slot, const RecordHeader& header,
                      Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) {
    const std::size_t start = start_of(slot);
    if (!blocks_.erase(slot)) return StoreResult::erase_failed;
    if (const StoreResult r = write_part(start + kParametersAt, parameters, header.parameters);
        r != StoreResult::done)
      return r;
    if (const StoreResult r = write_part(start + image_at(parameters.size()), image, header.image);
        r != StoreResult::done)
      return r;
    return write_header(start, header);
  }

  StoreResult write_part(std::size_t at, Span<const std::uint8_t> bytes, const RecordPart& part) {
    if (!bytes.empty() && !blocks_.write(at, bytes)) return StoreResult::write_failed;
    const SlotState state = part_state(at, part);
    if (state == SlotState::unreadable) return StoreResult::read_failed;
    return state == SlotState::valid ? StoreResult::done : StoreResult::verify_failed;
  }

  StoreResult write_header(std::size_t at, const RecordHeader& header) {
    const RecordHeaderBytes bytes = encode_record_header(header);
    if (!blocks_.write(at, bytes)) return StoreResult::write_failed;
    RecordHeaderBytes stored{};
    if (!blocks_.read(at, stored)) return StoreResult::read_failed;
    return stored == bytes ? StoreResult::done : StoreResult::verify_failed;
  }

  // A slot that could not be read must not come back one day with a higher sequence number.
  StoreResult retire(std::size_t slot, const Slots& slots) {
    if (slots[slot].state != SlotState::unreadable) return StoreResult::done;
    return blocks_.erase(slot) ? StoreResult::done : StoreResult::erase_failed;
  }

  Blocks& blocks_;
  std::size_t held_ = kNoSlot;  // the slot of the record in use
  RecordHeader header_{};
};

}  // namespace volcomp::node
