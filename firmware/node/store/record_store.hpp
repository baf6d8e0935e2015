#pragma once
// Keeps settings and tables through a power failure: one record of two parts, written to two slots
// in turn (record_layout.hpp).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/crc32.hpp"
#include "comp/core/span.hpp"
#include "firmware/node/store/record_layout.hpp"
#include "hal/block_device.hpp"

namespace volcomp::node {

// All calls block for as long as the device does and belong to the background. Stack: below 1 KiB
// besides the device's own. One store per device, no calls from two contexts.
template <class Blocks>
class RecordStore {
  static_assert(hal::IsBlockDevice<Blocks>::value);
  static_assert(Blocks::kSectors >= 2);
  static_assert(kRecordUnit % Blocks::kUnitBytes == 0, "the layout needs units up to 32 bytes");
  static_assert(Blocks::kSectorBytes > kParametersAt && Blocks::kSectorBytes % kRecordUnit == 0);

 public:
  explicit RecordStore(Blocks& blocks) : blocks_(blocks) {}

  // Finds the record to use for the calls below: loaded, loaded_older, nothing_stored, damaged, or
  // read_failed when there is none but a slot did not answer. Reads both slots.
  StoreResult load() {
    const Slots slots = inspect();
    hold(slots);
    return verdict(slots);
  }

  // The parts of the record that load() found or save() wrote: done, nothing_stored, read_failed,
  // buffer_too_small (nothing is read, `size` is what is needed) or damaged (since load(); `out`
  // holds bytes not to be used).
  StoreResult read_parameters(Span<std::uint8_t> out, std::size_t& size) {
    return read_part(kParametersAt, header_.parameters, out, size);
  }
  StoreResult read_image(Span<std::uint8_t> out, std::size_t& size) {
    return read_part(image_at(header_.parameters.size), header_.image, out, size);
  }

  // Both parts, or what was stored before stays: done; too_large or, if no slot answers,
  // read_failed with nothing touched; otherwise the step that failed. Then load() finds the record
  // before, or the new one if only its last step failed, and save() can be called again.
  StoreResult save(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) {
    if (!record_fits(parameters.size(), image.size(), Blocks::kSectorBytes))
      return StoreResult::too_large;
    const Slots slots = inspect();
    hold(slots);
    if (all_unreadable(slots)) return StoreResult::read_failed;
    const std::size_t target = slot_to_replace(slots);
    const std::size_t other = 1 - target;
    // A half-erased slot must not come back later as the newest record, nor a slot that cannot be
    // read, nor one whose header is not sealed.
    const bool clear_first = held_ == kNoSlot && slots[other].state != SlotState::unreadable;
    const bool clear_last = !clear_first && !slots[other].sealed;
    if (clear_first && !blocks_.erase(other)) return StoreResult::erase_failed;
    const RecordHeader header{header_.sequence + 1, describe(parameters), describe(image)};
    if (const StoreResult r = replace(target, header, parameters, image); r != StoreResult::done)
      return r;
    held_ = target;
    header_ = header;
    return !clear_last || blocks_.erase(other) ? StoreResult::done : StoreResult::erase_failed;
  }

  // Both slots, the one not in use first: cut short, it never brings back an older record. done,
  // erase_failed or verify_failed. Also the way out when neither slot answers.
  StoreResult erase_all() {
    const std::size_t first = record_to_use(inspect()) == 0 ? 1 : 0;
    held_ = kNoSlot;
    header_ = {};
    if (!blocks_.erase(first) || !blocks_.erase(1 - first)) return StoreResult::erase_failed;
    return verdict(inspect()) == StoreResult::nothing_stored ? StoreResult::done
                                                             : StoreResult::verify_failed;
  }

  // Sequence number and sizes of that record; zeros if there is none.
  [[nodiscard]] const RecordHeader& record() const { return header_; }

 private:
  using Unit = std::array<std::uint8_t, kRecordUnit>;
  using Chunk = std::array<std::uint8_t, 8 * kRecordUnit>;  // moved at a time

  static std::size_t start_of(std::size_t slot) { return slot * Blocks::kSectorBytes; }

  static RecordPart describe(Span<const std::uint8_t> part) {
    return {static_cast<std::uint32_t>(part.size()), crc32c(part)};
  }

  static bool all_unreadable(const Slots& slots) {
    return slots[0].state == SlotState::unreadable && slots[1].state == SlotState::unreadable;
  }

  // Without a valid record, what does not answer right now may be one.
  [[nodiscard]] std::size_t slot_to_replace(const Slots& slots) const {
    if (held_ != kNoSlot) return 1 - held_;
    return slots[0].state == SlotState::unreadable ? 1 : 0;
  }

  void hold(const Slots& slots) {
    held_ = record_to_use(slots);
    header_ = held_ != kNoSlot ? slots[held_].header : RecordHeader{};
  }

  // --- reading

  static SlotState state_after(hal::BlockRead read, SlotState uncorrectable) {
    return read == hal::BlockRead::failed ? SlotState::unreadable : uncorrectable;
  }

