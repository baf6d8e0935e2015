// The tick of the XYFZ machine against the same model in double on the same integers: below 1 nm
// after rounding as long as S ≤ 1 mm, whichever model plays the oracle and whichever way the
// machine was built.

#include "comp/metrology/tables/quantise.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

// The first-order sum in closed form: relative errors, reading heads as origins
// (docs/papers/xyfz.md).
class FormA {
 public:
  explicit FormA(const MachineTables& tables) : tables_(tables) {}

  [[nodiscard]] Real3 error(const std::array<std::int64_t, kMaxAxes>& q,
                            const std::array<int, kMaxAxes>& travel) const {
    std::array<Interpolated, 3> at;
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = interpolated(tables_.axis[a], false, q[a], travel[a]);
      for (Real& v : at[a].value)
        v *= a < 2 ? -1 : 1;  // body → relative: X and Y carry the workpiece
    }
    const Real X = at[0].held;
    const Real Y = at[1].held;
    const Real Z = at[2].held;
    constexpr Real kB12[3] = {-200e6L, -150e6L, 180e6L};
    constexpr Real kB03[3] = {20e6L, 520e6L, 1130e6L};
    constexpr Real kPt[3] = {30e6L, -380e6L, -300e6L};
    const Real3 rX{kB03[0] + kPt[0] - kB12[0] + X, kB03[1] + kPt[1] - kB12[1] + Y,
                   kB03[2] + kPt[2] - kB12[2] + Z};
    const Real3 rY{kB03[0] + kPt[0], kB03[1] + kPt[1] + Y, kB03[2] + kPt[2] + Z};
    const Real3 rZ{kPt[0], kPt[1], kPt[2]};
    constexpr Real kXy = 127.264e-6L;
    constexpr Real kXz = 222.190e-6L;
    constexpr Real kYz = 17.356e-6L;
    Real3 e{Z * kXz * squareness, (X * kXy - Z * kYz) * squareness, 0};
    add(e, at[0].value, rX);
    add(e, at[1].value, rY);
    add(e, at[2].value, rZ);
    return e;
  }

  Real squareness = 1;  // factor on the three parameters

 private:
  static void add(Real3& e, const Six& v, const Real3& r) {
    e[0] += v[0] + v[4] * r[2] - v[5] * r[1];
    e[1] += v[1] + v[5] * r[0] - v[3] * r[2];
    e[2] += v[2] + v[3] * r[1] - v[4] * r[0];
  }

  const MachineTables& tables_;
};

struct Walk {
  std::array<std::int64_t, kMaxAxes> q{};
  std::array<int, kMaxAxes> travel{2, 2, 2, 2, 2, 2, 2, 2};

  void go(std::size_t axis, std::int64_t to, bool first) {
    if (!first && to != q[axis]) travel[axis] = to > q[axis] ? 0 : 1;
    q[axis] = to;
  }
  // Anywhere in the stroke and up to 30 mm beyond it.
  void go_anywhere(const MachineTables& tables, Random& random, bool first) {
    for (std::size_t a = 0; a < 3; ++a) {
      go(a, random.integer(tables.axis[a].q0 - 30'000'000, tables.axis[a].last() + 30'000'000),
         first);
    }
  }
};

double nm(Real x) { return static_cast<double>(x); }

TEST(XyfzAccuracy, AMillionPointsBelow1nmAndCompiledInEqualsLoaded) {
  for (const double bound : {0.2e6, 0.999e6}) {
    Random random(static_cast<std::uint64_t>(bound));
    SCOPED_TRACE(random.trace());
    MachineTables tables = xyfz_tables(40e3, 4e-5, random);
    const double squareness_before = tables.directions[0].y();
    scale_to_bound(tables, bound);
    LoadedRunner loaded(kXyfzMachine);
    XyfzRunner compiled;
    ASSERT_TRUE(loaded.start(tables).ok());
    ASSERT_TRUE(compiled.start(tables).ok());
    ASSERT_TRUE(loaded.compensator->fold_report().within_1nm);
    FormA form(tables);
    form.squareness = tables.directions[0].y() / squareness_before;
    Walk walk;
    double worst = 0.0;
    for (int n = 0; n < kManyPoints; ++n) {
      walk.go_anywhere(tables, random, n == 0);
      const Real3 e = form.error(walk.q, walk.travel);
      loaded.tick({walk.q[0], walk.q[1], walk.q[2], 0, 0});
      compiled.tick({walk.q[0], walk.q[1], walk.q[2]});
      for (std::size_t a = 0; a < 3; ++a) {
        ASSERT_EQ(loaded.out.offset[a], compiled.out.offset[a]) << "point " << n;
        worst = std::max(worst, nm(std::abs(static_cast<Real>(loaded.out.offset[a]) + e[a])));
      }
    }
    EXPECT_LT(worst, 1.0) << "S = " << bound;
    EXPECT_GT(worst, 0.49) << "rounding alone must show";
    RecordProperty(bound > 0.5e6 ? "worst_pm_S_1mm" : "worst_pm_S_0.2mm",
                   static_cast<int>(worst * 1e3));
  }
}

