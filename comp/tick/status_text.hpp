#pragma once
// The bits of a status word in words. By itself: an image that never speaks carries no text.

#include "comp/tick/tick_types.hpp"

namespace volcomp {

// Stable machine-readable name, for instance "out_of_range".
[[nodiscard]] const char* code(StatusBit bit);

// A phrase for people, for instance "beyond its table, correction of the end".
[[nodiscard]] const char* words(StatusBit bit);

}  // namespace volcomp
