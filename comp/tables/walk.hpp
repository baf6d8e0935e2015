#pragma once
// Loops of the tick over axes and steps. Where an index is known beforehand its branches disappear
// and its data stay in registers.

#include <cstddef>
#include <utility>

#include "comp/core/inline.hpp"
#include "comp/tables/runtime_chain.hpp"

namespace volcomp::kernel {

template <class Visit, std::size_t... I>
VOLCOMP_INLINE void visit_each(std::size_t from, std::size_t to, const Visit& visit,
                               std::index_sequence<I...>) {
  (static_cast<void>(I >= from && I < to ? visit(I) : void()), ...);
}

// Calls visit(i) for the steps from…to−1 of the walk, upwards or downwards. For a compiled-in
// machine every call is inlined with a constant i, so that all branches on the step disappear.
template <class Machine, class Visit>
VOLCOMP_INLINE void walk_up(std::size_t from, std::size_t to, const Visit& visit) {
  if constexpr (Machine::kCompiledIn) {
    visit_each(from, to, visit, std::make_index_sequence<Machine::chain.steps>{});
  } else {
    for (std::size_t i = from; i < to; ++i)
      visit(i);
  }
}

template <class Machine, class Visit>
VOLCOMP_INLINE void walk_down(std::size_t from, std::size_t to, const Visit& visit) {
  if constexpr (Machine::kCompiledIn) {
    constexpr std::size_t n = Machine::chain.steps;
    const auto mirrored = [&](std::size_t k) VOLCOMP_INLINE_LAMBDA { visit(n - 1 - k); };
    visit_each(n - to, n - from, mirrored, std::make_index_sequence<n>{});
  } else {
    for (std::size_t i = to; i > from; --i)
      visit(i - 1);
  }
}

// Calls visit(axis) for the linear axes; beyond the last axis all are of no kind that moves.
template <class Machine, class Visit>
VOLCOMP_INLINE void for_each_linear(const Machine& machine, const Visit& visit) {
  const auto linear = [&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    if (machine.chain.kind[a] == JointKind::prismatic) visit(a);
  };
  visit_each(0, Machine::kAxes, linear, std::make_index_sequence<Machine::kAxes>{});
}

}  // namespace volcomp::kernel
