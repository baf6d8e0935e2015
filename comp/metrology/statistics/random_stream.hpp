#pragma once
// Random numbers as a function of what they are for: no generator is carried through a loop, so
// that results depend neither on the order in which readings are computed nor on the number of
// threads, and one more source of errors moves no other.
//
// Philox4x32-10: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as
// easy as 1, 2, 3", SC 2011.

#include <array>
#include <cstdint>

namespace volcomp {

// A number once given is never given again. Another instrument of a kind: + kNextInstrument.
enum class RandomStream : std::uint32_t {
  probe = 1,
  lobing = 2,
  laser = 3,
  level = 4,
  tracker = 5,
  ball_bar = 6,
  r_test = 7,
  temperature = 8,
  repeatability = 9,  // of the machine
  set_up = 10,        // offsets and angles
  drift = 11,
  intervals = 64,  // draws behind an interval
};
inline constexpr std::uint32_t kNextInstrument = 100;

// What is common to all readings of a set-up has the reading kCommon, on RandomStream::set_up; what
// is common to all set-ups of a draw has the set-up kCommon as well. Further ones count downwards.
inline constexpr std::uint32_t kCommon = UINT32_MAX;

// Which number is meant.
struct RandomIndex {
  std::uint32_t stream = 0;   // a RandomStream
  std::uint32_t draw = 0;     // of a Monte Carlo, or of several seeds
  std::uint32_t set_up = 0;   // placement, diagonal, circle
  std::uint32_t reading = 0;  // in the order of the plan
};

using RandomWords = std::array<std::uint32_t, 4>;
[[nodiscard]] RandomWords random_words(std::uint64_t seed, const RandomIndex& at);

// Two numbers, rectangular, 0 < u ≤ 1.
struct Uniforms {
  double u = 0.0;
  double v = 0.0;
};
[[nodiscard]] Uniforms uniforms(std::uint64_t seed, const RandomIndex& at);

// Two independent standard normal numbers, after Box and Muller.
[[nodiscard]] std::array<double, 2> normals(std::uint64_t seed, const RandomIndex& at);

// The first of them.
[[nodiscard]] double normal(std::uint64_t seed, const RandomIndex& at);

// Chi-square of `freedom` degrees from a standard normal number, after Wilson and Hilferty; > 0.
[[nodiscard]] double chi_square(double freedom, double normal);

}  // namespace volcomp
