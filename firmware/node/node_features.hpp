#pragma once
// Features of a node beside compensating. Each board has room for some of them, and no machine
// needs all; a feature left out is also missing from its object dictionary.

#ifndef VOLCOMP_NODE_PROBING
#define VOLCOMP_NODE_PROBING 1
#endif
#ifndef VOLCOMP_NODE_STROKES
#define VOLCOMP_NODE_STROKES 1
#endif
#ifndef VOLCOMP_NODE_THERMAL
#define VOLCOMP_NODE_THERMAL 1
#endif
#ifndef VOLCOMP_NODE_ORIENTS
#define VOLCOMP_NODE_ORIENTS 1
#endif
#ifndef VOLCOMP_NODE_SENTENCES
#define VOLCOMP_NODE_SENTENCES 1
#endif

namespace volcomp::node {

// Points of a touch probe and their judgement on a flank: 2015h, 2017h…2019h, 2300h…2411h.
inline constexpr bool kProbes = VOLCOMP_NODE_PROBING != 0;
// Monitor, learning and offsets of a helical grinder: 201Ah, 2500h.
inline constexpr bool kWatchesStrokes = VOLCOMP_NODE_STROKES != 0;
// Temperatures, expansion of the axes, expiry of tables: 2700h. Without it tables count as at their
// reference temperature, for ever.
inline constexpr bool kFollowsTemperature = VOLCOMP_NODE_THERMAL != 0;
// Rotary axes that hold the direction of the tool. Without it tables of such machines are refused.
inline constexpr bool kOrientsTool = VOLCOMP_NODE_ORIENTS != 0;
// The reason of a refusal in words, 2112h:06. Without it that is empty: 2112h:02 has the code, and
// tools of the host have the sentence.
inline constexpr bool kWritesSentences = VOLCOMP_NODE_SENTENCES != 0;

}  // namespace volcomp::node
