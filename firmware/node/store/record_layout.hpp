#pragma once
// Layout of a record of settings and tables in flash, and the meaning of two slots in any state.
//
// Each slot is one sector (0 and 1), little-endian, everything at multiples of 32 bytes:
//
//     0  header: magic "VOLCOMP2", the digit is the version of this layout
//     8          sequence number, one more than the record before (RFC 1982: it may wrap)
//    12          size of the parameters, CRC-32C of the parameters
//    20          size of the image, CRC-32C of the image
//    28          CRC-32C of bytes 0…27
//    32  seal: zeros
//    64  parameters
//     …  image, which begins with its stamps: machine, date, temperature, operator
//
// Why so:
//   - Two slots: a save erases only the slot that does not hold the record in use. Wherever power
//     fails, that record is still there, and both parts always come from the same save.
//   - Header after the parts were read back: without it the slot holds no record, so an intact
//     header means that the save had written everything else.
//   - A CRC of its own for the header, so that its sizes are never trusted unchecked; one for each
//     part, so that a part is checked in the memory it was read into. CRC-32C, because an image
//     ends with its CRC-32 (comp/core/crc32.hpp).
//   - Seal after the header was read back. A header that power failed upon may read well today and
//     badly tomorrow ("The unstable bits issue" in the documentation of UBIFS), so it must not
//     replace the record before it. Where a seal was begun, the header is known to be firm.
//   - Multiples of 32: the largest unit of flash with error correction in common controllers (256
//     bits), and a unit can be programmed only once after an erase.
//   - Nothing is remembered between calls that flash could contradict: every save looks again.

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/node/store/storage.hpp"

namespace volcomp::node {

struct RecordPart {
  std::uint32_t size = 0;  // bytes
  std::uint32_t crc = 0;   // CRC-32C
};

struct RecordHeader {
  std::uint32_t sequence = 0;
  RecordPart parameters{};
  RecordPart image{};
};

inline constexpr std::size_t kRecordUnit = 32;
inline constexpr std::size_t kRecordHeaderBytes = kRecordUnit;
inline constexpr std::size_t kSealAt = kRecordUnit;  // in the slot, as are the parts
inline constexpr std::size_t kParametersAt = 2 * kRecordUnit;

constexpr std::size_t whole_record_units(std::size_t bytes) {
  return (bytes + kRecordUnit - 1) / kRecordUnit * kRecordUnit;
}

constexpr std::size_t image_at(std::size_t parameters_size) {
  return kParametersAt + whole_record_units(parameters_size);
}

// Whether parts of these sizes fit a sector, whose size is a multiple of 32.
constexpr bool record_fits(std::size_t parameters_size, std::size_t image_size,
                           std::size_t sector_bytes) {
  return parameters_size <= sector_bytes - kParametersAt &&
         image_size <= sector_bytes - image_at(parameters_size);
}

enum class SlotState : std::uint8_t {
  blank,       // erased
  headless,    // a save or an erase was cut short, or the header was hit
  damaged,     // the header is intact, a part is not
  unreadable,  // the device does not answer
  valid,
};

struct Slot {
  SlotState state = SlotState::blank;
  RecordHeader header{};  // where the state is damaged or valid
  bool sealed = false;    // where the state is valid
};

using Slots = std::array<Slot, 2>;
inline constexpr std::size_t kNoSlot = 2;

using RecordHeaderBytes = std::array<std::uint8_t, kRecordHeaderBytes>;
[[nodiscard]] RecordHeaderBytes encode_record_header(const RecordHeader& header);
// valid, blank or headless; headless also when the record does not fit the sector.
[[nodiscard]] Slot decode_record_header(const RecordHeaderBytes& bytes, std::size_t sector_bytes);

// The newest valid record, or the one before it while the newest lacks its seal: 0, 1 or kNoSlot.
[[nodiscard]] std::size_t record_to_use(const Slots& slots);
// The result of load() for slots in these states.
StoreResult verdict(const Slots& slots);

}  // namespace volcomp::node
