// The reference cases of limited offsets, bit for bit, on a computer and on boards.

#include "comp/tick/limiter.hpp"
#include "comp/tick/offset_limiter.hpp"
#include "tests/cases/offset_case_numbers.hpp"

namespace volcomp::test {
namespace {

enum class Operation : std::uint8_t { follow, follow_softly, follow_float, hold, change, start };

void run_bounds(Numbers in) {
  static constexpr std::array<const char*, 5> kFields{nullptr, "limit", "rate", "soft_rate",
                                                      "acceleration"};
  const OffsetLimits limits = in.limits();
  const auto refused = static_cast<std::size_t>(in.next());
  ASSERT_STREQ(refused_field(limits), kFields[refused]);
  if (refused != 0) return;
  const OffsetBounds b(limits);
  ASSERT_EQ(b.rate, in.next());
  ASSERT_EQ(b.soft_rate, in.next());
  ASSERT_EQ(b.acceleration, in.next());
  ASSERT_EQ(b.free, in.next());
  ASSERT_EQ(b.none(), in.next() != 0);
}

void run_braking(Numbers in) {
  const std::int32_t a = in.next();
  const std::int32_t steps = in.next();
  const std::int32_t ways = in.next();
  for (std::int32_t n = 0; n < steps; ++n) {
    const std::int32_t way = stopping_way(in.next(), a);
    ASSERT_EQ(way, in.next()) << n;
  }
  for (std::int32_t n = 0; n < ways; ++n) {
    const std::int32_t step = stopping_step(in.next(), a);
    ASSERT_EQ(step, in.next()) << n;
  }
}

class Follow {
 public:
  void run(Numbers in) {
    change(in.limits());
    limiter_.start(in.next());
    for (std::int32_t n = in.next(); n > 0 && !::testing::Test::HasFatalFailure(); --n)
      operate(in);
    ASSERT_EQ(limiter_.largest(), in.next());
    ASSERT_EQ(limiter_.largest_lag(), in.next());
    ASSERT_TRUE(in.done());
  }

 private:
  void change(const OffsetLimits& limits) {
    limit_ = limits.limit;
    limiter_.change(OffsetBounds(limits));
  }
  void operate(Numbers& in) {
    const auto operation = static_cast<Operation>(in.next());
    if (operation == Operation::change) return change(in.limits());
    const std::int32_t operand = in.next();
    if (operation == Operation::start) return limiter_.start(operand);
    const std::uint32_t status = tick(operation, operand);
    ASSERT_EQ(limiter_.offset(), in.next()) << "operand " << operand;
    ASSERT_EQ(status, static_cast<std::uint32_t>(in.next())) << "operand " << operand;
  }
  // In the bits of the cases: clamped, rate, acceleration, settling, not finite.
  std::uint32_t tick(Operation operation, std::int32_t operand) {
    switch (operation) {
      case Operation::hold:
        return bits_of(limiter_.hold());
      case Operation::follow_float:
        return tick_float(bit_cast<float>(operand));
      default:
        return tick_integer(operand, operation == Operation::follow_softly);
    }
  }
  std::uint32_t tick_integer(std::int32_t wanted, bool soft) {
    const std::int32_t t = wanted > limit_ ? limit_ : wanted < -limit_ ? -limit_ : wanted;
    const std::uint32_t status = soft ? limiter_.follow_softly(t) : limiter_.follow(t);
    return bits_of(status) | (t == wanted ? 0U : 1U);
  }
  std::uint32_t tick_float(float x) {
    if (!Magnitude::finite(x)) return bits_of(limiter_.follow_softly(0)) | 16U;
    const Magnitude most(static_cast<float>(limit_));
    const bool clamped = exceeds(x, most);
    const std::int32_t t = round_half_even(clamped ? most.signed_like(x) : x);
    return bits_of(limiter_.follow(t)) | (clamped ? 1U : 0U);
  }
  static std::uint32_t bits_of(std::uint32_t status) {
    return ((status & kRateLimited) != 0 ? 2U : 0U) |
           ((status & kAccelerationLimited) != 0 ? 4U : 0U) | ((status & kSettling) != 0 ? 8U : 0U);
  }

  OffsetLimiter<true> limiter_;
  std::int32_t limit_ = 0;
};

TEST(OffsetCases, Bounds) { EXPECT_EQ(run_cases(Kind::bounds, run_bounds), 19); }

TEST(OffsetCases, Braking) { EXPECT_EQ(run_cases(Kind::braking, run_braking), 4); }

TEST(OffsetCases, Follow) {
  EXPECT_EQ(run_cases(Kind::follow, [](const Numbers& in) { Follow().run(in); }), 69);
}

}  // namespace
}  // namespace volcomp::test
