// The table image: what goes in comes out bit for bit, its checks and their order.

#include <cstring>
#include <vector>

#include "comp/core/crc32.hpp"
#include "comp/tables/image.hpp"
#include "comp/tables/image_layout.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes image_of(const MachineTables& tables) {
  Bytes bytes(image_size(tables));
  std::size_t written = 0;
  EXPECT_TRUE(encode_image(tables, bytes, written).ok());
  EXPECT_EQ(written, bytes.size());
  return bytes;
}

Status decode(const Bytes& bytes, MachineTables& out, std::size_t capacity = kTableKnots) {
  return decode_image({bytes.data(), bytes.size()}, capacity, out);
}

// Bit by bit, as zlib describes it, written the other way round (most significant bit first).
std::uint32_t reflected(std::uint32_t value, int bits) {
  std::uint32_t out = 0;
  for (int i = 0; i < bits; ++i)
    out |= ((value >> i) & 1U) << (bits - 1 - i);
  return out;
}

std::uint32_t slow_crc(const std::uint8_t* data, std::size_t size,
                       std::uint32_t polynomial = 0x04C11DB7U) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::size_t i = 0; i < size; ++i) {
    crc ^= reflected(data[i], 8) << 24;
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc & 0x80000000U) != 0 ? (crc << 1) ^ polynomial : crc << 1;
  }
  return ~reflected(crc, 32);
}

void seal(Bytes& bytes) {
  const std::uint32_t crc = slow_crc(bytes.data(), bytes.size() - 4);
  for (unsigned i = 0; i < 4; ++i)
    bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
}

