#pragma once

#include <cstdint>

#include "comp/span.hpp"

namespace volcomp {

// CRC-32/ISO-HDLC (zlib, Ethernet). Table-free: commissioning only. crc32("123456789") =
// 0xCBF43926.
[[nodiscard]] std::uint32_t crc32(Span<const std::uint8_t> bytes);

}  // namespace volcomp
