#include "firmware/canopen/crc16.hpp"

namespace volcomp::canopen {

// The polynomial x^16 + x^12 + x^5 + 1 has so few terms that the division of a whole byte folds
// into three shifts; the first line is the carry of the upper into the lower half byte.
std::uint16_t crc16(Span<const std::uint8_t> bytes, std::uint16_t crc) {
  std::uint32_t remainder = crc;
  for (const std::uint8_t byte : bytes) {
    std::uint32_t quotient = (remainder >> 8U) ^ byte;
    quotient ^= quotient >> 4U;
    remainder = ((remainder << 8U) ^ (quotient << 12U) ^ (quotient << 5U) ^ quotient) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(remainder);
}

}  // namespace volcomp::canopen
