#pragma once
// Images whose checksums are right and whose numbers are not: what damages an image before it is
// sealed, or who means harm, can write. Shared by the property test and the fuzzer.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "comp/core/crc32.hpp"
#include "comp/core/little_endian.hpp"
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

  // Of the sizes at which arithmetic changes: none, tiny, huge, infinite, not a number.
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
        return sign * static_cast<T>(std::pow(10.0, static_cast<double>(bits() % 80) - 40.0));
      default:
        return sign * std::ldexp(T{1}, static_cast<int>(bits() % 2000) - 1000);
    }
  }

  template <class Bits>
  void mutate_one(Bits& bits) {
    using namespace image_layout;
    const std::size_t bodies = bytes_[kBodiesAt];
    switch (bits() % 8) {
      case 0:  // tool point
        return put(kHeaderBytes + kMachineBytes - 8 * (1 + bits() % 3), odd_number<double>(bits));
      case 1:
      case 2:  // joint offset
        if (bodies == 0) return;
        return put(first_axis(bits() % bodies) + 6 + 8 * (bits() % 3), odd_number<double>(bits));
      case 3:  // any number of a body
        if (bodies == 0) return;
        return put(first_axis(bits() % bodies) + 6 + 8 * (bits() % 18), odd_number<double>(bits));
      case 4:  // any byte
        bytes_[bits() % size_] = static_cast<std::uint8_t>(bits());
        return;
      default:
        break;
    }
    std::array<std::size_t, 256> place{};
    std::array<std::size_t, 256> length{};
    std::size_t axes = 0;
    for_each_axis([&](std::size_t at, std::size_t knots) {
      place[axes] = at;
      length[axes++] = knots;
    });
    if (axes == 0) return;
    const std::size_t a = bits() % axes;
    const std::size_t at = place[a];
    switch (bits() % 5) {
      case 0:  // first knot or pitch
        return put(at + 8 * (bits() % 2), static_cast<std::int64_t>(bits() >> bits() % 64));
      case 1:  // direction
        return put(at + 21 + 8 * (bits() % 3), odd_number<double>(bits));
      case 2:  // expansion
        return put(at + 45 + 4 * (bits() % 2), odd_number<float>(bits));
      default:
        if (length[a] == 0) return;
        return put(at + kAxisHeaderBytes + 4 * (bits() % (12 * length[a])),
                   odd_number<float>(bits));
    }
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
