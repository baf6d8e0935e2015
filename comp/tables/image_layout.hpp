#pragma once
// Sizes of the parts of a table image (image.hpp), shared by its writer and its reader.

#include <array>
#include <cstddef>
#include <cstdint>

namespace volcomp::image_layout {

inline constexpr std::array<std::uint8_t, 4> kMagic{'V', 'C', 'T', '1'};
inline constexpr std::size_t kAxesAt = 6;
inline constexpr std::size_t kBodiesAt = 7;
inline constexpr std::size_t kProvenanceAt = 12;
inline constexpr std::size_t kHeaderBytes = 4 + 2 + 1 + 1 + 4 + 4 + 4 + 8 + 8 + 4 + 16;
inline constexpr std::size_t kMachineBytes = 3 + 3 + 3 + 24;
inline constexpr std::size_t kBodyBytes = 6 + sizeof(double) * 18;
inline constexpr std::size_t kAxisHeaderBytes = 8 + 8 + 4 + 1 + 24 + 4 + 4 + 1;
inline constexpr std::size_t kKnotBytes = sizeof(float) * 12;  // two directions, six channels
inline constexpr std::size_t kCrcBytes = 4;

constexpr std::size_t axis_bytes(std::size_t knots) {
  return kAxisHeaderBytes + kKnotBytes * knots + kCrcBytes;
}

// Where the first axis begins.
constexpr std::size_t first_axis(std::size_t bodies) {
  return kHeaderBytes + kMachineBytes + kBodyBytes * bodies;
}

}  // namespace volcomp::image_layout
