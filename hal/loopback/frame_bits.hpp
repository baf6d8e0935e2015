#pragma once
// How long a classical CAN data frame with an 11-bit identifier is on the wire, in bits, from start
// of frame to the end of the intermission (ISO 11898-1).

#include <cstddef>
#include <cstdint>

#include "hal/can_port.hpp"

namespace volcomp::hal {

// Start of frame, identifier 11, RTR, IDE, r0, length 4, data and CRC 15 are stuffed; CRC
// delimiter, acknowledge 2, end of frame 7 and intermission 3 are not.
constexpr std::uint32_t stuffed_part_bits(std::size_t size) {
  return 34U + 8U * static_cast<std::uint32_t>(size);
}

// size: data bytes, 0…8. Without any stuff bit.
constexpr std::uint32_t nominal_frame_bits(std::size_t size) {
  return stuffed_part_bits(size) + 13U;
}

// One stuff bit after the first five bits and then, being the first of the next five itself, after
// every four.
constexpr std::uint32_t worst_case_frame_bits(std::size_t size) {
  return nominal_frame_bits(size) + (stuffed_part_bits(size) - 1U) / 4U;
}

// The CRC-15 of the frame: polynomial 4599h from zero over start of frame … data, unstuffed.
[[nodiscard]] std::uint16_t frame_crc(const CanFrame& frame);

// With the stuff bits that this content takes. Looks at every bit: some 400 ns on a PC.
[[nodiscard]] std::uint32_t exact_frame_bits(const CanFrame& frame);

}  // namespace volcomp::hal
