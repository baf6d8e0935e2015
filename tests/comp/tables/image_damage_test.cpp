// Damage without a matching checksum: every bit, every length, and which axis was hit.

#include <vector>

#include "comp/tables/image.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

MachineTables small_tables(Random& random) {
  MachineTables t = xyfz_tables(40e3, 4e-5, random);
  for (std::size_t a = 0; a < 3; ++a)
    t.axis[a] = random_table(-100'000'000, 50'000'000, 3, 40e3, 4e-5, random);
  t.provenance.expires_unix_s = 1'800'000'000;
  for (std::size_t a = 0; a < 3; ++a)
    t.expansion[a] = {11.7e-6F, -100.0F, static_cast<std::uint8_t>(a)};
  return t;
}

Bytes encode(const MachineTables& tables) {
  Bytes bytes(image_size(tables));
  std::size_t written = 0;
  EXPECT_TRUE(encode_image(tables, bytes, written).ok());
  return bytes;
}

class ImageDamage : public ::testing::Test {
 protected:
  Status decode(const std::uint8_t* data, std::size_t size) {
    return decode_image({data, size}, kTableKnots, *out);
  }

  Random random{98};
  MachineTables tables = small_tables(random);
  Bytes good = encode(tables);
  std::unique_ptr<MachineTables> out = std::make_unique<MachineTables>();
};

TEST_F(ImageDamage, UndamagedIsAccepted) { EXPECT_TRUE(decode(good.data(), good.size()).ok()); }

TEST_F(ImageDamage, EverySingleBitFlipIsRefused) {
  Bytes bad = good;
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      bad[byte] ^= static_cast<std::uint8_t>(1U << bit);
      const Status status = decode(bad.data(), bad.size());
      ASSERT_FALSE(status.ok()) << "byte " << byte << " bit " << bit;
      const Reason expected = byte < 4                 ? Reason::bad_magic
                              : byte < 6               ? Reason::version_unknown
                              : byte >= 8 && byte < 12 ? Reason::image_truncated
                                                       : Reason::crc_mismatch;
      ASSERT_EQ(status.reason, expected) << "byte " << byte << " bit " << bit;
      bad[byte] ^= static_cast<std::uint8_t>(1U << bit);
    }
  }
}

// Exact-size copies, so that a sanitizer sees any read beyond the end.
TEST_F(ImageDamage, EveryTruncationIsRefused) {
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::vector<std::uint8_t> cut(good.begin(),
                                        good.begin() + static_cast<std::ptrdiff_t>(size));
    const Status status = decode(cut.data(), cut.size());
    ASSERT_FALSE(status.ok()) << size;
    if (size >= 12) {
      ASSERT_EQ(status.reason, Reason::image_truncated) << size;
    }
  }
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_EQ(decode(longer.data(), longer.size()).reason, Reason::image_truncated);
}

TEST_F(ImageDamage, TheAxisIsNamed) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t knot = 0; knot < 3; ++knot) {
      Bytes bad = good;
      bad[image_value_offset(tables, axis, 0, knot, 2)] ^= 0x01U;
      const Status status = decode(bad.data(), bad.size());
      EXPECT_EQ(status.reason, Reason::crc_mismatch);
      EXPECT_EQ(status.where.axis, "XYZ"[axis]);
    }
  }
  Bytes bad = good;
  bad[20] ^= 0x01U;  // provenance: no axis to blame
  EXPECT_EQ(decode(bad.data(), bad.size()).where.axis, '\0');
}

// A knot count that lies must not send the search for the damaged axis astray.
TEST_F(ImageDamage, LyingKnotCountsAreHarmless) {
  const std::size_t knots_at = image_value_offset(tables, 0, 0, 0, 0) - 9 - 24 - 1 - 4;
  ASSERT_EQ(good[knots_at], 3);
  for (const std::uint32_t lie :
       {0U, 1U, 2U, 4U, 0x0FFFFFFFU, 0x0AAAAAA9U, 0x7FFFFFFFU, 0xFFFFFFFFU, 0x05555555U}) {
    Bytes bad = good;
    for (unsigned i = 0; i < 4; ++i)
      bad[knots_at + i] = static_cast<std::uint8_t>(lie >> (8 * i));
    const Status status = decode(bad.data(), bad.size());
    EXPECT_EQ(status.reason, Reason::crc_mismatch) << lie;
    EXPECT_EQ(status.where.axis, 'X') << lie;
  }
}

TEST_F(ImageDamage, RandomBytesAreNeverAnImage) {
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 20'000; ++n) {
    Bytes bad = good;
    const std::int64_t hits = random.integer(1, 40);
    for (std::int64_t k = 0; k < hits; ++k) {
      const auto at =
          static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(bad.size()) - 1));
      bad[at] = static_cast<std::uint8_t>(random.integer(0, 255));
    }
    if (bad == good) continue;
    ASSERT_FALSE(decode(bad.data(), bad.size()).ok());
  }
}

}  // namespace
}  // namespace volcomp::test
