#include "firmware/node/strokes/learned_image.hpp"

#include <cmath>

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"

namespace volcomp::node {

namespace {

constexpr std::array<char, 8> kMagic{'V', 'C', 'S', 'T', 'R', 'O', 'K', 'E'};

// Places in the header.
constexpr std::size_t kMachine = 8;
constexpr std::size_t kNodes = 12;
constexpr std::size_t kSlots = 14;
constexpr std::size_t kFirst = 16;
constexpr std::size_t kPitch = 24;
constexpr std::size_t kFeed = 28;

LearnedLayout layout_of(Span<const std::uint8_t> image) {
  const std::uint8_t* const at = image.data();
  LearnedLayout layout;
  layout.machine_id = load_u32(at + kMachine);
  layout.nodes = static_cast<std::uint16_t>(load_le(at + kNodes, 2));
  layout.slots = static_cast<std::uint16_t>(load_le(at + kSlots, 2));
  layout.first_node_nm = load_le_signed(at + kFirst, 8);
  layout.pitch_nm = load_u32(at + kPitch);
  layout.feed_nm_per_s = static_cast<std::int32_t>(load_le_signed(at + kFeed, 4));
  return layout;
}

Status whole(Span<const std::uint8_t> image) {
  if (image.size() < kLearnedHeader + 4) return refuse(Reason::image_truncated);
  for (std::size_t i = 0; i < kMagic.size(); ++i) {
    if (image[i] != static_cast<std::uint8_t>(kMagic[i])) return refuse(Reason::bad_magic);
  }
  if (image.size() != layout_of(image).bytes()) return refuse(Reason::image_truncated);
  const std::size_t last = image.size() - 4;
  const bool intact = crc32({image.data(), last}) == load_le(image.data() + last, 4);
  return intact ? Status{} : refuse(Reason::crc_mismatch);
}

Status fits(const LearnedLayout& its, const LearnedLayout& mine) {
  const bool any = mine.machine_id == 0 || its.machine_id == 0;
  if (!any && its.machine_id != mine.machine_id) return refuse(Reason::machine_mismatch);
  Where where;
  if (its.nodes != mine.nodes) where.field = "nodes";
  if (its.slots != mine.slots) where.field = "slots";
  if (its.first_node_nm != mine.first_node_nm) where.field = "first node";
  if (its.pitch_nm != mine.pitch_nm) where.field = "pitch";
  if (where.field != nullptr) return refuse(Reason::length_mismatch, where);
  if (its.feed_nm_per_s > 0) return {};
  where.field = "feed";
  return refuse(Reason::bad_setting, where);
}

}  // namespace

void store_real(std::uint8_t* at, double value) {
  store_le(at, 4, bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void encode_learned(const LearnedLayout& layout, const LearnedTables& tables,
                    Span<std::uint8_t> out) {
  std::uint8_t* const begin = out.data();
  for (std::size_t i = 0; i < kMagic.size(); ++i)
    begin[i] = static_cast<std::uint8_t>(kMagic[i]);
  store_le(begin + kMachine, 4, layout.machine_id);
  store_le(begin + kNodes, 2, layout.nodes);
  store_le(begin + kSlots, 2, layout.slots);
  store_le(begin + kFirst, 8, static_cast<std::uint64_t>(layout.first_node_nm));
  store_le(begin + kPitch, 4, layout.pitch_nm);
  store_le(begin + kFeed, 4, static_cast<std::uint32_t>(layout.feed_nm_per_s));
  std::uint8_t* at = begin + kLearnedHeader;
  for (const Span<const double> table : {tables.forward, tables.backward, tables.slot}) {
    for (const double value : table) {
      store_real(at, value);
      at += 4;
    }
  }
  store_le(at, 4, crc32({begin, layout.bytes() - 4}));
}

Status check_learned(Span<const std::uint8_t> image, const LearnedLayout& mine,
                     double most_offset) {
  if (const Status s = whole(image); !s.ok()) return s;
  const LearnedLayout its = layout_of(image);
  if (const Status s = fits(its, mine); !s.ok()) return s;
  Where where;
  for (std::size_t k = 0; k < its.values(); ++k) {
    const double value = learned_value(image, k);
    where.index = static_cast<int>(k);
    if (!std::isfinite(value)) return refuse(Reason::not_finite, where);
    // The image holds floats: one more step of them is not beyond.
    if (std::abs(value) > most_offset * (1.0 + 1e-6)) return refuse(Reason::bound_exceeded, where);
  }
  return {};
}

std::int32_t learned_feed(Span<const std::uint8_t> image) { return layout_of(image).feed_nm_per_s; }

double learned_value(Span<const std::uint8_t> image, std::size_t index) {
  return static_cast<double>(load_f32(&image[kLearnedHeader + 4 * index]));
}

}  // namespace volcomp::node
