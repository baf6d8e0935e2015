// Interpolation: orders of convergence, error bounds and shape.

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "comp/metrology/tables/interpolation.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

using Function = std::function<double(double)>;
constexpr Interpolation kKinds[] = {Interpolation::linear, Interpolation::catmull_rom,
                                    Interpolation::pchip};
constexpr double kTwoPi = 6.283185307179586;

struct Curve {
  Curve(Interpolation k, std::vector<double> knots, std::vector<double> values)
      : kind(k), x(std::move(knots)), y(std::move(values)), slopes(x.size()) {
    knot_slopes(kind, x, y, slopes);
  }
  [[nodiscard]] double operator()(double at, Ends ends = Ends::hold) const {
    return interpolate(kind, ends, x, y, slopes, at);
  }

  Interpolation kind;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> slopes;
};

Curve sample(Interpolation kind, const Function& f, double lo, double hi, int cells) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i <= cells; ++i) {
    x.push_back(lo + (hi - lo) * i / cells);
    y.push_back(f(x.back()));
  }
  return {kind, x, y};
}

double largest_error(const Curve& curve, const Function& f, double lo, double hi) {
  double worst = 0.0;
  for (int i = 0; i <= 20000; ++i) {
    const double at = lo + (hi - lo) * i / 20000;
    worst = std::max(worst, std::abs(curve(at) - f(at)));
  }
  return worst;
}

TEST(Interpolation, PassesThroughEveryKnotAndReproducesStraightLines) {
  Random random;
  for (const Interpolation kind : kKinds) {
    std::vector<double> x{-500.0};
    std::vector<double> y{0.0};
    std::vector<double> line{3.0 - 0.7 * 500.0};
    for (int i = 1; i < 12; ++i) {
      const bool uniform = kind == Interpolation::catmull_rom;
      x.push_back(x.back() + (uniform ? 50.0 : random.uniform(1.0, 90.0)));
      y.push_back(random.uniform(-1.0, 1.0));
      line.push_back(3.0 + 0.7 * x.back());
    }
    const Curve curve(kind, x, y);
    const Curve straight(kind, x, line);
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_NEAR(curve(x[i]), y[i], 3e-16) << static_cast<int>(kind) << " knot " << i;
    for (int i = 0; i < 100; ++i) {
      const double at = random.uniform(x.front(), x.back());
      EXPECT_NEAR(straight(at), 3.0 + 0.7 * at, 1e-11) << static_cast<int>(kind);
    }
  }
}

// Parabolic end slopes make Catmull-Rom exact for parabolas on the whole range.
TEST(Interpolation, CatmullRomReproducesParabolas) {
  const Function f = [](double x) { return 1.0 - 2e-3 * x + 3e-5 * x * x; };
  const Curve curve = sample(Interpolation::catmull_rom, f, -400.0, 0.0, 8);
  EXPECT_LE(largest_error(curve, f, -400.0, 0.0), 1e-14);
}

TEST(Interpolation, LinearErrorStaysWithinItsBoundAndReachesIt) {
  const double k = kTwoPi / 250.0;
  const Function f = [&](double x) { return std::sin(k * x); };
  for (const int cells : {10, 20, 40, 80}) {
    const double h = 500.0 / cells;
    const double bound = h * h / 8.0 * k * k;
    const double error =
        largest_error(sample(Interpolation::linear, f, -500.0, 0.0, cells), f, -500.0, 0.0);
    EXPECT_LE(error, bound);
    EXPECT_GE(error, 0.8 * bound) << cells;
  }
}

TEST(Interpolation, CatmullRomInteriorErrorStaysWithinItsBound) {
  for (const double wavelength : {125.0, 250.0, 500.0}) {
    const double k = kTwoPi / wavelength;
    for (const double phase : {0.0, 0.4, 1.1, 1.9}) {
      const Function f = [&](double x) { return std::sin(k * x + phase); };
      const double h = 25.0;
      const double error =
          largest_error(sample(Interpolation::catmull_rom, f, -500.0, 0.0, 20), f, -500.0 + h, -h);
      EXPECT_LE(error, h * h * h / 24.0 * k * k * k + h * h * h * h / 384.0 * k * k * k * k);
    }
  }
}

