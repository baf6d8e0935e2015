#pragma once
// Images with right checksums and wrong numbers, as damage before an image is sealed, or an
// attacker, can write them. Shared by the property test and the fuzzer.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"
#include "comp/tables/image.hpp"
#include "comp/tables/image_layout.hpp"

namespace volcomp::test {

using ImageBytes = std::vector<std::uint8_t>;

class HostileImage {
 public:
  HostileImage(std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  // Length, checksum of each axis as far as it can be found, checksum of the whole.
  void repair() {
    if (size_ < image_layout::first_axis(0) + image_layout::kCrcBytes) return;
    put(8, static_cast<std::uint32_t>(size_));
    for_each_axis([&](std::size_t at, std::size_t knots) {
      const std::size_t covered = image_layout::axis_bytes(knots) - image_layout::kCrcBytes;
      put(at + covered, crc32c({bytes_ + at, covered}));
    });
    const std::size_t covered = size_ - image_layout::kCrcBytes;
    put(covered, crc32({bytes_, covered}));
  }

  // One to four numbers, each as the number it is.
  template <class Bits>
  void mutate(Bits& bits) {
    if (size_ < image_layout::first_axis(0) + image_layout::kCrcBytes) return;
    for (std::uint64_t n = 1 + bits() % 4; n > 0; --n)
      mutate_one(bits);
    repair();
  }

 private:
  template <class T>
  void put(std::size_t at, T value) {
    if (at + sizeof value <= size_) std::memcpy(bytes_ + at, &value, sizeof value);
  }

  template <class Visit>
  void for_each_axis(const Visit& visit) {
    using namespace image_layout;
    std::size_t at = first_axis(bytes_[kBodiesAt]);
    for (unsigned a = 0; a < bytes_[kAxesAt] && at + kAxisHeaderBytes < size_; ++a) {
      const std::size_t knots = load_u32(bytes_ + at + 16);
      if (knots > kTableKnots || at + axis_bytes(knots) > size_) return;
      visit(at, knots);
      at += axis_bytes(knots);
    }
  }

  // By multiplications, which round alike on every processor.
  static double power_of_ten(int exponent) {
    double power = 1.0;
    for (int i = 0; i < std::abs(exponent); ++i)
      power *= 10.0;
    return exponent < 0 ? 1.0 / power : power;
  }

  // −most…most; half of them near 0, where the sizes of machines are.
  template <class Bits>
  static int exponent(Bits& bits, int most) {
    const int span = bits() % 2 == 0 ? most : most / 16;
    return static_cast<int>(bits() % static_cast<unsigned>(2 * span + 1)) - span;
  }

  // A number at which arithmetic changes: none, tiny, huge, infinite, not a number.
  template <class T, class Bits>
  static T odd_number(Bits& bits) {
    const T sign = bits() % 2 == 0 ? T{1} : T{-1};
    using Limits = std::numeric_limits<T>;
    switch (bits() % 8) {
      case 0:
        return sign * Limits::infinity();
      case 1:
        return Limits::quiet_NaN();
      case 2:
        return sign * Limits::max();
      case 3:
        return sign * Limits::denorm_min();
      case 4:
        return sign * Limits::min();
      case 5:
        return T{0} * sign;
      case 6:
        return sign * static_cast<T>(power_of_ten(exponent(bits, Limits::max_exponent10 - 1)));
      default:
        return sign * std::ldexp(T{1}, exponent(bits, Limits::max_exponent - 1));
    }
  }

  // One after the other: compilers differ in which argument of a call they evaluate first.
  template <class Bits>
  static std::size_t pick(Bits& bits, std::size_t count) {
    return static_cast<std::size_t>(bits() % count);
  }
  template <class T, class Bits>
  void put_odd(Bits& bits, std::size_t first, std::size_t count) {
    const std::size_t at = first + sizeof(T) * pick(bits, count);
    put(at, odd_number<T>(bits));
  }

  template <class Bits>
  void mutate_one(Bits& bits) {
    using namespace image_layout;
    constexpr std::size_t kJointAt = 6;  // offset, orientation, constant error: 18 doubles
    const std::size_t bodies = bytes_[kBodiesAt];
    const std::size_t what = pick(bits, 8);
    if (what >= 5) return mutate_axis(bits);
    if (what == 0)
      return put_odd<double>(bits, kHeaderBytes + kMachineBytes - 24, 3);  // tool point
    if (what == 4) {                                                       // any byte
      std::uint8_t& byte = bytes_[pick(bits, size_)];
      byte = static_cast<std::uint8_t>(bits());
      return;
    }
    if (bodies == 0) return;
    const std::size_t body = first_axis(pick(bits, bodies));
    put_odd<double>(bits, body + kJointAt, what == 3 ? 18 : 3);
  }

  template <class Bits>
  void mutate_axis(Bits& bits) {
    using namespace image_layout;
    std::array<std::size_t, 256> place{};
    std::array<std::size_t, 256> length{};
    std::size_t axes = 0;
    for_each_axis([&](std::size_t at, std::size_t knots) {
      place[axes] = at;
      length[axes++] = knots;
    });
    if (axes == 0) return;
    const std::size_t a = pick(bits, axes);
    const std::size_t at = place[a];
    const std::size_t what = pick(bits, 5);
    if (what == 0) {  // first knot or pitch
      const std::size_t which = pick(bits, 2);
      const std::size_t shift = pick(bits, 64);
      return put(at + 8 * which, static_cast<std::int64_t>(bits() >> shift));
    }
    if (what == 1) return put_odd<double>(bits, at + 21, 3);  // direction
    if (what == 2) return put_odd<float>(bits, at + 45, 2);   // expansion
    if (length[a] != 0) put_odd<float>(bits, at + kAxisHeaderBytes, 12 * length[a]);
  }

  std::uint8_t* bytes_;
  std::size_t size_;
};

inline ImageBytes image_bytes(const MachineTables& tables) {
  ImageBytes bytes(image_size(tables));
  std::size_t written = 0;
  if (!encode_image(tables, {bytes.data(), bytes.size()}, written).ok()) bytes.clear();
  return bytes;
}

}  // namespace volcomp::test
