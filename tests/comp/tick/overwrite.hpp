#pragma once
// What a fault of memory does to a compensator.

#include <cstddef>
#include <cstring>

namespace volcomp::test {

// Replaces a number wherever the memory of `unit` holds it; how often.
template <class Unit>
int overwrite(Unit& unit, float from, float to) {
  auto* bytes = reinterpret_cast<unsigned char*>(&unit);
  int found = 0;
  for (std::size_t at = 0; at + sizeof from <= sizeof unit; at += sizeof from) {
    if (std::memcmp(bytes + at, &from, sizeof from) != 0) continue;
    std::memcpy(bytes + at, &to, sizeof to);
    ++found;
  }
  return found;
}

}  // namespace volcomp::test