TEST(Interpolation, OrdersOfConvergence) {
  const double k = kTwoPi / 500.0;
  const Function bent = [&](double x) { return std::sin(k * x + 0.3); };
  const Function rising = [](double x) { return std::exp(x / 300.0); };
  const auto ratio = [&](Interpolation kind, const Function& f, int cells) {
    const auto error = [&](int n) {
      return largest_error(sample(kind, f, -500.0, 0.0, n), f, -400.0, -100.0);
    };
    return error(cells) / error(2 * cells);
  };
  EXPECT_NEAR(ratio(Interpolation::linear, bent, 40), 4.0, 0.2);
  EXPECT_GE(ratio(Interpolation::catmull_rom, bent, 40), 7.5);
  EXPECT_GE(ratio(Interpolation::pchip, rising, 40), 7.0);  // O(h³) where it is monotone
}

// A sin, A = 5 µm, h = 50 mm, on −500…0. The phase of the expected figures is not known: they must
// lie in the range over all phases.
TEST(Interpolation, PrintedErrorsOfTheSpecificationOccur) {
  struct Row {
    double wavelength;
    std::array<double, 3> error;  // linear, Catmull-Rom, PCHIP, µm
    double half_digit;
  };
  for (const Row& row :
       {Row{500.0, {0.24, 0.08, 0.11}, 0.005}, Row{250.0, {0.95, 0.46, 0.84}, 0.005},
        Row{125.0, {3.4, 2.9, 3.3}, 0.05}}) {
    for (std::size_t i = 0; i < 3; ++i) {
      double least = 1e9;
      double most = 0.0;
      for (int step = 0; step < 60; ++step) {
        const Function f = [&](double x) {
          return 5.0 * std::sin(kTwoPi * (x / row.wavelength + step / 60.0));
        };
        const double error = largest_error(sample(kKinds[i], f, -500.0, 0.0, 10), f, -500.0, 0.0);
        least = std::min(least, error);
        most = std::max(most, error);
      }
      EXPECT_LE(least, row.error[i] + row.half_digit) << row.wavelength << ' ' << i;
      EXPECT_GE(most, row.error[i] - row.half_digit) << row.wavelength << ' ' << i;
    }
  }
}

// A crest midway between two knots: linear and PCHIP both draw the chord, A (1 − cos πh/λ).
TEST(Interpolation, CrestBetweenTwoKnotsIsCutOffByLinearAndPchipAlike) {
  const Function f = [](double x) { return 5.0 * std::cos(kTwoPi * (x + 225.0) / 500.0); };
  const double chord = 5.0 * (1.0 - std::cos(kTwoPi / 20.0));
  for (const Interpolation kind : {Interpolation::linear, Interpolation::pchip})
    EXPECT_NEAR(std::abs(sample(kind, f, -500.0, 0.0, 10)(-225.0) - 5.0), chord, 1e-12);
  EXPECT_LT(std::abs(sample(Interpolation::catmull_rom, f, -500.0, 0.0, 10)(-225.0) - 5.0),
            0.3 * chord);
}

// "Cubic offline onto h/8, linear on line": the linear part shrinks by 64.
TEST(Interpolation, RefiningByEightDividesTheLinearErrorBySixtyFour) {
  const double k = kTwoPi / 500.0;
  const Function f = [&](double x) { return std::sin(k * x); };
  const double coarse =
      largest_error(sample(Interpolation::linear, f, -500.0, 0.0, 40), f, -500.0, 0.0);
  const double fine =
      largest_error(sample(Interpolation::linear, f, -500.0, 0.0, 320), f, -500.0, 0.0);
  EXPECT_NEAR(coarse / fine, 64.0, 0.5);
}

