#include "firmware/node/latency.hpp"

namespace volcomp::node {
namespace {

constexpr std::uint32_t kFirstOctave = 2;  // 4 µs

// 2^(1/4), 2^(2/4), 2^(3/4) in 2^-16.
constexpr std::array<std::uint32_t, 3> kQuarter{77'936, 92'682, 110'218};

}  // namespace

std::size_t Latency::bin_of(std::uint32_t us) {
  if (us < (1U << kFirstOctave)) return 0;
  const std::size_t octave = 31U - static_cast<unsigned>(__builtin_clz(us));
  const auto part = static_cast<std::uint32_t>((std::uint64_t{us} << 16U) >> octave);
  std::size_t bin = 4U * (octave - kFirstOctave);
  for (const std::uint32_t quarter : kQuarter)
    bin += part >= quarter ? 1U : 0U;
  return bin < kBins ? bin : kBins - 1;
}

std::uint32_t Latency::end_of(std::size_t bin) {
  const std::size_t next = bin + 1;
  const std::uint32_t begin = 1U << (kFirstOctave + next / 4U);
  if (next % 4U == 0) return begin;
  return static_cast<std::uint32_t>(std::uint64_t{begin} * kQuarter[next % 4U - 1U] >> 16U);
}

void Latency::note(std::uint32_t us) {
  least_us_ = cycles_ == 0 || us < least_us_ ? us : least_us_;
  largest_us_ = larger(largest_us_, us);
  if (cycles_ == UINT32_MAX) return;
  ++cycles_;
  ++bin_[bin_of(us)];  // none exceeds their sum
}

std::uint32_t Latency::quantile_us(std::uint32_t thousandths) const {
  const std::uint64_t wanted = std::uint64_t{cycles_} * thousandths;
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    below += std::uint64_t{bin_[i]} * 1000U;
    if (below != 0 && below >= wanted) return end_of(i) < largest_us_ ? end_of(i) : largest_us_;
  }
  return 0;
}

}  // namespace volcomp::node