  Slots inspect() { return {inspect(0), inspect(1)}; }

  Slot inspect(std::size_t slot) {
    RecordHeaderBytes bytes{};
    const std::size_t start = start_of(slot);
    const hal::BlockRead read = blocks_.read(start, bytes);
    if (read != hal::BlockRead::done) return {state_after(read, SlotState::headless), {}, false};
    Slot found = decode_record_header(bytes, Blocks::kSectorBytes);
    if (found.state == SlotState::blank) found.state = blank_state(start);
    if (found.state == SlotState::valid)
      found.state = part_state(start + kParametersAt, found.header.parameters);
    if (found.state == SlotState::valid)
      found.state = part_state(start + image_at(found.header.parameters.size), found.header.image);
    if (found.state == SlotState::valid) inspect_seal(start + kSealAt, found);
    return found;
  }

  // blank, headless or unreadable: a save that was cut short leaves parts without a header.
  SlotState blank_state(std::size_t start) {
    Unit unit{};
    for (std::size_t at = 0; at < Blocks::kSectorBytes; at += unit.size()) {
      const hal::BlockRead read = blocks_.read(start + at, unit);
      if (read != hal::BlockRead::done) return state_after(read, SlotState::headless);
      if (!hal::is_erased(unit)) return SlotState::headless;
    }
    return SlotState::blank;
  }

  // valid, damaged or unreadable.
  SlotState part_state(std::size_t at, const RecordPart& part) {
    Chunk chunk{};
    std::uint32_t crc = 0;
    for (std::size_t done = 0; done < part.size; done += chunk.size()) {
      const Span<std::uint8_t> bytes{chunk.data(),
                                     std::min<std::size_t>(chunk.size(), part.size - done)};
      const hal::BlockRead read = blocks_.read(at + done, bytes);
      if (read != hal::BlockRead::done) return state_after(read, SlotState::damaged);
      crc = crc32c({bytes.data(), bytes.size()}, crc);
    }
    return crc == part.crc ? SlotState::valid : SlotState::damaged;
  }

  // Any trace of a seal counts.
  void inspect_seal(std::size_t at, Slot& slot) {
    Unit seal{};
    const hal::BlockRead read = blocks_.read(at, seal);
    if (read == hal::BlockRead::failed) {
      slot = {SlotState::unreadable, {}, false};
      return;
    }
    slot.sealed = read == hal::BlockRead::uncorrectable || !hal::is_erased(seal);
  }

  StoreResult read_part(std::size_t at, const RecordPart& part, Span<std::uint8_t> out,
                        std::size_t& size) {
    size = part.size;
    if (held_ == kNoSlot) return StoreResult::nothing_stored;
    if (out.size() < size) return StoreResult::buffer_too_small;
    const Span<std::uint8_t> bytes{out.data(), size};
    const hal::BlockRead read = blocks_.read(start_of(held_) + at, bytes);
    if (read == hal::BlockRead::failed) return StoreResult::read_failed;
    const bool intact = read == hal::BlockRead::done && crc32c({bytes.data(), size}) == part.crc;
    return intact ? StoreResult::done : StoreResult::damaged;
  }

  // --- writing

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
    if (const StoreResult r = write_unit(start, encode_record_header(header));
        r != StoreResult::done)
      return r;
    return write_unit(start + kSealAt, Unit{});
  }

  StoreResult write_part(std::size_t at, Span<const std::uint8_t> bytes, const RecordPart& part) {
    for (std::size_t done = 0; done < bytes.size(); done += Chunk{}.size()) {
      if (!program_chunk(at + done, {bytes.data() + done, bytes.size() - done}))
        return StoreResult::write_failed;
    }
    const SlotState state = part_state(at, part);
    if (state == SlotState::unreadable) return StoreResult::read_failed;
    return state == SlotState::valid ? StoreResult::done : StoreResult::verify_failed;
  }

  // As much of `bytes` as a chunk takes; the last unit is filled up.
  bool program_chunk(std::size_t at, Span<const std::uint8_t> bytes) {
    Chunk chunk{};
    chunk.fill(hal::kErasedByte);
    const std::size_t count = std::min(chunk.size(), bytes.size());
    std::copy_n(bytes.begin(), count, chunk.begin());
    return blocks_.program(at, {chunk.data(), whole_record_units(count)});
  }

  StoreResult write_unit(std::size_t at, const Unit& unit) {
    if (!blocks_.program(at, unit)) return StoreResult::write_failed;
    Unit stored{};
    const hal::BlockRead read = blocks_.read(at, stored);
    if (read == hal::BlockRead::failed) return StoreResult::read_failed;
    const bool same = read == hal::BlockRead::done && stored == unit;
    return same ? StoreResult::done : StoreResult::verify_failed;
  }

  Blocks& blocks_;
  std::size_t held_ = kNoSlot;  // the slot of the record in use
  RecordHeader header_{};
};

}  // namespace volcomp::node
