#pragma once
// Text on the serial line of the board: what the images of this folder report with. No heap, no
// printf (its floating-point half allocates).

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace volcomp::target {

// Once, before the first text.
void start_text();

void put(char c);
void put(const char* text);
void put_unsigned(std::uint64_t value);
void put_signed(std::int64_t value);

// Nine significant digits and, exactly, as a hexadecimal fraction: 0.1 → 1.00000000e-01
// (0x1.999999999999ap-4).
void put_double(double value);

// 0x and all digits of `bytes` bytes.
void put_hex(std::uint64_t value, unsigned bytes);

template <class T>
std::enable_if_t<std::is_integral_v<T>> put_number(T value) {
  if constexpr (std::is_signed_v<T>) {
    put_signed(value);
  } else {
    put_unsigned(value);
  }
}

// " name=value"
template <class T>
void put_field(const char* name, const T& value) {
  put(' ');
  put(name);
  put('=');
  if constexpr (std::is_convertible_v<T, const char*>) {
    put(static_cast<const char*>(value));
  } else {
    put_number(value);
  }
}

}  // namespace volcomp::target
