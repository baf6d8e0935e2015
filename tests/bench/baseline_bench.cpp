// What the tick is measured against, in the same run: eighteen one-channel lookups as a typical
// controller library writes them, and the chain as six 4×4 float products.

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "comp/core/units.hpp"
#include "tests/bench/rivals.hpp"

namespace volcomp::bench {
namespace {

std::vector<std::array<float, 3>> float_walk() {
  std::vector<std::array<float, 3>> out;
  for (const auto& q : make_walk(kGeneric)) {
    out.push_back({});
    for (std::size_t a = 0; a < 3; ++a)
      out.back()[a] = static_cast<float>(static_cast<double>(q[a]) / kNmPerMm);
  }
  return out;
}

template <class Table>
void lookups(benchmark::State& state) {
  const auto tables = channel_tables<Table>();
  const auto walk = float_walk();
  std::size_t i = 0;
  for (auto _ : state) {
    std::array<float, 18> value = eighteen_lookups(*tables, walk[i++ % kWalk]);
    benchmark::DoNotOptimize(value);
    benchmark::ClobberMemory();
  }
}

// Motion and error matrix of three axes multiplied out, the tool point carried through.
void six_matrix_products(benchmark::State& state) {
  const auto tables = channel_tables();
  const auto walk = float_walk();
  using Matrix = Eigen::Matrix<float, 4, 4>;
  std::size_t i = 0;
  Eigen::Vector4f point(30.0F, -380.0F, -300.0F, 1.0F);
  for (auto _ : state) {
    const std::array<float, 3>& q = walk[i++ % kWalk];
    Matrix T = Matrix::Identity();
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<float, 6> e{};
      for (std::size_t c = 0; c < 6; ++c)
        e[c] = (*tables)[a][c].at(q[a]);
      Matrix motion = Matrix::Identity();
      motion(static_cast<Eigen::Index>(a), 3) = q[a];
      Matrix error;
      error << 1.0F, -e[5], e[4], e[0], e[5], 1.0F, -e[3], e[1], -e[4], e[3], 1.0F, e[2], 0.0F,
          0.0F, 0.0F, 1.0F;
      T = (T * motion).eval();
      T = (T * error).eval();
    }
    Eigen::Vector4f result = T * point;
    benchmark::DoNotOptimize(result);
    benchmark::ClobberMemory();
  }
}

BENCHMARK_TEMPLATE(lookups, DspTable)->Name("Baseline/eighteen_lookups_textbook");
BENCHMARK_TEMPLATE(lookups, LinearTable)->Name("Baseline/eighteen_lookups");
BENCHMARK(six_matrix_products)->Name("Baseline/eighteen_lookups_and_six_matrix_products");

}  // namespace
}  // namespace volcomp::bench