// Before rounding the arithmetic error is at most 8·2^-24·S (FoldReport::bound_nm).
TEST(XyfzAccuracy, ArithmeticErrorIsWithinTheProvenBound) {
  Random random(1);
  SCOPED_TRACE(random.trace());
  MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  scale_to_bound(tables, 1e6);
  LoadedRunner loaded(kXyfzMachine);
  ASSERT_TRUE(loaded.start(tables).ok());
  MachineModel model(tables, kXyfzMachine.tool_point);
  Walk walk;
  double worst = 0.0;
  for (int n = 0; n < kManyPoints / 10; ++n) {
    walk.go_anywhere(tables, random, n == 0);
    loaded.tick({walk.q[0], walk.q[1], walk.q[2], 0, 0});
    model.stand_at(walk.q, walk.travel);
    const Real3 e = model.first_order();
    for (std::size_t a = 0; a < 3; ++a) {
      const Real computed = static_cast<Real>(loaded.compensator->last_error_nm()[a]);
      worst = std::max(worst, nm(std::abs(computed - e[a])));
    }
  }
  EXPECT_LT(worst, 8.0 * 0x1p-24 * 1e6);
  RecordProperty("worst_unrounded_pm", static_cast<int>(worst * 1e3));
}

// The double models of the library agree with the tick as the conventions promise.
TEST(XyfzAccuracy, VolumetricModelAgreesInBothOrders) {
  Random random(2);
  SCOPED_TRACE(random.trace());
  MachineTables tables = xyfz_tables(40e3, 4e-5, random);
  scale_to_bound(tables, 0.9e6);
  auto double_table = std::make_unique<std::array<ErrorTable, 3>>();
  VolumetricModel model;
  ASSERT_TRUE(MachineChain::build(kXyfzMachine, model.chain).ok());
  model.directions = tables.directions;
  model.tool_point = tool_of(kXyfzMachine);
  for (std::size_t a = 0; a < 3; ++a) {
    dequantise(tables.axis[a], model.chain.axis(a), (*double_table)[a]);
    model.table[a] = &(*double_table)[a];
  }
  LoadedRunner first(kXyfzMachine, RuntimeModel::folded);
  LoadedRunner second(kXyfzMachine, RuntimeModel::second_order);
  ASSERT_TRUE(first.start(tables).ok());
  ASSERT_TRUE(second.start(tables).ok());
  Walk walk;
  for (int n = 0; n < kManyPoints / 10; ++n) {
    walk.go_anywhere(tables, random, n == 0);
    Pose q{};
    Travels travels{};
    for (std::size_t a = 0; a < 3; ++a) {
      q[a] = static_cast<double>(walk.q[a]) * 1e-6;
      travels[a] = walk.travel[a] == 2 ? Travel::unknown
                                       : (walk.travel[a] == 0 ? Travel::forward : Travel::backward);
    }
    first.tick({walk.q[0], walk.q[1], walk.q[2], 0, 0});
    second.tick({walk.q[0], walk.q[1], walk.q[2], 0, 0});
    const Vec3 e1 = 1e6 * model.first_order(q, travels, Beyond::stand_at_end);
    const Vec3 e2 = 1e6 * model.second_order(q, travels, Beyond::stand_at_end);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      ASSERT_LT(std::abs(first.out.offset[a] + e1(i)), 1.0) << "point " << n << " axis " << a;
      ASSERT_LT(std::abs(second.out.offset[a] + e2(i)), 1.0) << "point " << n << " axis " << a;
    }
  }
}

}  // namespace
}  // namespace volcomp::test
