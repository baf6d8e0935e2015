// Memory for the data of tests and measurements: vectors, strings, tables of many sizes. The code
// under test has no heap, and neither has an image of this folder: nothing here comes from malloc
// or _sbrk. Pieces lie one above the other in a static array; what is given back becomes free as
// soon as nothing lies above it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "tests/target/stop.hpp"

namespace volcomp::target {
namespace {

constexpr std::size_t kBytes = std::size_t{2} << 20U;

struct alignas(16) Piece {
  Piece* below;
  bool in_use;
};

alignas(Piece) std::array<std::uint8_t, kBytes> memory;
Piece* top = nullptr;  // the highest piece
std::size_t used = 0;  // bytes up to its end

void* take(std::size_t bytes) {
  constexpr std::size_t kAlignment = alignof(Piece);
  const std::size_t rounded = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  if (rounded + sizeof(Piece) > kBytes - used) stop("The arena of tests/target/arena.cpp is full.");
  top = new (memory.data() + used) Piece{top, true};
  used += sizeof(Piece) + rounded;
  return top + 1;
}

void give_back(void* place) {
  if (place == nullptr) return;
  (static_cast<Piece*>(place) - 1)->in_use = false;
  while (top != nullptr && !top->in_use) {
    used = static_cast<std::size_t>(reinterpret_cast<std::uint8_t*>(top) - memory.data());
    top = top->below;
  }
}

}  // namespace
}  // namespace volcomp::target

void* operator new(std::size_t bytes) { return volcomp::target::take(bytes); }
void* operator new[](std::size_t bytes) { return volcomp::target::take(bytes); }
void operator delete(void* place) noexcept { volcomp::target::give_back(place); }
void operator delete[](void* place) noexcept { volcomp::target::give_back(place); }
void operator delete(void* place, std::size_t) noexcept { volcomp::target::give_back(place); }
void operator delete[](void* place, std::size_t) noexcept { volcomp::target::give_back(place); }

// What the library of the compiler ends in where it would throw.
extern "C" void abort() { volcomp::target::stop("The C++ library gave up (abort)."); }
