// One fixed sequence of touches of face gears gives the same verdicts and feet, bit for bit, with
// every compiler, optimisation and sanitizer, on the host and on the boards.

#include <cstring>

#include "comp/probe/face_relief.hpp"
#include "comp/probe/face_touch.hpp"
#include "tests/oracle/fixed_numbers.hpp"

namespace volcomp::test {
namespace {

constexpr int kTouches = 2'000;

// Obtained with g++ 12 at -O2 on x86-64, and the same on the M7 and the M4F. A change of it is a
// change of the arithmetic, which the conventions (section 5) forbid to happen by itself.
constexpr std::uint32_t kDigest = 2'362'920'668;

void add(Digest& digest, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  digest.add(bits, 8);
}

void add_foot(Digest& digest, const FaceFoot& foot) {
  digest.add(static_cast<std::uint64_t>(foot.reason), 1);
  if (has_distance(foot.reason)) {
    add(digest, foot.distance);
    add(digest, foot.theta);
    add(digest, foot.beta);
    for (Eigen::Index k = 0; k < 3; ++k) {
      add(digest, foot.point[k]);
      add(digest, foot.normal[k]);
    }
  }
  digest.end_record();
}

// Anywhere around the slots, nm: most balls touch nothing, some have no foot.
Vec3 fixed_centre(Fixed& fixed, const FaceGear& gear) {
  const auto radius = static_cast<std::int64_t>(1e6 * gear.arm);
  const auto depth = static_cast<std::int64_t>(1e6 * gear.z_tip);
  const auto x = static_cast<double>(fixed.integer(radius - 1'000'000, radius + 40'000'000)) / 1e6;
  const auto y = static_cast<double>(fixed.integer(-7'000'000, 7'000'000)) / 1e6;
  const auto z = static_cast<double>(fixed.integer(depth - 1'000'000, depth + 10'000'000)) / 1e6;
  return {x, y, z};
}

TEST(FaceDeterminism, SameBitsEverywhere) {
  Fixed fixed;
  Digest digest;
  for (const FaceGear& gear : {face_gear_of_table_1(), face_gear_of_table_3()}) {
    for (int i = 0; i < kTouches; ++i) {
      FaceFlank flank;
      const int side = fixed.integer(0, 1) == 0 ? 1 : -1;
      const auto slot = static_cast<int>(fixed.integer(0, gear.teeth - 1));
      ASSERT_TRUE(choose_flank(gear, side, slot, flank).ok());
      const Vec3 q = from_flank(flank, fixed_centre(fixed, gear));
      const FaceTouch touch = judge_touch(gear, flank, {0.5, 0.25}, q);
      digest.add(static_cast<std::uint64_t>(touch.verdict), 1);
      if (has_distance(touch.foot.reason)) {
        add(digest, touch.distance);
        add(digest, touch.other);
      }
      add_foot(digest, touch.foot);
      add_foot(digest, distance_from_relieved_face(gear, flank, q));
    }
  }
  EXPECT_EQ(digest.value(), kDigest);
}

}  // namespace
}  // namespace volcomp::test