// PCHIP between two knots never leaves the interval of their values; monotone data stay monotone.
TEST(Pchip, NeverOvershootsOnAnyData) {
  Random random;
  for (int i = 0; i < 300; ++i) {
    std::vector<double> x{0.0};
    std::vector<double> y{random.uniform(-1.0, 1.0)};
    const bool monotone = i % 2 == 0;
    const int n = random.integer(3, 15);
    for (int j = 1; j < n; ++j) {
      x.push_back(x.back() + random.uniform(0.01, 50.0));
      const double step = std::pow(10.0, random.uniform(-6.0, 1.0));
      y.push_back(y.back() + (monotone || random.integer(0, 1) == 0 ? step : -step));
      if (random.integer(0, 5) == 0) y.back() = y[y.size() - 2];
    }
    const Curve curve(Interpolation::pchip, x, y);
    for (std::size_t j = 0; j + 1 < x.size(); ++j) {
      const double lo = std::min(y[j], y[j + 1]);
      const double hi = std::max(y[j], y[j + 1]);
      const double slack = 4e-16 * (std::abs(lo) + std::abs(hi));
      double before = y[j];
      for (int s = 0; s <= 50; ++s) {
        const double v = curve(x[j] + (x[j + 1] - x[j]) * s / 50.0);
        ASSERT_GE(v, lo - slack);
        ASSERT_LE(v, hi + slack);
        if (monotone) {
          ASSERT_GE(v, before - slack);
        }
        before = v;
      }
    }
  }
}

// F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300: between secants d₀, d₁ over
// the widths h₀, h₁ the slope is (w₀ + w₁)/(w₀/d₀ + w₁/d₁) with w₀ = 2h₁ + h₀, w₁ = h₁ + 2h₀: the
// nearer secant counts more. Widths 1 and 3, secants 1 and 1/3: 12/(7 + 15).
TEST(Pchip, WeighsTheNearerSecantMore) {
  EXPECT_DOUBLE_EQ(Curve(Interpolation::pchip, {0, 1, 4}, {0, 1, 2}).slopes[1], 6.0 / 11.0);
  EXPECT_DOUBLE_EQ(Curve(Interpolation::pchip, {0, 3, 4}, {0, 1, 2}).slopes[1], 6.0 / 11.0);
  EXPECT_DOUBLE_EQ(Curve(Interpolation::pchip, {0, 1, 2}, {0, 1, 4}).slopes[1], 1.5);
}

// Catmull-Rom overshoots a step: the reason why it is not the default.
TEST(Pchip, IsNeededBecauseCatmullRomOvershoots) {
  const Curve curve(Interpolation::catmull_rom, {0, 1, 2, 3}, {0, 0, 1, 1});
  EXPECT_LT(curve(0.6), -0.02);
  EXPECT_EQ(Curve(Interpolation::pchip, {0, 1, 2, 3}, {0, 0, 1, 1})(0.6), 0.0);
}

TEST(Ends, AreHeldOrContinuedWithTheEndSlope) {
  for (const Interpolation kind : kKinds) {
    const Curve curve = sample(
        kind, [](double x) { return 2.0 * x; }, 0.0, 40.0, 4);
    EXPECT_EQ(curve(-5.0), 0.0);
    EXPECT_EQ(curve(47.0), 80.0);
    EXPECT_NEAR(curve(-5.0, Ends::extend_linearly), -10.0, 1e-13);
    EXPECT_NEAR(curve(47.0, Ends::extend_linearly), 94.0, 1e-13);
  }
}

TEST(Ends, TwoKnotsGiveTheSecantWhateverTheKind) {
  for (const Interpolation kind : kKinds) {
    const Curve curve(kind, {1.0, 3.0}, {5.0, 9.0});
    EXPECT_NEAR(curve(1.5), 6.0, 1e-15);
    EXPECT_NEAR(curve(4.0, Ends::extend_linearly), 11.0, 1e-15);
  }
}

}  // namespace
}  // namespace volcomp::test
