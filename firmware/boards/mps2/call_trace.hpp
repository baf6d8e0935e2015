#pragma once
// Guesses the callers of a function from the stack. There are no frame pointers to follow, so every
// word is taken that is the address behind a call; one that is left over from an earlier call looks
// the same.

#include <cstdint>

namespace volcomp::boards {

// The next such word from `word` on, moving `word` behind it; 0 when the stack has no more.
[[nodiscard]] std::uint32_t next_return_address(const std::uint32_t*& word);

}  // namespace volcomp::boards
