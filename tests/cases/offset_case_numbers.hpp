#pragma once
// The reference cases of limited offsets as numbers: offset_cases_inc.py makes them, for programs
// that read no JSON.

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "comp/core/span.hpp"
#include "comp/tick/offset_bounds.hpp"

namespace volcomp::test {
namespace {

#include "offset_cases.inc"

enum class Kind : std::uint8_t { bounds = 1, braking, follow, station };

// Numbers of a case, one after the other.
class Numbers {
 public:
  explicit Numbers(Span<const std::int32_t> numbers) : numbers_(numbers) {}

  std::int32_t next() { return at_ < numbers_.size() ? numbers_[at_++] : 0; }
  OffsetLimits limits() {
    OffsetLimits l;
    l.limit = next();
    l.rate = next();
    l.soft_rate = next();
    l.acceleration = next();
    return l;
  }
  Numbers part(std::size_t size) {
    const Span<const std::int32_t> part(numbers_.data() + at_, size);
    at_ += size;
    return Numbers(part);
  }
  [[nodiscard]] bool done() const { return at_ >= numbers_.size(); }

 private:
  Span<const std::int32_t> numbers_;
  std::size_t at_ = 0;
};

// run(numbers) for every case of one kind; how many there were.
template <class Run>
int run_cases(Kind kind, const Run& run) {
  Numbers all({kCaseNumbers, sizeof kCaseNumbers / sizeof kCaseNumbers[0]});
  int cases = 0;
  for (int n = 0; n < kCases && !::testing::Test::HasFatalFailure(); ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    const auto of = static_cast<Kind>(all.next());
    const Numbers numbers = all.part(static_cast<std::size_t>(all.next()));
    if (of != kind) continue;
    ++cases;
    run(numbers);
  }
  EXPECT_TRUE(all.done());
  return cases;
}

}  // namespace
}  // namespace volcomp::test
