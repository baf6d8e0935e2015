#include "firmware/boards/mps2/stack.hpp"

#include "firmware/boards/mps2/linker_symbols.hpp"

namespace volcomp::boards {
namespace {

constexpr std::uint32_t kPaint = 0xDEAD'BEEF;  // as in startup.S

std::uint32_t bytes_between(const volatile std::uint32_t* from, const volatile std::uint32_t* to) {
  return static_cast<std::uint32_t>(to - from) * sizeof(std::uint32_t);
}

}  // namespace

std::uint32_t stack_bytes() { return bytes_between(stack_bottom, stack_top); }

std::uint32_t deepest_stack_bytes() {
  const volatile std::uint32_t* word = stack_bottom;
  while (word < stack_top && *word == kPaint)
    ++word;
  return bytes_between(word, stack_top);
}

void repaint_stack() {
  volatile std::uint32_t here = 0;
  for (volatile std::uint32_t* word = stack_bottom; word < &here; ++word)
    *word = kPaint;
}

}  // namespace volcomp::boards
