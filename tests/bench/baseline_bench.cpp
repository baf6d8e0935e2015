// What the tick is measured against, in the same run: eighteen one-channel lookups as a typical
// controller library writes them, and the chain as six 4×4 float products.

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "comp/core/units.hpp"
#include "tests/bench/machines.hpp"

namespace volcomp::bench {
namespace {

// A one-channel table with its own positions: clamp, interval by division, interpolate.
struct LinearTable {
  float first = 0.0F;
  float pitch = 1.0F;
  int knots = 0;
  std::array<float, 128> value{};

  [[nodiscard]] float at(float q) const {
    const float last = first + pitch * static_cast<float>(knots - 1);
    if (q <= first) return value[0];
    if (q >= last) return value[static_cast<std::size_t>(knots - 1)];
    const float place = (q - first) / pitch;
    const int i = static_cast<int>(place);
    const float t = place - static_cast<float>(i);
    const auto k = static_cast<std::size_t>(i);
    return value[k] + t * (value[k + 1] - value[k]);
  }
};

// The same as textbooks and DSP libraries print it: the interval is found by a division, its ends
// are formed again and the slope is a second division.
struct TextbookTable : LinearTable {
  [[nodiscard]] float at(float q) const {
    const int i = static_cast<int>((q - first) / pitch);
    if (i < 0) return value[0];
    if (i >= knots - 1) return value[static_cast<std::size_t>(knots - 1)];
    const auto k = static_cast<std::size_t>(i);
    const float here = first + static_cast<float>(i) * pitch;
    const float next = first + static_cast<float>(i + 1) * pitch;
    return value[k] + (q - here) * ((value[k + 1] - value[k]) / (next - here));
  }
};

template <class Table>
using TablesOf = std::array<std::array<Table, 6>, 3>;

template <class Table = LinearTable>
std::unique_ptr<TablesOf<Table>> channel_tables() {
  const auto tables = make_tables(kGeneric);
  auto out = std::make_unique<TablesOf<Table>>();
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisTable& from = tables->axis[a];
    for (std::size_t c = 0; c < 6; ++c) {
      Table& to = (*out)[a][c];
      to.first = static_cast<float>(static_cast<double>(from.q0) / kNmPerMm);
      to.pitch = static_cast<float>(static_cast<double>(from.pitch) / kNmPerMm);
      to.knots = static_cast<int>(from.knots);
      for (std::size_t i = 0; i < from.knots; ++i)
        to.value[i] = from.value[0][i][c];
    }
  }
  return out;
}

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
void eighteen_lookups(benchmark::State& state) {
  const auto tables = channel_tables<Table>();
  const auto walk = float_walk();
  std::array<float, 18> value{};
  std::size_t i = 0;
  for (auto _ : state) {
    const std::array<float, 3>& q = walk[i++ % kWalk];
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t c = 0; c < 6; ++c)
        value[6 * a + c] = (*tables)[a][c].at(q[a]);
    }
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

BENCHMARK_TEMPLATE(eighteen_lookups, TextbookTable)->Name("Baseline/eighteen_lookups_textbook");
BENCHMARK_TEMPLATE(eighteen_lookups, LinearTable)->Name("Baseline/eighteen_lookups");
BENCHMARK(six_matrix_products)->Name("Baseline/eighteen_lookups_and_six_matrix_products");

}  // namespace
}  // namespace volcomp::bench