MachineTables any_tables(Random& random) {
  MachineTables t = xyfz_tables(40e3, 4e-5, random);
  t.machine.body[4] = moving_body(4, JointKind::rotary, Axis::z, 1, 3, 'C', {1, 2, 3});
  t.machine.body[5].lower = 5;
  t.machine.body[5].joint.orientation = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  t.machine.body[5].constant_error = {1e-3, -2e-3, 3e-3, 1e-5, -2e-5, 3e-5};
  t.machine.body_count = 6;
  t.machine.tool_body = 6;
  t.axis[3] = random_table(12'345, (std::int64_t{1} << 40) / 37, 37, 10e3, 1e-5, random);
  t.axis[3].periodic = true;
  t.provenance.machine_id = 0xDEADBEEF;
  t.provenance.sequence = 77;
  t.provenance.built_unix_s = -1;
  t.provenance.expires_unix_s = 1'800'000'000;
  t.provenance.temperature_C = 20.25F;
  t.expansion[1] = {-8.5e-6F, 12.5F, 3};
  t.provenance.stamp = {'b', 'e', 'n', 'c', 'h'};
  return t;
}

TEST(Crc32, CheckValueAndReference) {
  const Bytes nine{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc32({nine.data(), nine.size()}), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
  EXPECT_EQ(crc32c({nine.data(), nine.size()}), 0xE3069283U);
  EXPECT_EQ(crc32c({}), 0U);
  Random random(90);
  SCOPED_TRACE(random.trace());
  for (int n = 0; n < 200; ++n) {
    Bytes bytes(static_cast<std::size_t>(random.integer(0, 300)));
    for (std::uint8_t& b : bytes)
      b = static_cast<std::uint8_t>(random.integer(0, 255));
    ASSERT_EQ(crc32({bytes.data(), bytes.size()}), slow_crc(bytes.data(), bytes.size()));
    ASSERT_EQ(crc32c({bytes.data(), bytes.size()}),
              slow_crc(bytes.data(), bytes.size(), 0x1EDC6F41U));
  }
}

// Whatever the tables hold: the CRC-32 of all of an image would not.
TEST(Image, IsNamedByItsClosingCrc) {
  Random random(92);
  SCOPED_TRACE(random.trace());
  const Bytes a = image_of(any_tables(random));
  Bytes b = image_of(any_tables(random));
  ASSERT_EQ(a.size(), b.size());
  EXPECT_NE(image_crc({a.data(), a.size()}), image_crc({b.data(), b.size()}));
  EXPECT_EQ(crc32({a.data(), a.size()}), crc32({b.data(), b.size()}));
  EXPECT_EQ(image_crc({a.data(), a.size()}), slow_crc(a.data(), a.size() - 4));
  EXPECT_EQ(image_crc({a.data(), 3}), 0U);

  // Nor can an image be made of two: axis X of one, the rest of another, all of it intact.
  const MachineTables layout = any_tables(random);
  const auto x = static_cast<std::ptrdiff_t>(image_value_offset(layout, 0, 0, 0, 0));
  const auto y = static_cast<std::ptrdiff_t>(image_value_offset(layout, 1, 0, 0, 0));
  std::copy(a.begin() + x, a.begin() + y, b.begin() + x);
  auto out = std::make_unique<MachineTables>();
  EXPECT_EQ(decode(b, *out).reason, Reason::crc_mismatch);
}

TEST(Image, RoundTripIsBitExact) {
  Random random(91);
  SCOPED_TRACE(random.trace());
  const MachineTables in = any_tables(random);
  const Bytes bytes = image_of(in);
  auto out = std::make_unique<MachineTables>();
  ASSERT_TRUE(decode(bytes, *out).ok());
  EXPECT_EQ(image_of(*out), bytes);
  EXPECT_EQ(out->provenance.machine_id, in.provenance.machine_id);
  EXPECT_EQ(out->provenance.sequence, in.provenance.sequence);
  EXPECT_EQ(out->provenance.built_unix_s, in.provenance.built_unix_s);
  EXPECT_EQ(out->provenance.expires_unix_s, in.provenance.expires_unix_s);
  EXPECT_EQ(out->provenance.temperature_C, in.provenance.temperature_C);
  EXPECT_EQ(out->expansion[0].input, kNoTemperature);
  EXPECT_EQ(out->expansion[1].per_K, -8.5e-6F);
  EXPECT_EQ(out->expansion[1].fixed_mm, 12.5F);
  EXPECT_EQ(out->expansion[1].input, 3);
  EXPECT_EQ(out->provenance.stamp, in.provenance.stamp);
  EXPECT_EQ(out->machine.tool_point, in.machine.tool_point);
  EXPECT_EQ(out->machine.body[5].constant_error, in.machine.body[5].constant_error);
  EXPECT_EQ(out->machine.body[5].joint.orientation, in.machine.body[5].joint.orientation);
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_EQ(out->axis[a].q0, in.axis[a].q0);
    EXPECT_EQ(out->axis[a].pitch, in.axis[a].pitch);
    ASSERT_EQ(out->axis[a].knots, in.axis[a].knots);
    EXPECT_EQ(out->axis[a].periodic, in.axis[a].periodic);
    EXPECT_EQ(out->directions[a], in.directions[a]);
    for (std::size_t travel = 0; travel < 2; ++travel) {
      for (std::uint32_t i = 0; i < in.axis[a].knots; ++i)
        ASSERT_EQ(out->axis[a].value[travel][i], in.axis[a].value[travel][i]);
    }
  }
}

// What no machine has was damaged or given in another unit: a constant error of metres.
TEST(Image, ConstantErrorsBeyondAnyMachineAreRefusedWithTheirBody) {
  Random random(93);
  MachineTables in = any_tables(random);
  const auto out = std::make_unique<MachineTables>();
  for (const double error : {1.5, -1e20, 1e300}) {
    in.machine.body[5].constant_error = {0.0, error, 0.0, 0.0, 0.0, 0.0};
    const Bytes bytes = image_of(in);
    const Status status = decode_image({bytes.data(), bytes.size()}, kDefaultKnots, *out);
    EXPECT_EQ(status.reason, Reason::bound_exceeded) << error;
    EXPECT_EQ(status.where.body, 6) << error;
  }
}

// The layout is a contract with other programs: magic, version, sizes and CRC at their places.
TEST(Image, LayoutIsAsDocumented) {
  Random random(92);
  const MachineTables in = any_tables(random);
  const Bytes bytes = image_of(in);
  EXPECT_EQ(std::memcmp(bytes.data(), "VCT1", 4), 0);
  EXPECT_EQ(bytes[4] + 256 * bytes[5], 4);
  EXPECT_EQ(bytes[6], 4);
  EXPECT_EQ(bytes[7], 6);
  const auto u32 = [&](std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[at + 2]) << 16 |
           static_cast<std::uint32_t>(bytes[at + 3]) << 24;
  };
  EXPECT_EQ(u32(8), bytes.size());
  EXPECT_EQ(u32(12), 0xDEADBEEFU);
  EXPECT_EQ(u32(28), 1'800'000'000U);
  EXPECT_EQ(u32(32), 0U);
  EXPECT_EQ(u32(bytes.size() - 4), slow_crc(bytes.data(), bytes.size() - 4));
  // the stored float is at image_value_offset
  for (const std::size_t axis : {0U, 2U, 3U}) {
    const std::uint32_t raw = u32(image_value_offset(in, axis, 1, 7, 4));
    float value = 0.0F;
    std::memcpy(&value, &raw, 4);
    EXPECT_EQ(value, in.axis[axis].value[1][7][4]);
  }
  // expansion, fixed point and input stand in front of the first of them
  const std::size_t knots_of_y = image_value_offset(in, 1, 0, 0, 0);
  EXPECT_EQ(u32(knots_of_y - 9), 0xB70E9B39U);  // -8.5e-6
  EXPECT_EQ(u32(knots_of_y - 5), 0x41480000U);  // 12.5
  EXPECT_EQ(bytes[knots_of_y - 1], 3);
}

TEST(Image, BufferTooSmallIsRefused) {
  Random random(93);
  const MachineTables in = any_tables(random);
  Bytes bytes(image_size(in) - 1, 0xAA);
  std::size_t written = 5;
  EXPECT_EQ(encode_image(in, bytes, written).reason, Reason::image_truncated);
  EXPECT_EQ(bytes, Bytes(bytes.size(), 0xAA)) << "nothing is written";
}

TEST(Image, WrongMagicVersionAndCapacity) {
  Random random(94);
  const Bytes good = image_of(any_tables(random));
  auto out = std::make_unique<MachineTables>();
  for (std::size_t i = 0; i < 4; ++i) {
    Bytes bad = good;
    bad[i] ^= 0x20U;
    seal(bad);
    EXPECT_EQ(decode(bad, *out).reason, Reason::bad_magic);
  }
  for (const unsigned version : {0U, 1U, 2U, 3U, 5U, 0x100U, 0xFFFFU}) {
    Bytes bad = good;
    bad[4] = static_cast<std::uint8_t>(version & 0xFFU);
    bad[5] = static_cast<std::uint8_t>(version >> 8);
    seal(bad);
    EXPECT_EQ(decode(bad, *out).reason, Reason::version_unknown);
  }
  EXPECT_TRUE(decode(good, *out, 37).ok());
  const Status status = decode(good, *out, 36);
  EXPECT_EQ(status.reason, Reason::too_many_knots);
  EXPECT_EQ(status.where.axis, 'C');
}

TEST(Image, NotANumberBehindACorrectCrcIsRefusedWithItsPlace) {
  Random random(95);
  const MachineTables in = any_tables(random);
  const Bytes good = image_of(in);
  auto out = std::make_unique<MachineTables>();
  for (const std::uint32_t pattern : {0x7FC00000U, 0x7F800000U, 0xFF800000U, 0x7F800001U}) {
    for (const std::size_t axis : {0U, 3U}) {
      Bytes bad = good;
      const std::size_t at = image_value_offset(in, axis, 1, 6, 5);
      for (unsigned i = 0; i < 4; ++i)
        bad[at + i] = static_cast<std::uint8_t>(pattern >> (8 * i));
      seal(bad);
      const Status status = decode(bad, *out);
      EXPECT_EQ(status.reason, Reason::not_finite);
      EXPECT_EQ(status.where.axis, axis == 0 ? 'X' : 'C');
      EXPECT_EQ(status.where.index, 6);
      EXPECT_EQ(status.where.channel, 5);
    }
  }
}

// Damage behind a correct CRC: every field of the header and the machine has its own check.
TEST(Image, OtherMachineShapesAreRefused) {
  Random random(96);
  const MachineTables in = any_tables(random);
  auto out = std::make_unique<MachineTables>();
  const auto refused = [&](auto&& change) {
    MachineTables bad = in;
    change(bad);
    Bytes bytes = image_of(bad);
    return decode(bytes, *out).reason;
  };
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.body[2].lower = 4; }),
            Reason::parent_not_lower);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.body[2].lower = 0; }), Reason::not_one_root);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.tool_body = 7; }), Reason::bad_body);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.work_body = 0; }), Reason::bad_body);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.body[1].joint.sign = 0; }), Reason::bad_joint);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.body[1].joint.nc_axis = 0; }),
            Reason::bad_axis_index);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.body[5].joint.orientation[0] = 1e-6; }),
            Reason::not_a_rotation);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.correcting[1] = 4; }), Reason::bad_axis_index);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.correcting_count = 4; }),
            Reason::bad_axis_index);
  EXPECT_EQ(refused([](MachineTables& t) { t.machine.tool_point[2] = std::nan(""); }),
            Reason::not_finite);
  EXPECT_EQ(refused([](MachineTables& t) { t.directions[1].y() = HUGE_VAL; }), Reason::not_finite);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[1].knots = 1; }), Reason::too_few_knots);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[1].pitch = 0; }), Reason::pitch_not_positive);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[1].pitch = -5; }), Reason::pitch_not_positive);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[1].pitch = 429'496'730; }),
            Reason::travel_too_long);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[1].q0 = -10'000'000'000'001; }),
            Reason::travel_too_long);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[1].periodic = true; }), Reason::not_periodic);
  EXPECT_EQ(refused([](MachineTables& t) { t.axis[3].pitch -= 1'000; }), Reason::not_periodic);
  EXPECT_EQ(refused([](MachineTables&) {}), Reason::ok);
}

// Bytes that stand for no joint, bodies that have no place, axes that are not those of the machine.
TEST(Image, NumbersThatAMachineCannotHaveAreRefused) {
  Random random(96);
  const Bytes good = image_of(any_tables(random));
  auto out = std::make_unique<MachineTables>();
  const auto refused = [&](std::size_t at, unsigned value) {
    Bytes bad = good;
    bad[at] = static_cast<std::uint8_t>(value);
    seal(bad);
    return decode(bad, *out);
  };
  const std::size_t second_body = image_layout::first_axis(1);
  const Status kind = refused(second_body + 1, 3);
  EXPECT_EQ(kind.reason, Reason::bad_joint);
  EXPECT_EQ(kind.where.body, 2);
  EXPECT_EQ(refused(second_body + 2, 3).reason, Reason::bad_joint);
  EXPECT_EQ(refused(image_layout::kBodiesAt, kMaxBodies + 1).reason, Reason::too_many_bodies);
  EXPECT_EQ(refused(image_layout::kAxesAt, good[image_layout::kAxesAt] + 1U).reason,
            Reason::axes_mismatch);
}

// Cut anywhere, with size and CRC made right again: exact-size copies, so that a sanitizer sees any
// read beyond the end.
TEST(Image, ASealedPieceOfAnImageIsRefused) {
  Random random(96);
  const Bytes good = image_of(any_tables(random));
  auto out = std::make_unique<MachineTables>();
  for (std::size_t size = 12; size < good.size(); size += size < 2000 ? 1 : 37) {
    Bytes piece(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    for (std::size_t i = 0; i < 4; ++i)
      piece[8 + i] = static_cast<std::uint8_t>(size >> (8 * i));
    if (size >= 16) seal(piece);
    EXPECT_FALSE(decode(piece, *out).ok()) << size;
  }
}

// One axis twice among the correcting ones is not two correcting axes.
TEST(Image, ARepeatedCorrectingAxisIsRefused) {
  Random random(97);
  MachineTables in = any_tables(random);
  in.machine.correcting = {0, 0, 1};
  auto out = std::make_unique<MachineTables>();
  EXPECT_EQ(decode(image_of(in), *out).reason, Reason::bad_axis_index);
}

// Tables that end before or after the image does, behind a correct CRC.
TEST(Image, TablesThatDoNotFillTheImageAreRefused) {
  Random random(98);
  const MachineTables in = any_tables(random);
  const Bytes good = image_of(in);
  auto out = std::make_unique<MachineTables>();
  const std::size_t knots_at = image_value_offset(in, 3, 0, 0, 0) - 9 - 24 - 1 - 4;
  ASSERT_EQ(good[knots_at], 37);
  for (const int knots : {36, 38, 500}) {
    Bytes bad = good;
    bad[knots_at] = static_cast<std::uint8_t>(knots & 0xFF);
    bad[knots_at + 1] = static_cast<std::uint8_t>(knots >> 8);
    bad[knots_at + 4] = 0;  // not periodic: any number of knots spans less than a turn
    for (std::size_t i = 0; i < 8; ++i)
      bad[knots_at - 8 + i] = i == 1 ? 1 : 0;  // pitch 2^-32 turn
    seal(bad);
    EXPECT_EQ(decode(bad, *out).reason, Reason::image_truncated) << knots;
  }
}

// A node folds the bytes of an image, the host its numbers: the same for the tick.
TEST(Image, TheViewFoldsLikeTheTables) {
  Random random(99);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = any_tables(random);
  const Bytes image = image_of(tables);
  auto view = std::make_unique<TablesView>();
  ASSERT_TRUE(check_image({image.data(), image.size()}, kTableKnots, *view).ok());
  LoadedRunner of_tables(tables.machine);
  LoadedRunner of_image(tables.machine);
  ASSERT_TRUE(of_tables.start(tables).ok());
  ASSERT_TRUE(of_image.compensator->configure(open_settings<5>()).ok());
  ASSERT_TRUE(of_image.compensator->stage(*view, tool_of(tables.machine), 0).ok());
  ASSERT_TRUE(of_image.compensator->activate().ok());
  for (int n = 0; n < 10'000; ++n) {
    const LoadedRunner::Positions q{
        random.integer(-510'000'000, 10'000'000), random.integer(-310'000'000, 10'000'000),
        random.integer(-410'000'000, 10'000'000),
        random.integer(-(std::int64_t{1} << 42), std::int64_t{1} << 42), 0};
    ASSERT_EQ(of_tables.tick(q).offset, of_image.tick(q).offset) << "point " << n;
    ASSERT_EQ(of_tables.out.status, of_image.out.status) << "point " << n;
  }
}

}  // namespace
}  // namespace volcomp::test
