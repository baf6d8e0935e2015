#pragma once
// What a node is for beside compensating and probing. Each board has room for some of it; what is
// left out is left out of its object dictionary, too.

#ifndef VOLCOMP_NODE_STROKES
#define VOLCOMP_NODE_STROKES 1
#endif

namespace volcomp::node {

// Monitor, learning and offsets of a helical grinder: 201Ah, 2500h.
inline constexpr bool kWatchesStrokes = VOLCOMP_NODE_STROKES != 0;

}  // namespace volcomp::node
