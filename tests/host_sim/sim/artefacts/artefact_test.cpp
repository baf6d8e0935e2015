// Gaps to plane, sphere and mandrel, against a drawing.

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/sim/artefacts/mandrel.hpp"
#include "host_sim/sim/artefacts/sphere.hpp"
#include "tests/host_sim/sim/artefacts/plane.hpp"

namespace volcomp::sim {
namespace {

using test::Plane;

constexpr double kBall = 1.5;

// 3-4-5: the plane through (0, 0, 5) that leans by 4 in 3.
TEST(Plane, GapIsAlongItsNormalWhateverItsLength) {
  const Plane plane({0.0, 0.0, 5.0}, {0.0, 6.0, 8.0});
  const Gap gap = plane.gap({7.0, 10.0, 5.0}, kBall);
  EXPECT_NEAR(gap.mm, 6.0 - kBall, 1e-14);
  EXPECT_LT((gap.normal - Vec3(0.0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_NEAR(plane.gap({-3.0, 0.0, 0.0}, kBall).mm, -4.0 - kBall, 1e-14);
}

// 2-3-6: seven away from the centre.
TEST(Sphere, GapIsRadial) {
  const Sphere sphere({10.0, 20.0, 30.0}, 5.0);
  const Gap gap = sphere.gap({12.0, 23.0, 36.0}, kBall);
  EXPECT_NEAR(gap.mm, 7.0 - 5.0 - kBall, 1e-14);
  EXPECT_LT((gap.normal - Vec3(2.0, 3.0, 6.0) / 7.0).norm(), 1e-15);
  EXPECT_NEAR(sphere.gap({10.0, 20.0, 30.0}, kBall).mm, -5.0 - kBall, 1e-15);
}

TEST(Mandrel, GapDoesNotDependOnX) {
  const Mandrel mandrel(15.0, 1.0, 2.0);
  for (const double x : {-300.0, 0.0, 12.3}) {
    const Gap gap = mandrel.gap({x, 1.0 - 12.0, 2.0 + 16.0}, kBall);
    EXPECT_NEAR(gap.mm, 20.0 - 15.0 - kBall, 1e-14);
    EXPECT_LT((gap.normal - Vec3(0.0, -0.6, 0.8)).norm(), 1e-15);
  }
  EXPECT_NEAR(mandrel.gap({0.0, 1.0, 2.0}, kBall).mm, -15.0 - kBall, 1e-15);
}

// Away from the material by a step along the normal, the gap grows by just that step.
TEST(Artefacts, NormalIsTheWayOut) {
  const Plane plane({1.0, 2.0, 3.0}, {1.0, -2.0, 0.5});
  const Sphere sphere({1.0, 2.0, 3.0}, 4.0);
  const Mandrel mandrel(4.0, 2.0, 3.0);
  for (const Artefact* artefact :
       std::initializer_list<const Artefact*>{&plane, &sphere, &mandrel}) {
    const Vec3 at(2.0, 7.0, -4.0);
    const Gap gap = artefact->gap(at, kBall);
    EXPECT_NEAR(gap.normal.norm(), 1.0, 1e-14);
    EXPECT_NEAR(artefact->gap(at + 0.7 * gap.normal, kBall).mm, gap.mm + 0.7, 1e-13);
  }
}

}  // namespace
}  // namespace volcomp::sim
