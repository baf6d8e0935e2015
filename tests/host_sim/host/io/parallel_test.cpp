#include "host_sim/host/io/parallel.hpp"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "host_sim/host/report/shared_progress.hpp"

namespace volcomp::host {
namespace {

class InParallel : public testing::TestWithParam<std::size_t> {};

TEST_P(InParallel, EveryPartIsWorkedOffOnce) {
  constexpr std::size_t kParts = 100;
  std::vector<int> calls(kParts);
  in_parallel(kParts, GetParam(), [&calls](std::size_t part) { ++calls[part]; });
  EXPECT_EQ(calls, std::vector<int>(kParts, 1));
}

// What a single thread meets first, whatever fails first in time.
TEST_P(InParallel, TheFailureWithTheLowestIndexIsThrown) {
  for (int again = 0; again < 50; ++again) {
    const auto fails = [](std::size_t part) {
      if (part % 7 == 3) throw std::runtime_error(std::to_string(part));
    };
    try {
      in_parallel(40, GetParam(), fails);
      FAIL();
    } catch (const std::runtime_error& failure) {
      EXPECT_STREQ(failure.what(), "3");
    }
  }
}

// The other parts rest: however late the failing thread gets a processor, they take longer.
TEST_P(InParallel, NothingIsBegunAfterAFailure) {
  constexpr std::size_t kParts = 1'000'000;
  std::atomic<std::size_t> begun{0};
  EXPECT_THROW(in_parallel(kParts, GetParam(),
                           [&begun](std::size_t part) {
                             ++begun;
                             if (part == 0) throw std::runtime_error("");
                             std::this_thread::sleep_for(std::chrono::milliseconds(10));
                           }),
               std::runtime_error);
  EXPECT_LT(begun, kParts);
}

INSTANTIATE_TEST_SUITE_P(Threads, InParallel, testing::Values(0, 1, 2, 5, 200));

TEST(InParallel, NoPartsNoCall) {
  in_parallel(0, 3, [](std::size_t) { FAIL(); });
}

// Parts that end in any order; the third goes back, which the sum does not.
TEST(SharedProgress, SumsThePartsAndNeverGoesBack) {
  std::vector<double> shown;
  const Progress progress = [&shown](double done, const std::string&) { shown.push_back(done); };
  SharedProgress shared(progress, 4, 0.5, 1.0);
  shared.show(2, 0.0, "");
  shared.show(3, 1.0, "");
  shared.show(2, 0.5, "");
  shared.show(2, 0.25, "");
  for (std::size_t part = 0; part < 3; ++part)
    shared.show(part, 1.0, "");
  EXPECT_EQ(shown, (std::vector<double>{0.5, 0.625, 0.6875, 0.6875, 0.8125, 0.9375, 1.0}));
}

}  // namespace
}  // namespace volcomp::host
