#pragma once
// The frames of an SDO transfer (CiA 301, section 7.2.4.3). All have 8 bytes; the upper three bits
// of the first are the command specifier, whose numbers have another meaning in each direction.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/object_access.hpp"

namespace volcomp::canopen {

using SdoData = std::array<std::uint8_t, 8>;

inline constexpr std::size_t kSegmentBytes = 7;
inline constexpr std::size_t kExpeditedBytes = 4;  // at most
inline constexpr std::uint8_t kMostBlockSegments = 127;
inline constexpr std::uint64_t kSdoTimeout_us = 1'000'000;

inline constexpr std::uint8_t kSdoAbort = 0x80;  // the whole first byte, in both directions

namespace ccs {  // client command specifier
inline constexpr std::uint8_t kDownloadSegment = 0x00;
inline constexpr std::uint8_t kInitiateDownload = 0x20;
inline constexpr std::uint8_t kInitiateUpload = 0x40;
inline constexpr std::uint8_t kUploadSegment = 0x60;
inline constexpr std::uint8_t kBlockUpload = 0xA0;
inline constexpr std::uint8_t kBlockDownload = 0xC0;
}  // namespace ccs

namespace scs {  // server command specifier
inline constexpr std::uint8_t kUploadSegment = 0x00;
inline constexpr std::uint8_t kDownloadSegment = 0x20;
inline constexpr std::uint8_t kInitiateUpload = 0x40;
inline constexpr std::uint8_t kInitiateDownload = 0x60;
inline constexpr std::uint8_t kBlockDownload = 0xA0;
inline constexpr std::uint8_t kBlockUpload = 0xC0;
}  // namespace scs

// Bits of an initiate frame and of a segment.
inline constexpr std::uint8_t kExpedited = 0x02;
inline constexpr std::uint8_t kSizeIndicated = 0x01;
inline constexpr std::uint8_t kToggle = 0x10;
inline constexpr std::uint8_t kLastSegment = 0x01;

// Bits of a frame that opens a block transfer, and of a segment in a block.
inline constexpr std::uint8_t kBlockCrc = 0x04;
inline constexpr std::uint8_t kBlockSizeIndicated = 0x02;
inline constexpr std::uint8_t kLastBlockSegment = 0x80;

// Sub-commands of a block transfer: two bits from the side that receives the data. The side that
// sends them has one bit (initiate or end), the others are flags.
inline constexpr std::uint8_t kBlockInitiate = 0x00;
inline constexpr std::uint8_t kBlockEnd = 0x01;
inline constexpr std::uint8_t kBlockConfirm = 0x02;
inline constexpr std::uint8_t kBlockStart = 0x03;
inline constexpr std::uint8_t kReceiverSubcommand = 0x03;
inline constexpr std::uint8_t kSenderSubcommand = 0x01;

constexpr std::uint8_t command_of(const SdoData& frame) { return frame[0] & 0xE0U; }

constexpr ObjectId object_of(const SdoData& frame) {
  return {static_cast<std::uint16_t>(load_le(frame.data() + 1, 2)), frame[3]};
}

constexpr std::uint32_t number_of(const SdoData& frame) {
  return static_cast<std::uint32_t>(load_le(frame.data() + 4, 4));
}

constexpr SdoData object_frame(unsigned command, ObjectId object, std::size_t number = 0) {
  SdoData frame{};
  frame[0] = static_cast<std::uint8_t>(command);
  store_le(frame.data() + 1, 2, object.index);
  frame[3] = object.sub;
  store_le(frame.data() + 4, 4, number);
  return frame;
}

constexpr SdoData abort_frame(ObjectId object, AbortCode code) {
  return object_frame(kSdoAbort, object, static_cast<std::uint32_t>(code));
}

// Confirms the segments 1…`last_good` of a block and opens the next one.
constexpr SdoData confirm_frame(unsigned command, std::uint8_t last_good) {
  return {static_cast<std::uint8_t>(command | kBlockConfirm), last_good, kMostBlockSegments};
}

constexpr bool fits_expedited(std::size_t size) { return size > 0 && size <= kExpeditedBytes; }

// Opens a normal transfer: carries the bytes if there are 1 to 4 of them, otherwise their number.
constexpr SdoData initiate_frame(std::uint8_t command, ObjectId object,
                                 Span<const std::uint8_t> bytes) {
  const std::size_t size = bytes.size();
  if (!fits_expedited(size)) return object_frame(command | kSizeIndicated, object, size);
  const auto unused = static_cast<unsigned>(kExpeditedBytes - size);
  return object_frame(command | unused << 2U | kExpedited | kSizeIndicated, object,
                      static_cast<std::size_t>(load_le(bytes.data(), size)));
}

constexpr bool is_expedited(const SdoData& frame) { return (frame[0] & kExpedited) != 0; }

// The size in such a frame, if it has one.
constexpr std::optional<std::size_t> announced_size(const SdoData& frame) {
  if ((frame[0] & kSizeIndicated) == 0) return std::nullopt;
  if (is_expedited(frame)) return kExpeditedBytes - ((frame[0] >> 2U) & 3U);
  return number_of(frame);
}

// The same for a frame that opens a block transfer.
constexpr std::optional<std::size_t> announced_block_size(const SdoData& frame) {
  if ((frame[0] & kBlockSizeIndicated) == 0) return std::nullopt;
  return number_of(frame);
}

}  // namespace volcomp::canopen
