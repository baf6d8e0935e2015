#pragma once
// The checksum of SDO block transfers (CiA 301, section 7.2.4.3.16).

#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp::canopen {

// CRC-16/XMODEM: polynomial 1021h, start value 0, not reflected. crc16("123456789") = 31C3h. The
// result for one part is the start value for the next. Table-free, about ten operations a byte.
[[nodiscard]] std::uint16_t crc16(Span<const std::uint8_t> bytes, std::uint16_t crc = 0);

}  // namespace volcomp::canopen
