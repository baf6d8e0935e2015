#include "comp/metrology/statistics/random_stream.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {
namespace {

// Multipliers and Weyl increments of the paper, and its ten rounds.
constexpr std::uint32_t kMultiplier0 = 0xD2511F53U;
constexpr std::uint32_t kMultiplier1 = 0xCD9E8D57U;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9U;
constexpr std::uint32_t kWeyl1 = 0xBB67AE85U;
constexpr int kRounds = 10;

constexpr double kTwoPi = 6.283185307179586;

constexpr std::uint32_t high(std::uint64_t product) {
  return static_cast<std::uint32_t>(product >> 32U);
}
constexpr std::uint32_t low(std::uint64_t product) { return static_cast<std::uint32_t>(product); }

// The upper 53 bits of two words, in the middle of their step.
double uniform(std::uint32_t first, std::uint32_t second) {
  const std::uint64_t bits = (std::uint64_t{first} << 32U | second) >> 11U;
  constexpr double kStep = 1.0 / 9007199254740992.0;  // 2⁻⁵³
  return (static_cast<double>(bits) + 0.5) * kStep;
}

}  // namespace

RandomWords random_words(std::uint64_t seed, const RandomIndex& at) {
  RandomWords w{at.reading, at.set_up, at.draw, at.stream};
  std::uint32_t key0 = low(seed);
  std::uint32_t key1 = high(seed);
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t a = std::uint64_t{kMultiplier0} * w[0];
    const std::uint64_t b = std::uint64_t{kMultiplier1} * w[2];
    w = {high(b) ^ w[1] ^ key0, low(b), high(a) ^ w[3] ^ key1, low(a)};
    key0 += kWeyl0;
    key1 += kWeyl1;
  }
  return w;
}

Uniforms uniforms(std::uint64_t seed, const RandomIndex& at) {
  const RandomWords w = random_words(seed, at);
  return {uniform(w[0], w[1]), uniform(w[2], w[3])};
}

std::array<double, 2> normals(std::uint64_t seed, const RandomIndex& at) {
  const Uniforms r = uniforms(seed, at);
  const double length = std::sqrt(-2.0 * std::log(r.u));
  return {length * std::cos(kTwoPi * r.v), length * std::sin(kTwoPi * r.v)};
}

double normal(std::uint64_t seed, const RandomIndex& at) { return normals(seed, at)[0]; }

double chi_square(double freedom, double normal) {
  const double k = 2.0 / (9.0 * freedom);
  const double root = std::max(1.0 - k + normal * std::sqrt(k), 0.01);
  return freedom * root * root * root;
}

}  // namespace volcomp
