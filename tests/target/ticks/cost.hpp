#pragma once
// What a piece of work costs on the board, in instructions.

#include "comp/core/status.hpp"
#include "hal/mps2/instruction_counter.hpp"
#include "tests/target/stop.hpp"

namespace volcomp::target {

using hal::mps2::InstructionCounter;

inline InstructionCounter counter;

inline void require(const Status& status) {
  if (!status.ok()) stop(sentence(status.reason));
}

template <class Work>
std::uint32_t instructions_of(const Work& work) {
  const std::uint32_t start = InstructionCounter::ticks();
  const std::uint32_t before = InstructionCounter::ticks();
  work();
  const std::uint32_t after = InstructionCounter::ticks();
  return counter.between(before, after) - counter.between(start, before);
}

}  // namespace volcomp::target
