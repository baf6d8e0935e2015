#pragma once
// Parts of the object dictionary put together.

#include <array>
#include <cstddef>

#include "firmware/canopen/named_entry.hpp"

namespace volcomp::node::detail {

// Rows as of an object at `offset`.
template <std::size_t Rows>
constexpr std::array<canopen::NamedEntry, Rows> moved_by(
    std::size_t offset, std::array<canopen::NamedEntry, Rows> rows) {
  for (canopen::NamedEntry& row : rows)
    row.offset = static_cast<std::uint16_t>(row.offset + offset);
  return rows;
}

template <class T, std::size_t N, std::size_t M>
constexpr std::array<T, N + M> joined(const std::array<T, N>& a, const std::array<T, M>& b) {
  std::array<T, N + M> all{};
  for (std::size_t i = 0; i < N; ++i)
    all[i] = a[i];
  for (std::size_t i = 0; i < M; ++i)
    all[N + i] = b[i];
  return all;
}

}  // namespace volcomp::node::detail
