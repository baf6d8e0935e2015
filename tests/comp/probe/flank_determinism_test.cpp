// A gear is derived and touches on its flanks are judged the same, bit for bit, with every
// compiler, on the host and on the boards.

#include <cstring>

#include "comp/core/units.hpp"
#include "comp/probe/face_touch.hpp"
#include "tests/oracle/fixed_numbers.hpp"

namespace volcomp::test {
namespace {

constexpr int kTouches = 3'000;

// Obtained with g++ 12 at -O2 on x86-64, and the same on the M7 and the M4F.
constexpr std::uint32_t kDigest = 2'847'782'101;

void add(Digest& digest, double value) {
  std::uint64_t bits = 0;
  // Which NaN is no matter of arithmetic.
  if (value <= 0.0 || value >= 0.0) std::memcpy(&bits, &value, sizeof bits);
  digest.add(bits, sizeof bits);
}

TEST(FlankDeterminism, SameBitsEverywhere) {
  const FaceGear gear = face_gear_of_table_3();
  Digest digest;
  add(digest, gear.undercut_radius);
  add(digest, gear.pointing_radius);
  add(digest, gear.theta_tip);
  digest.end_record();
  Fixed fixed;
  int good = 0;
  for (int i = 0; i < kTouches; ++i) {
    FaceFlank flank;
    const auto side = fixed.integer(0, 1) != 0 ? 1 : -1;
    ASSERT_TRUE(choose_flank(gear, side, static_cast<int>(fixed.integer(0, 85)), flank).ok());
    // Around the middle of the slot, tips and roots included; nanometres.
    const auto x = static_cast<double>(fixed.integer(155'000'000, 190'000'000));
    const auto y = static_cast<double>(fixed.integer(-5'000'000, 5'000'000));
    const auto z = static_cast<double>(fixed.integer(45'000'000, 56'000'000));
    const Vec3 near(x / kNmPerMm, y / kNmPerMm, z / kNmPerMm);
    const FaceTouch touch =
        judge_touch(gear, flank, {0.5, 1.0}, from_flank({1.0, flank.cosine, flank.sine}, near));
    add(digest, touch.distance);
    add(digest, touch.other);
    for (int k = 0; k < 3; ++k)
      add(digest, touch.foot.point[k]);
    digest.add(static_cast<std::uint64_t>(touch.verdict), 1);
    digest.add(static_cast<std::uint64_t>(touch.foot.reason), 1);
    digest.end_record();
    if (touch.verdict == Reason::ok) ++good;
  }
  EXPECT_GT(good, kTouches / 10);
  EXPECT_EQ(digest.value(), kDigest);
}

}  // namespace
}  // namespace volcomp::test
