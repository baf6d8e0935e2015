#pragma once
// The compensator of a node: a loaded machine of up to five axes. How many knots its tables may
// have is the board's choice, VOLCOMP_NODE_KNOTS, because it decides about the memory: 960 bytes
// per knot here and 240 in the image buffer.

#include "comp/realtime/instances.hpp"

namespace volcomp::node {

#ifdef VOLCOMP_NODE_KNOTS
inline constexpr std::size_t kNodeKnots = VOLCOMP_NODE_KNOTS;
#else
inline constexpr std::size_t kNodeKnots = kDefaultKnots;
#endif

inline constexpr std::size_t kNodeAxes = LoadedCompensator::kAxes;

using NodeCompensator = Compensator<LoadedMachine<kNodeAxes>, kNodeKnots>;

}  // namespace volcomp::node

namespace volcomp {

// In the library of comp for the default number of knots, else in that of the node.
extern template class Compensator<LoadedMachine<node::kNodeAxes>, node::kNodeKnots>;

}  // namespace volcomp
