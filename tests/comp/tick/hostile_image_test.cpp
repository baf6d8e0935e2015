// Images with right checksums and absurd numbers. Whatever of them is accepted, no offset leaves
// its limit and none is faster than its rate.

#include "tests/oracle/hostile_image.hpp"

#include "comp/metrology/gears/internal_grinder.hpp"
#include "comp/metrology/gears/l300g.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

constexpr std::int32_t kLimit = 300'000;
constexpr std::int32_t kRate = 100'000;

// X, Y, Z and a table on a trunnion A, C; A and C hold the direction of the tool.
MachineDescription trunnion(bool orients) {
  MachineDescription d;
  d.body_count = 6;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::y, -1, 1, 'Y', {10, 20, 30});
  d.body[2] = moving_body(2, JointKind::rotary, Axis::x, 1, 3, 'A', {1, 2, 50});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::z, 1, 4, 'C', {0.5, 0.1, 20});
  d.body[4] = moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X', {5, 6, 400});
  d.body[5] = moving_body(5, JointKind::prismatic, Axis::z, 1, 2, 'Z', {7, 8, 9});
  d.work_body = 4;
  d.tool_body = 6;
  d.tool_point = {0, 0, -120};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  d.orienting = {3, 4};
  d.orienting_count = orients ? 2 : 0;
  return d;
}

// Of a machine whose angles nobody has measured, `epsilon` is 0.
MachineTables tables_of(const MachineDescription& machine, Random& random, double epsilon = 2e-5) {
  MachineTables t;
  t.machine = machine;
  for (std::size_t k = 0; k < machine.body_count; ++k) {
    const Joint& joint = machine.body[k].joint;
    if (!joint.moves()) continue;
    const bool turns = joint.kind == JointKind::rotary;
    t.axis[joint.nc_axis] = turns
                                ? random_table(0, kTurn / 4, 4, 8e3, epsilon, random)
                                : random_table(-400'000'000, 200'000'000, 5, 8e3, epsilon, random);
    t.axis[joint.nc_axis].periodic = turns;
  }
  return t;
}

std::vector<MachineDescription> machines() {
  return {kXyfzMachine,
          l300g_machine({}, {}),
          internal_grinder(GrinderY::none),
          internal_grinder(GrinderY::on_z),
          trunnion(false),
          trunnion(true)};
}

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

// Ticks over random places of the tables and beside them; false at the first broken promise.
template <class Unit>
bool keeps_within(Unit& unit, const TablesView& tables, Random& random) {
  typename Unit::Input in;
  typename Unit::Output out;
  std::array<std::int32_t, Unit::kAxes> last{};
  for (int n = 0; n < 12; ++n) {
    for (std::size_t a = 0; a < tables.chain.axis_count(); ++a) {
      const TableGrid& grid = tables.axis[a].grid();
      in.axis[a].position = random.chance(0.9) ? random.integer(grid.q0, grid.last())
                                               : random.integer(INT64_MIN, INT64_MAX);
      in.axis[a].valid = n % 11 != 9;
      in.axis[a].homed = true;
    }
    unit.tick(in, out);
    for (std::size_t a = 0; a < tables.chain.axis_count(); ++a) {
      if (std::abs(out.offset[a]) > kLimit || std::abs(out.offset[a] - last[a]) > kRate)
        return false;
      last[a] = out.offset[a];
    }
  }
  return true;
}

// One compensator for all images: it is restarted for each.
template <class Unit>
class Victim {
 public:
  Victim() : unit_(std::make_unique<Unit>()) {
    EXPECT_TRUE(unit_->configure(settings<Unit>()).ok());
  }

  [[nodiscard]] int accepted() const { return accepted_; }

  template <class Machine>
  bool survives(const Machine& machine, const TablesView& view, const Vec3& tool, Random& random) {
    unit_->restart(machine);
    if (!unit_->stage(view, tool, 1).ok()) return true;
    ++accepted_;
    return unit_->activate().ok() && keeps_within(*unit_, view, random);
  }

