#pragma once
// The error maps of the paper's Tables 5 to 8: one pair of flanks, measured twice
// (docs/papers/face-gear.md).

#include <cstdint>

#include "comp/metrology/faces/error_map.hpp"

namespace volcomp::face_gear {

enum class PublishedMap : std::uint8_t {
  machine,  // Tables 5 and 6: on the machine
  centre,   // Tables 7 and 8: on a gear measuring centre
};

// `side`: 0 left, 1 right. µm. The sign, which end of a row or column is which, and which flank is
// "left" are not printed: excess is taken as positive, row 1 as tip, column 1 as inside.
[[nodiscard]] ErrorMap published_map(PublishedMap from, std::size_t side);

}  // namespace volcomp::face_gear
