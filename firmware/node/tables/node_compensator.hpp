#pragma once
// The compensator of a node: a loaded machine of up to five axes. How many knots its tables may
// have is the board's choice, VOLCOMP_NODE_KNOTS, because it decides about the memory: 960 bytes
// per knot here and 240 in the image buffer.

#include "comp/tick/instances.hpp"
#include "firmware/node/node_features.hpp"

namespace volcomp::node {

#ifdef VOLCOMP_NODE_KNOTS
inline constexpr std::size_t kNodeKnots = VOLCOMP_NODE_KNOTS;
#else
inline constexpr std::size_t kNodeKnots = kDefaultKnots;
#endif

inline constexpr std::size_t kNodeAxes = LoadedCompensator::kAxes;

using NodeMachine = LoadedMachine<kNodeAxes, kOrientsTool ? kMaxOrienting : 0>;
using NodeCompensator = Compensator<NodeMachine, kNodeKnots>;

}  // namespace volcomp::node

namespace volcomp {

// In the library of comp for the default number of knots, else in that of the node.
extern template class Compensator<node::NodeMachine, node::kNodeKnots>;

}  // namespace volcomp