 private:
  std::unique_ptr<Unit> unit_;
  int accepted_ = 0;
};

// Every kind of machine that is compiled (comp/tick/instances.hpp).
template <std::size_t Knots>
struct Victims {
  Victim<Compensator<PositionMachine, Knots>> position;
  Victim<Compensator<OrientingMachine, Knots>> orienting;
  Victim<Compensator<CompiledMachine<kXyfzMachine>, Knots>> compiled;
  TablesView view;

  bool survive(const ImageBytes& image, bool xyfz, Random& random) {
    if (!check_image({image.data(), image.size()}, Knots, view).ok()) return true;
    const MachineDescription& d = view.chain.description();
    const RuntimeChain chain = make_runtime_chain(d);
    if (chain.axes > LoadedCompensator::kAxes) return true;
    const Vec3 tool = tool_of(d);
    return position.survives(PositionMachine{chain}, view, tool, random) &&
           orienting.survives(OrientingMachine{chain}, view, tool, random) &&
           (!xyfz || compiled.survives(CompiledMachine<kXyfzMachine>{}, view, tool, random));
  }
};
constexpr std::size_t kFewKnots = 8;

// VOLCOMP_HOSTILE_IMAGES: how many, else a tenth of kManyPoints.
int image_count() {
  const char* const text = std::getenv("VOLCOMP_HOSTILE_IMAGES");
  return text == nullptr ? kManyPoints / 10 : std::atoi(text);
}

TEST(HostileImage, NothingAcceptedLeavesLimitOrRate) {
  Random random(71);
  SCOPED_TRACE(random.trace());
  std::mt19937_64 bits(seed() + 72);
  std::vector<ImageBytes> good;
  for (const MachineDescription& machine : machines()) {
    for (const double epsilon : {2e-5, 0.0}) {
      good.push_back(image_bytes(tables_of(machine, random, epsilon)));
      ASSERT_FALSE(good.back().empty());
    }
  }
  Victims<kFewKnots> quick;  // staging them takes a tenth of the time
  Victims<kDefaultKnots> full;
  for (int i = 0; i < image_count(); ++i) {
    const std::size_t which = static_cast<std::size_t>(i) % good.size();
    ImageBytes image = good[which];
    HostileImage(image.data(), image.size()).mutate(bits);
    const bool xyfz = which < 2;
    ASSERT_TRUE(quick.survive(image, xyfz, random)) << "image " << i;
    const bool both = i % 100 < 2;
    ASSERT_TRUE(!both || full.survive(image, xyfz, random)) << "image " << i;
  }
  EXPECT_GT(quick.position.accepted(), image_count() / 100);
  EXPECT_GT(quick.orienting.accepted(), image_count() / 100);
  EXPECT_GT(quick.compiled.accepted(), image_count() / 1000);
}

// A slide 1e20 mm away is none, and the reason names it.
TEST(HostileImage, AbsurdGeometryIsRefusedWithItsBody) {
  Random random(73);
  for (const MachineDescription& machine : machines()) {
    for (const double absurd : {5001.0, 1e20, 1e33, -1e300}) {
      MachineTables t = tables_of(machine, random);
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
  const MachineTables t = tables_of(trunnion(false), random);
  LoadedRunner runner(t.machine);
  const Status status = runner.compensator->stage(t, Vec3(0.0, 0.0, 1e33), 1);
  EXPECT_EQ(status.reason, Reason::bound_exceeded);
  EXPECT_STREQ(status.where.field, "tool_point");
}

// IEEE 754: every comparison with NaN is false. It must not pass for that.
TEST(HostileImage, NotANumberDoesNotPassTheLimiter) {
  bool hit = false;
  const Limiter<float> limiter{5.0F, 1.0F};
  EXPECT_LE(std::abs(limiter.clamp(std::nanf(""), hit)), 5.0F);
  EXPECT_TRUE(hit);
  EXPECT_LE(std::abs(limiter.slew(std::nanf(""), 2.0F, hit) - 2.0F), 1.0F);
  EXPECT_TRUE(hit);
}

}  // namespace
}  // namespace volcomp::test
