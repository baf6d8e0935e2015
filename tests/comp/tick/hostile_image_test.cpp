// Images with right checksums and absurd numbers. Whatever of them is accepted, no offset leaves
// its limit and none is faster than its rate.

#include "tests/oracle/hostile_machines.hpp"
#include "tests/oracle/offset_promise.hpp"

namespace volcomp::test {
namespace {

constexpr std::int32_t kLimit = 300'000;
constexpr std::int32_t kRate = 100'000;

template <class Unit>
typename Unit::Settings settings() {
  typename Unit::Settings s;
  for (AxisLimits& l : s.axis) {
    l.limit = kLimit;
    l.rate = kRate;
  }
  s.ramp_ticks = 2;
  return s;
}

// One compensator for all images: it is restarted for each.
template <class Unit>
class Victim {
 public:
  Victim() : unit_(std::make_unique<Unit>()) {
    EXPECT_TRUE(unit_->configure(settings<Unit>()).ok());
    promise_.configured(settings<Unit>());
  }

  [[nodiscard]] int accepted() const { return accepted_; }

  template <class Machine>
  bool survives(const Machine& machine, const TablesView& view, const Vec3& tool, Random& random) {
    unit_->restart(machine);
    if (!unit_->stage(view, tool, 1).ok()) return true;
    ++accepted_;
    return unit_->activate().ok() && keeps_within(view, random);
  }

 private:
  // Ticks over random places of the tables and beside them; false at the first broken promise.
  bool keeps_within(const TablesView& tables, Random& random) {
    typename Unit::Input in;
    typename Unit::Output out;
    promise_.started({});
    for (int n = 0; n < 12; ++n) {
      for (std::size_t a = 0; a < tables.chain.axis_count(); ++a) {
        const TableGrid& grid = tables.axis[a].grid();
        in.axis[a].position = random.chance(0.9) ? random.integer(grid.q0, grid.last())
                                                 : random.integer(INT64_MIN, INT64_MAX);
        in.axis[a].valid = n % 11 != 9;
        in.axis[a].homed = true;
      }
      unit_->tick(in, out);
      std::size_t axis = 0;
      const char* const broken = promise_.broken_by(*unit_, out, axis);
      if (broken == nullptr) continue;
      ADD_FAILURE() << broken << ": axis " << axis << ", offset " << out.offset[axis];
      return false;
    }
    return true;
  }

  std::unique_ptr<Unit> unit_;
  OffsetPromise<Unit> promise_{};
  int accepted_ = 0;
};

// Every kind of machine that is compiled, as it is delivered (comp/tick/instances.hpp).
struct Victims {
  Victim<LoadedCompensator> position;
  Victim<OrientingCompensator> orienting;
  Victim<XyfzCompensator> compiled;
  TablesView view;

  bool survive(const ImageBytes& image, bool compiled_in, Random& random) {
    if (!check_image({image.data(), image.size()}, kDefaultKnots, view).ok()) return true;
    const MachineDescription& d = view.chain.description();
    const RuntimeChain chain = make_runtime_chain(d);
    if (chain.axes > LoadedCompensator::kAxes) return true;
    const Vec3 tool = tool_of(d);
    return position.survives(PositionMachine{chain}, view, tool, random) &&
           orienting.survives(OrientingMachine{chain}, view, tool, random) &&
           (!compiled_in || compiled.survives(CompiledMachine<kXyfzMachine>{}, view, tool, random));
  }
};

// VOLCOMP_HOSTILE_IMAGES: how many, else 60 000 of kManyPoints. One in four is accepted, and
// staging that takes 0.3 ms, most of it the checksum of the set.
int image_count() {
  const char* const text = std::getenv("VOLCOMP_HOSTILE_IMAGES");
  return text == nullptr ? kManyPoints / 50 * 3 : std::atoi(text);
}

TEST(HostileImage, NothingAcceptedLeavesLimitOrRate) {
  Random random(71);
  SCOPED_TRACE(random.trace());
  std::mt19937_64 bits(seed() + 72);
  const std::vector<ImageBytes> seeds = hostile_seeds(random);
  Victims victims;
  for (int i = 0; i < image_count(); ++i) {
    const std::size_t which = static_cast<std::size_t>(i) % seeds.size();
    ImageBytes image = seeds[which];
    HostileImage(image.data(), image.size()).mutate(bits);
    ASSERT_TRUE(victims.survive(image, is_compiled_in(which), random)) << "image " << i;
  }
  EXPECT_GT(victims.position.accepted(), image_count() / 100);
  EXPECT_GT(victims.orienting.accepted(), image_count() / 100);
  EXPECT_GT(victims.compiled.accepted(), image_count() / 1000);
}

// A slide 1e20 mm away is none, and the reason names it.
TEST(HostileImage, AbsurdGeometryIsRefusedWithItsBody) {
  Random random(73);
  for (const MachineDescription& machine : hostile_machines()) {
    for (const double absurd : {5001.0, 1e20, 1e33, -1e300}) {
      MachineTables t = small_tables(machine, random);
      t.machine.body[2].joint.offset[1] = absurd;
      const ImageBytes image = image_bytes(t);
      TablesView view;
      const Status status = check_image({image.data(), image.size()}, kDefaultKnots, view);
      EXPECT_EQ(status.reason, Reason::bound_exceeded) << absurd;
      EXPECT_EQ(status.where.body, 3) << absurd;
    }
  }
}

TEST(HostileImage, AToolPointBeyondAnyToolIsRefused) {
  Random random(74);
  const MachineTables t = small_tables(hostile_trunnion(false), random);
  LoadedRunner runner(t.machine);
  const Status status = runner.compensator->stage(t, Vec3(0.0, 0.0, 1e33), 1);
  EXPECT_EQ(status.reason, Reason::bound_exceeded);
  EXPECT_STREQ(status.where.field, "tool_point");
}

}  // namespace
}  // namespace volcomp::test
