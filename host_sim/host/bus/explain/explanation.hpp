#pragma once
// Explains a code of a machine: why it comes, and what to do. The sentence of the code itself
// describes what happened.

#include "comp/core/status.hpp"
#include "comp/tick/tick_types.hpp"
#include "comp/tick/touch.hpp"
#include "firmware/canopen/emergency.hpp"

namespace volcomp::host {

struct Explanation {
  const char* why = "";
  const char* remedy = "";
};

[[nodiscard]] Explanation explain(Reason reason);
[[nodiscard]] Explanation explain(canopen::ErrorCode code);
[[nodiscard]] Explanation explain(TouchVerdict verdict);
[[nodiscard]] Explanation explain(StatusBit bit);

// All reasons: there is no other way to know where they end.
inline constexpr int kReasons = static_cast<int>(Reason::cannot_orient) + 1;

// What an object of the node is for, by index; nullptr where nothing is known of it.
[[nodiscard]] const char* purpose(unsigned index);

}  // namespace volcomp::host
