#pragma once
// The table image: one machine with its tables as bytes, little-endian, closed by a CRC-32 over
// everything before it. This is what is stored, downloaded and validated. Layout:
//
//   header   magic "VCT1" · version u16 · axes u8 · bodies u8 · bytes u32 (whole image) ·
//   machine_id u32 · sequence u32 ·
//            built_unix_s i64 · expires_unix_s i64 (0: never) · temperature_C f32 · stamp char[16]
//   machine  work u8 · tool u8 · correcting count u8 · correcting u8[3] · orienting count u8 ·
//            orienting u8[2] · tool point f64[3] · bodies
//   body     lower u8 · kind u8 · axis u8 · sign i8 · NC axis u8 · letter u8 · offset f64[3]
//   · orientation f64[9] ·
//            constant error f64[6]
//   axis     q0 i64 · pitch i64 · knots u32 · periodic u8 · direction f64[3] ·
//            expansion per K f32 · its fixed point, mm, f32 · temperature input u8 (255: none) ·
//            forward f32[knots][6] · backward likewise ·
//            crc32c u32 over this block, so that a damaged image can name the axis (not crc32: the
//            one at the end would not depend on the block any more, see crc32.hpp)
//   end      crc32 u32 over everything before it

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/tables/tables_view.hpp"

namespace volcomp {

inline constexpr std::uint16_t kImageVersion = 4;

// Bytes the image of these tables takes.
[[nodiscard]] std::size_t image_size(const MachineTables& tables);

// Writes the image; `written` = image_size. Refuses image_truncated when `out` is too small.
Status encode_image(const MachineTables& tables, Span<std::uint8_t> out, std::size_t& written);

// Validates, and gives a view of the tables where they lie: nothing is copied but the machine
// description. Order: bad_magic, version_unknown, image_truncated, crc_mismatch (where.axis if it
// is known), bad_thermal (header), then the machine (as MachineChain::build), then per axis
// too_few_knots, too_many_knots (> capacity), pitch_not_positive, travel_too_long, not_finite,
// bad_thermal; image_truncated also where the tables do not end with the image. The view is valid
// as long as the bytes stay; after a refusal it must not be used.
Status check_image(Span<const std::uint8_t> image, std::size_t capacity, TablesView& out);

// The machine of an image that check_image accepts, as it was written.
Status read_machine(Span<const std::uint8_t> image, MachineDescription& out);

// check_image, then a copy. On refusal the content of `out` is unspecified: decode into a spare,
// never into what is active.
Status decode_image(Span<const std::uint8_t> image, std::size_t capacity, MachineTables& out);

// The number that names an image: its closing CRC-32, computed again. 0 for fewer than 4 bytes.
[[nodiscard]] std::uint32_t image_crc(Span<const std::uint8_t> image);

// Where a stored float sits in an image: for diagnosis and for tests that damage it. travel 0 =
// forward, 1 = backward.
[[nodiscard]] std::size_t image_value_offset(const MachineTables& tables, std::size_t axis,
                                             std::size_t travel, std::size_t knot,
                                             std::size_t channel);

}  // namespace volcomp
