// Body and face diagonals, with the figures of docs/papers/xyfz.md.

#include <vector>

#include <gtest/gtest.h>

#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/diagonals.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

template <class ErrorAt>
std::array<double, 4> end_values(const ErrorAt& error, const DiagonalBox& box) {
  std::array<double, 4> end{};
  const std::array<Diagonal, 4> diagonals = body_diagonals(box);
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 5> deviation{};
    DiagonalFigures figures;
    EXPECT_TRUE(diagonal_deviations(error, diagonals[i], deviation, figures).ok());
    end[i] = deviation[4];
  }
  return end;
}

Vec3 paper_squareness(const Vec3& q) {  // Table 6, µrad
  const DirectionErrors d = xyfz_directions({127.264e-6, 222.190e-6, 17.356e-6});
  return d[0] * q.x() + d[1] * q.y() + d[2] * q.z();
}

// Squareness alone moves the four diagonals by these µm, strokes of Table 5.
TEST(Diagonals, SquarenessOfThePaperOnTheStrokesOfTableFive) {
  const auto end = end_values(paper_squareness, {{-500, -300, -400}, {0, 0, 0}});
  const std::array<double, 4> printed{86.9, -92.8, 38.8, -32.9};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(1e3 * end[i], printed[i], 0.05) << i;
}

TEST(Diagonals, SquarenessOfThePaperOnTheDiagonalOfTheText) {
  const auto end = end_values(paper_squareness, {{0, 0, 0}, {500, 400, 300}});
  const std::array<double, 4> printed{80.2, -86.1, 14.1, -8.2};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(1e3 * end[i], printed[i], 0.05) << i;
  const Diagonal ppp = body_diagonals({{0, 0, 0}, {500, 400, 300}})[0];
  EXPECT_NEAR(ppp.length(), 707.107, 0.0005);
}

TEST(Diagonals, RunBetweenTheRightCorners) {
  const DiagonalBox box{{-5, -3, -4}, {1, 2, 3}};
  const auto body = body_diagonals(box);
  const std::array<Vec3, 4> start{Vec3(-5, -3, -4), Vec3(1, -3, -4), Vec3(-5, 2, -4),
                                  Vec3(-5, -3, 3)};
  const std::array<Vec3, 4> end{Vec3(1, 2, 3), Vec3(-5, 2, 3), Vec3(1, -3, 3), Vec3(1, 2, -4)};
  const std::array<std::string, 4> name{"PPP", "NPP", "PNP", "PPN"};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(body[i].name, name[i]);
    EXPECT_EQ(body[i].start, start[i]);
    EXPECT_EQ(body[i].end, end[i]);
  }
  const auto face = face_diagonals(box);
  EXPECT_EQ(face[3].start, Vec3(-5, -0.5, 3));  // XZ−
  EXPECT_EQ(face[3].end, Vec3(1, -0.5, -4));
  EXPECT_EQ(face[4].start, Vec3(-2, -3, -4));  // YZ+
}

TEST(Diagonals, DoNotSeeRigidMotionOrTheDirectionOfTravel) {
  Random random;
  const Vec3 shift = random.vector(0.1);
  const Vec3 turn = random.vector(2e-4);
  const auto bent = [&](const Vec3& q) -> Vec3 {
    return 1e-7 * Vec3(q.y() * q.y(), q.x() * q.z(), q.z() * q.z());
  };
  const auto moved = [&](const Vec3& q) -> Vec3 { return bent(q) + shift + turn.cross(q); };
  const DiagonalBox box{{-500, -300, -400}, {0, 0, 0}};
  const auto check = [&](Diagonal d) {
    std::array<double, 9> a{};
    std::array<double, 9> b{};
    std::array<double, 9> c{};
    DiagonalFigures figures;
    ASSERT_TRUE(diagonal_deviations(bent, d, a, figures).ok());
    ASSERT_TRUE(diagonal_deviations(moved, d, b, figures).ok());
    std::swap(d.start, d.end);
    ASSERT_TRUE(diagonal_deviations(bent, d, c, figures).ok());
    for (std::size_t j = 0; j < 9; ++j) {
      EXPECT_NEAR(a[j], b[j], 1e-15 * 100) << d.name;
      EXPECT_NEAR(c[j], a[8] - a[8 - j], 1e-15) << d.name;  // same slope from the other end
    }
  };
  for (const Diagonal& d : body_diagonals(box))
    check(d);
  for (const Diagonal& d : face_diagonals(box))
    check(d);
}

// The mean of the four sees l_x² s_x + l_y² s_y + l_z² s_z over the length and nothing else; the
// three squarenesses are in the differences.
TEST(Diagonals, MeanOfFourSeesTheScalesOnly) {
  Random random;
  const Vec3 l(500, 300, 400);
  for (int i = 0; i < 100; ++i) {
    const Vec3 scale = random.vector(5e-5);
    Mat3 gradient;
    for (Eigen::Index c = 0; c < 3; ++c)
      gradient.col(c) = random.vector(3e-4);
    gradient.diagonal() = scale;
    const auto error = [&](const Vec3& q) -> Vec3 { return gradient * q; };
    const auto end = end_values(error, {-l, Vec3::Zero()});
    const double mean = 0.25 * (end[0] + end[1] + end[2] + end[3]);
    EXPECT_NEAR(mean, l.cwiseProduct(l).dot(scale) / l.norm(), 1e-15);
    // PPP − NPP sees 4 times the xy and xz shear strains, and so on.
    const double xy = gradient(0, 1) + gradient(1, 0);
    const double xz = gradient(0, 2) + gradient(2, 0);
    EXPECT_NEAR(end[0] - end[1], 2.0 * (l.x() * l.y() * xy + l.x() * l.z() * xz) / l.norm(), 1e-15);
  }
}

TEST(Diagonals, FiguresOfAKnownCurve) {
  const std::vector<double> deviation{0.0, 3.0, -7.0, 5.0};
  const DiagonalFigures f = diagonal_figures(deviation);
  EXPECT_EQ(f.max_abs, 7.0);
  EXPECT_EQ(f.range, 12.0);
}

TEST(Diagonals, RefuseTooFewPointsAndAPointWithoutLength) {
  const auto none = [](const Vec3&) -> Vec3 { return Vec3::Zero(); };
  std::array<double, 1> one{};
  std::array<double, 2> two{};
  DiagonalFigures figures;
  Diagonal d{"d", Vec3(0, 0, 0), Vec3(1, 1, 1)};
  EXPECT_EQ(diagonal_deviations(none, d, one, figures).reason, Reason::too_few_points);
  d.end = d.start;
  EXPECT_EQ(diagonal_deviations(none, d, two, figures).reason, Reason::too_few_points);
}

// docs/papers/xyfz.md, "What it says": 60.219 %, 87.072 %, and 26.85 percentage points between
// them.
TEST(Diagonals, ImprovementRatesOfThePaper) {
  EXPECT_NEAR(improvement_percent(41.15, 16.37), 60.219, 0.0005);
  EXPECT_NEAR(improvement_percent(41.15, 5.32), 87.072, 0.0005);
  EXPECT_LT(improvement_percent(10.0, 12.0), 0.0);
}

}  // namespace
}  // namespace volcomp::test
