// A fixed sample of hostile images, for boards, too: nothing accepted leaves limit or rate, and the
// same of them are accepted and run to the same bits as on any computer.

#include "tests/oracle/fixed_numbers.hpp"
#include "tests/oracle/hostile_machines.hpp"
#include "tests/oracle/offset_promise.hpp"

namespace volcomp::test {
namespace {

constexpr int kImages = 360;
constexpr std::int32_t kLimit = 50'000;
constexpr std::int32_t kRate = 20'000;

template <class Unit>
class Sample {
 public:
  Sample() : unit_(std::make_unique<Unit>()) {
    typename Unit::Settings settings;
    for (AxisLimits& l : settings.axis) {
      l.limit = kLimit;
      l.rate = kRate;
    }
    settings.ramp_ticks = 3;
    EXPECT_TRUE(unit_->configure(settings).ok());
    promise_.configured(settings);
  }

  [[nodiscard]] std::uint32_t digest() const { return digest_.value(); }
  [[nodiscard]] int accepted() const { return accepted_; }

  template <class Machine>
  void run(const Machine& machine, const TablesView& view, std::mt19937_64& bits) {
    unit_->restart(machine);
    const Status staged = unit_->stage(view, tool_of(view.chain.description()), 1);
    digest_.add(static_cast<std::uint64_t>(staged.reason), 1);
    digest_.end_record();
    if (!staged.ok()) return;
    ++accepted_;
    ASSERT_TRUE(unit_->activate().ok());
    promise_.started({});
    for (int n = 0; n < 12; ++n)
      tick(view, bits);
  }

 private:
  void tick(const TablesView& view, std::mt19937_64& bits) {
    const std::size_t axes = view.chain.axis_count();
    for (std::size_t a = 0; a < axes; ++a) {
      const TableGrid& grid = view.axis[a].grid();
      const auto span = static_cast<std::uint64_t>(grid.last() - grid.q0);
      const std::uint64_t drawn = bits();
      const bool anywhere = drawn % 8 == 0;
      const auto inside = grid.q0 + static_cast<std::int64_t>(drawn % (span + 1));
      in_.axis[a] = {anywhere ? static_cast<std::int64_t>(bits()) : inside, bits() % 16 != 0, true};
    }
    unit_->tick(in_, out_);
    std::size_t axis = 0;
    const char* const broken = promise_.broken_by(*unit_, out_, axis);
    EXPECT_TRUE(broken == nullptr) << (broken == nullptr ? "" : broken) << ": axis " << axis;
    for (std::size_t a = 0; a < axes; ++a) {
      digest_.add(static_cast<std::uint32_t>(out_.offset[a]), 4);
      digest_.add(out_.status[a], 2);
    }
    digest_.end_record();
  }

  std::unique_ptr<Unit> unit_;
  OffsetPromise<Unit> promise_{};
  typename Unit::Input in_{};
  typename Unit::Output out_{};
  Digest digest_{};
  int accepted_ = 0;
};

// Calls visit(view, number of the seed) for every image of the sample that passes its checks.
template <class Visit>
void visit_sample(const Visit& visit) {
  Random random(7U - seed());  // 7 whatever VOLCOMP_TEST_SEED is
  std::mt19937_64 bits(8);
  const std::vector<ImageBytes> seeds = hostile_seeds(random);
  TablesView view;
  for (std::size_t i = 0; i < kImages; ++i) {
    ImageBytes image = seeds[i % seeds.size()];
    HostileImage(image.data(), image.size()).mutate(bits);
    if (check_image({image.data(), image.size()}, kDefaultKnots, view).ok())
      visit(view, i % seeds.size(), bits);
  }
}

TEST(HostileDigest, Loaded) {
  Sample<LoadedCompensator> sample;
  visit_sample([&](const TablesView& view, std::size_t, std::mt19937_64& bits) {
    sample.run(PositionMachine{make_runtime_chain(view.chain.description())}, view, bits);
  });
  EXPECT_EQ(sample.accepted(), 74);
  EXPECT_EQ(sample.digest(), 4'158'858'562U);
}

TEST(HostileDigest, Orienting) {
  Sample<OrientingCompensator> sample;
  visit_sample([&](const TablesView& view, std::size_t, std::mt19937_64& bits) {
    sample.run(OrientingMachine{make_runtime_chain(view.chain.description())}, view, bits);
  });
  EXPECT_EQ(sample.accepted(), 96);
  EXPECT_EQ(sample.digest(), 1'390'846'478U);
}

TEST(HostileDigest, CompiledIn) {
  Sample<XyfzCompensator> sample;
  visit_sample([&](const TablesView& view, std::size_t which, std::mt19937_64& bits) {
    if (is_compiled_in(which)) sample.run(CompiledMachine<kXyfzMachine>{}, view, bits);
  });
  EXPECT_EQ(sample.accepted(), 7);
  EXPECT_EQ(sample.digest(), 3'775'964'703U);
}

}  // namespace
}  // namespace volcomp::test
