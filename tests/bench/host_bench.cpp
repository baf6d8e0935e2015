// Our ticks beside what others compute, in one run (host_bench.sh).
//
//   volcomp_host_bench counts   below callgrind: the instructions of each piece of work
//   volcomp_host_bench cold     nanoseconds of one call after 8 MB of other memory were walked:
//   name,
//                               median and quarters of 2000 calls, without the call of the clock

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string_view>
#include <utility>

#include <valgrind/callgrind.h>

#include "tests/bench/work.hpp"

namespace volcomp::bench {
namespace {

constexpr std::size_t kCalls = 4 * kWalk;

// One piece after a round of the same, so that tables are ramped in and caches of the interpreter
// do not matter. The name goes to callgrind's file.
template <class Work>
[[gnu::noinline]] void count(const char* name, Work work) {
  const auto round = [&work](std::size_t calls) {
    for (std::size_t i = 0; i < calls; ++i) {
      work.fetch(i);
      work.call();
    }
  };
  round(kWalk);
  CALLGRIND_ZERO_STATS;
  round(kCalls);
  CALLGRIND_DUMP_STATS_AT(name);
}

template <class Make>
void count_both(const char* smooth, const char* jumping, const Make& make) {
  count(smooth, make(Path::smooth));
  count(jumping, make(Path::jumping));
}

template <class Machine>
auto tick_of(const MachineDescription& machine, const Machine& made = {}) {
  return [&machine, made](Path path) { return TickWork<Machine>(machine, path, made); };
}

template <class Work>
Work make(Path path) {
  return Work(path);
}

void counts() {
  using Loaded = LoadedMachine<5>;
  std::printf("calls %zu\n", kCalls);
  count("call", NoWork());
  count_both("xyfz smooth", "xyfz jumping", tick_of<CompiledMachine<kXyfzMachine>>(kXyfzMachine));
  count_both("xyfz loaded smooth", "xyfz loaded jumping",
             tick_of(kXyfzMachine, Loaded{make_runtime_chain(kXyfzMachine)}));
  count_both("five smooth", "five jumping", tick_of<CompiledMachine<kFiveAxis>>(kFiveAxis));
  count_both("five loaded smooth", "five loaded jumping",
             tick_of(kFiveAxis, Loaded{make_runtime_chain(kFiveAxis)}));
  count_both("dsp smooth", "dsp jumping", make<LookupWork<DspTable>>);
  count_both("textbook smooth", "textbook jumping", make<LookupWork<LinearTable>>);
  count_both("screw smooth", "screw jumping", make<ScrewWork>);
  count("eigen float", ChainWork<float, six_products_float>(Path::smooth));
  count("eigen double", ChainWork<double, six_products_double>(Path::smooth));
  if (!has_kdl()) return;
  count("kdl frames", ChainWork<double, six_kdl_frames>(Path::smooth));
  count("kdl chain", ChainWork<double, six_kdl_joints>(Path::smooth));
}

// Lines of the caches that hold something else afterwards.
class OtherMemory {
 public:
  void walk() {
    constexpr std::size_t kLine = 64;
    for (std::size_t i = 0; i < bytes_.size(); i += kLine)
      bytes_[i] = static_cast<unsigned char>(bytes_[i] + 1);
    keep(bytes_);
  }

 private:
  std::vector<unsigned char> bytes_ = std::vector<unsigned char>(std::size_t{8} << 20U);
};

// Nanoseconds of single calls, with those of the clock in them. What the caller has in hand, the
// positions of the call, is fetched before; tables, state and output are not.
template <class Work>
class ColdCalls {
 public:
  ColdCalls(const char* name, Work work) : name_(name), work_(std::move(work)) {}

  void time(std::size_t i, OtherMemory& other) {
    using Clock = std::chrono::steady_clock;
    other.walk();
    work_.fetch(i);
    static_cast<void>(Clock::now());  // its own lines are not meant
    const Clock::time_point begin = Clock::now();
    work_.call();
    ns_.push_back(std::chrono::duration<double, std::nano>(Clock::now() - begin).count());
  }

  [[nodiscard]] double quantile(double part) {
    std::sort(ns_.begin(), ns_.end());
    return ns_[static_cast<std::size_t>(part * static_cast<double>(ns_.size() - 1))];
  }
  void print(double of_the_clock) {
    std::printf("%s\t%.0f\t%.0f\t%.0f\n", name_, quantile(0.5) - of_the_clock,
                quantile(0.25) - of_the_clock, quantile(0.75) - of_the_clock);
  }

 private:
  const char* name_;
  Work work_;
  std::vector<double> ns_;
};

// Taken in turns, so that what else the computer does meets all of them.
void cold() {
  constexpr std::size_t kRounds = 2000;
  OtherMemory other;
  ColdCalls clock("clock", NoWork());
  ColdCalls tick("tick of XYFZ, compiled in",
                 TickWork<CompiledMachine<kXyfzMachine>>(kXyfzMachine, Path::smooth));
  ColdCalls textbook("eighteen lookups, textbook", LookupWork<LinearTable>(Path::smooth));
  ColdCalls dsp("eighteen lookups, formula of CMSIS-DSP", LookupWork<DspTable>(Path::smooth));
  for (std::size_t i = 0; i < kRounds; ++i) {
    clock.time(i, other);
    tick.time(i, other);
    textbook.time(i, other);
    dsp.time(i, other);
  }
  const double of_the_clock = clock.quantile(0.5);
  tick.print(of_the_clock);
  textbook.print(of_the_clock);
  dsp.print(of_the_clock);
}

}  // namespace
}  // namespace volcomp::bench

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (what == "counts") {
    volcomp::bench::counts();
  } else if (what == "cold") {
    volcomp::bench::cold();
  } else {
    std::fprintf(stderr, "usage: volcomp_host_bench counts|cold\n");
    return 2;
  }
  return 0;
}
