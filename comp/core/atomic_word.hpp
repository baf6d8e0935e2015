#pragma once
// What interrupt and background, or two cores, share. Always a word: processors exchange words in
// one instruction, but not all of them bytes. On RISC-V GCC calls libatomic for those (the "A"
// extension knows words and double words), and no image of ours links it.

#include <atomic>
#include <cstdint>

namespace volcomp {

template <class T = std::uint32_t>
class AtomicWord : public std::atomic<T> {
  static_assert(sizeof(T) == sizeof(std::uint32_t));

 public:
  constexpr AtomicWord(T value) : std::atomic<T>(value) {}  // NOLINT(google-explicit-constructor)
};

}  // namespace volcomp
