#pragma once

#include <cstdint>

#include "comp/span.hpp"

namespace volcomp {

// CRC-32/ISO-HDLC (zlib, Ethernet), four bits at a time: background only. `before`: the CRC-32 of
// what comes before these bytes, 0 for nothing. crc32("123456789") = 0xCBF43926.
[[nodiscard]] std::uint32_t crc32(Span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace volcomp
