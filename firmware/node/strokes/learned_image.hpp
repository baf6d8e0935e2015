#pragma once
// Learned tables as bytes: what is read and written as 2526h:01 and kept in the store. Layout: see
// kLearnedHeader.

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"

namespace volcomp::node {

// Where the nodes are, and for which feed the tables hold.
struct LearnedLayout {
  std::uint32_t machine_id = 0;
  std::uint16_t nodes = 0;
  std::uint16_t slots = 0;
  std::int64_t first_node_nm = 0;
  std::uint32_t pitch_nm = 0;
  std::int32_t feed_nm_per_s = 0;

  [[nodiscard]] constexpr std::size_t values() const { return 2U * nodes + slots; }
  [[nodiscard]] constexpr std::size_t bytes() const { return kLearnedHeader + 4 * values() + 4; }
};

// Offsets in rad: forward, backward, slots.
struct LearnedTables {
  Span<const double> forward;
  Span<const double> backward;
  Span<const double> slot;
};

// `out` has layout.bytes(); the tables have the lengths of the layout.
void encode_learned(const LearnedLayout& layout, const LearnedTables& tables,
                    Span<std::uint8_t> out);

// Whether these bytes are tables for a grinder like `mine`, whose feed is ignored and whose machine
// id 0 matches any machine. Refused: bad_magic, image_truncated (also too long), crc_mismatch,
// machine_mismatch, length_mismatch (field: what differs), bad_setting ("feed"), not_finite and
// bound_exceeded (beyond ±most_offset) with index.
Status check_learned(Span<const std::uint8_t> image, const LearnedLayout& mine, double most_offset);

// Four bytes: a float, little-endian.
void store_real(std::uint8_t* at, double value);

// Both read an image that was checked.
[[nodiscard]] std::int32_t learned_feed(Span<const std::uint8_t> image);
[[nodiscard]] double learned_value(Span<const std::uint8_t> image, std::size_t index);

}  // namespace volcomp::node
