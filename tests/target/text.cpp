#include "tests/target/text.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "hal/mps2/uart.hpp"

namespace volcomp::target {
namespace {

constexpr const char* kDigits = "0123456789abcdef";

// `value` = ±d.dddddddd · 10^exponent
void put_scientific(double value) {
  constexpr int kDecimals = 8;
  int exponent = 0;
  double mantissa = value;
  while (mantissa >= 10.0) {
    mantissa /= 10.0;
    ++exponent;
  }
  while (mantissa < 1.0) {
    mantissa *= 10.0;
    --exponent;
  }
  for (int i = 0; i <= kDecimals; ++i) {
    const int digit = static_cast<int>(mantissa);
    put(kDigits[digit]);
    if (i == 0) put('.');
    mantissa = (mantissa - digit) * 10.0;
  }
  put('e');
  put(exponent < 0 ? '-' : '+');
  const auto size = static_cast<unsigned>(exponent < 0 ? -exponent : exponent);
  if (size < 10) put('0');
  put_unsigned(size);
}

void put_exact(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);                         // 0.5…1
  auto fraction = static_cast<std::uint64_t>(std::ldexp(mantissa, 53)) << 12U;  // behind the 1
  put(fraction == 0 ? "0x1" : "0x1.");
  for (; fraction != 0; fraction <<= 4U)
    put(kDigits[fraction >> 60U]);
  put(exponent > 0 ? "p+" : "p");
  put_signed(exponent - 1);
}

}  // namespace

void start_text() { hal::mps2::uart::start(); }

void put(char c) { hal::mps2::uart::send(static_cast<std::uint8_t>(c)); }

void put(const char* text) {
  for (; *text != '\0'; ++text)
    put(*text);
}

void put_unsigned(std::uint64_t value) {
  std::array<char, 20> digits{};
  std::size_t count = 0;
  do {
    digits[count++] = kDigits[value % 10U];
    value /= 10U;
  } while (value != 0);
  while (count > 0)
    put(digits[--count]);
}

void put_signed(std::int64_t value) {
  if (value < 0) put('-');
  const auto size = static_cast<std::uint64_t>(value);
  put_unsigned(value < 0 ? 0U - size : size);
}

void put_double(double value) {
  if (std::isnan(value)) return put("nan");
  if (std::signbit(value)) put('-');
  const double size = std::abs(value);
  if (std::isinf(size)) return put("inf");
  if (size <= 0.0) return put("0");
  put_scientific(size);
  put(" (");
  put_exact(size);
  put(')');
}

void put_hex(std::uint64_t value, unsigned bytes) {
  put("0x");
  for (unsigned shift = 8U * bytes; shift > 0; shift -= 4U)
    put(kDigits[value >> (shift - 4U) & 15U]);
}

}  // namespace volcomp::target
