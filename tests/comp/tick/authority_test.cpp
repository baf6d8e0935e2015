// Columns of the Jacobian that span too little: no offset is made of them.

#include <cmath>
#include <functional>
#include <limits>

#include "comp/tick/motion_inverse.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using kernel::Columns;
using kernel::Excess;

constexpr Float3 kX{1.0F, 0.0F, 0.0F};
constexpr Float3 kY{0.0F, 1.0F, 0.0F};
constexpr Float3 kZ{0.0F, 0.0F, 1.0F};
constexpr Float3 kNone{};
constexpr Float3 kError{3.0F, -4.0F, 5.0F};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Whether it was solved; if not, the offsets are those of before.
bool solved(const std::function<bool(Excess&)>& solve) {
  Excess out{7.0F, 7.0F, 7.0F};
  const bool done = solve(out);
  EXPECT_TRUE(done || out == (Excess{7.0F, 7.0F, 7.0F}));
  return done;
}

TEST(Authority, ThreeColumnsHaveToSpanSpace) {
  const auto three = [](const Float3& a, const Float3& b, const Float3& c) {
    return solved([&](Excess& out) { return kernel::solve_three({a, b, c}, kError, out); });
  };
  EXPECT_TRUE(three(kX, kY, kZ));
  EXPECT_FALSE(three(kX, kY, kX));
  EXPECT_FALSE(three(kX, kNone, kZ));
  EXPECT_FALSE(three(kX, kY, {0.0F, kNan, 1.0F}));
  // Conventions, section 4: the determinant of unit columns reaches 0.1.
  EXPECT_FALSE(three(kX, kY, {std::cos(0.09F), 0.0F, std::sin(0.09F)}));
  EXPECT_TRUE(three(kX, kY, {std::cos(0.11F), 0.0F, std::sin(0.11F)}));
}

TEST(Authority, TwoColumnsHaveToSpanAPlane) {
  const auto two = [](const Float3& a, const Float3& b) {
    return solved([&](Excess& out) { return kernel::solve_two(a, b, kError, out); });
  };
  EXPECT_TRUE(two(kX, kZ));
  EXPECT_FALSE(two(kX, kX));
  EXPECT_FALSE(two(kX, kNone));
  EXPECT_FALSE(two({kNan, 0.0F, 0.0F}, kY));
}

TEST(Authority, OneColumnHasToBeThere) {
  const auto one = [](const Float3& a) {
    return solved([&](Excess& out) { return kernel::solve_one(a, kError, out); });
  };
  EXPECT_TRUE(one(kY));
  EXPECT_FALSE(one(kNone));
  EXPECT_FALSE(one({0.0F, kNan, 0.0F}));
}

TEST(Authority, WithoutACorrectingAxisThereIsNone) {
  MachineDescription idle = kXyfzMachine;
  idle.correcting_count = 0;
  const LoadedMachine<5> machine{make_runtime_chain(idle)};
  const Columns columns{kX, kY, kZ};
  EXPECT_FALSE(solved([&](Excess& out) { return kernel::solve(machine, columns, kError, out); }));
}

}  // namespace
}  // namespace volcomp::test
