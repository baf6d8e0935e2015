// Background and tick on two cores: the last request counts, and none is lost.

#include <atomic>
#include <thread>

#include "comp/tick/status_text.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

// A tick without end, on a core of its own where there are two.
class OtherCore {
 public:
  explicit OtherCore(LoadedCompensator& compensator)
      : compensator_(compensator), thread_([this] { run(); }) {}
  ~OtherCore() {
    stop_ = true;
    thread_.join();
  }
  OtherCore(const OtherCore&) = delete;
  OtherCore& operator=(const OtherCore&) = delete;

  [[nodiscard]] std::int32_t offset() const { return offset_; }
  void wait(std::uint64_t ticks) const {
    for (const std::uint64_t from = ticks_; ticks_ < from + ticks;)
      std::this_thread::yield();
  }

 private:
  void run() {
    LoadedCompensator::Input in;
    LoadedCompensator::Output out;
    for (AxisSample& axis : in.axis)
      axis = {-10'000'000, true, true};
    while (!stop_) {
      compensator_.tick(in, out);
      offset_ = out.offset[0];
      ++ticks_;
    }
  }

  LoadedCompensator& compensator_;
  std::atomic<bool> stop_{false};
  std::atomic<std::int32_t> offset_{0};
  std::atomic<std::uint64_t> ticks_{0};
  std::thread thread_;
};

TEST(HandOver, ADeactivationIsNeverLostBetweenTwoCores) {
  Random random(75);
  SCOPED_TRACE(random.trace());
  const MachineTables tables = constant_tables(10'000.0F);
  LoadedRunner runner(tables.machine);
  LoadedCompensator::Settings settings = open_settings<5>();
  settings.ramp_ticks = 1;
  ASSERT_TRUE(runner.compensator->configure(settings).ok());
  TablesView view;
  ASSERT_TRUE(view_tables(tables, view).ok());
  const OtherCore other(*runner.compensator);
  for (int round = 0; round < 400; ++round) {
    ASSERT_TRUE(runner.compensator->stage(view, Vec3::Zero(), 1).ok()) << "round " << round;
    other.wait(1);
    ASSERT_TRUE(runner.compensator->activate().ok());
    std::atomic<int> pause{static_cast<int>(random.integer(0, 40))};
    while (pause > 0)
      --pause;
    runner.compensator->deactivate();
    while (runner.compensator->pending())
      std::this_thread::yield();
    other.wait(2);
    ASSERT_FALSE(runner.compensator->active()) << "round " << round;
    ASSERT_EQ(other.offset(), 0) << "round " << round;
  }
}

// Diagnostics are read while ticks write them: what only grows never seems to shrink.
TEST(HandOver, DiagnosticsAreReadWhileTheOtherCoreTicks) {
  const MachineTables tables = constant_tables(10'000.0F);
  LoadedRunner runner(tables.machine);
  LoadedCompensator::Settings settings = open_settings<5>();
  settings.ramp_ticks = 3;
  ASSERT_TRUE(runner.compensator->configure(settings).ok());
  TablesView view;
  ASSERT_TRUE(view_tables(tables, view).ok());
  const OtherCore other(*runner.compensator);
  Diagnostics<5> before;
  for (int round = 0; round < 200; ++round) {
    ASSERT_TRUE(runner.compensator->stage(view, Vec3::Zero(), 1).ok());
    ASSERT_TRUE(runner.compensator->activate().ok());
    const Diagnostics<5> now = runner.compensator->diagnostics();
    ASSERT_GE(now.ticks, before.ticks);
    ASSERT_GE(now.activations, before.activations);
    ASSERT_GE(now.largest[0], before.largest[0]);
    for (std::size_t bit = 0; bit < kStatusBits; ++bit)
      ASSERT_GE(now.began[0][bit], before.began[0][bit]) << code(static_cast<StatusBit>(1U << bit));
    before = now;
    while (runner.compensator->pending())
      std::this_thread::yield();
  }
  EXPECT_EQ(runner.compensator->diagnostics().activations, 200U);
}

}  // namespace
}  // namespace volcomp::test
