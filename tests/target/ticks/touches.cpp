// Measures what a touch of the probe costs on the board: collecting what the drives report, and
// then, from the complete latch to the point.
//
//   toolchain/run-firmware m7 touches
//
// One line per machine, a word and fields name=value, instructions, each the most of all touches:
//   touch machine=… count=… quiet=… collect=… error=… correct=… point=…
//   flank count=… derive=… judge=…                     of a face gear: its derivation, a judgement
// quiet: the reports of a cycle without an edge; collect: of one with it; error: the tables at the
// latched pose; correct: the rest; point: the most that error and correct took together.
// Exit code 1 when the counter cannot be trusted or a touch is not accepted.

#include <algorithm>
#include <memory>

#include "comp/metrology/faces/face_grid.hpp"
#include "comp/probe/face_touch.hpp"
#include "comp/probe/probe_corrector.hpp"
#include "comp/probe/touch_collector.hpp"
#include "comp/tick/instances.hpp"
#include "tests/bench/machines.hpp"
#include "tests/target/text.hpp"
#include "tests/target/ticks/cost.hpp"
#include "tests/target/ticks/motion.hpp"

namespace volcomp::target {
namespace {

constexpr int kTouches = 2'000;
constexpr std::int64_t kPeriod_ns = 2'000'000;

class TouchRun {
 public:
  TouchRun(const char* name, const MachineDescription& machine)
      : name_(name), axes_(machine.body_count - 1U), machine_(machine) {
    std::size_t a = 0;
    for (std::size_t k = 1; k < machine.body_count; ++k, ++a)
      motion_[a] = {tables_->axis[a], machine.body[k].joint.kind == JointKind::rotary};
    const auto& tool = machine.tool_point;
    require(unit_->stage(*tables_, Vec3(tool[0], tool[1], tool[2]), 0));
    require(unit_->activate());
    for (int n = 0; n < 2; ++n)
      travel();
    prepare_probe();
  }

  void measure() {
    for (int n = 0; n < kTouches; ++n)
      touch();
    put("touch");
    put_field("machine", name_);
    put_field("count", kTouches);
    put_field("quiet", quiet_);
    put_field("collect", collect_);
    put_field("error", error_);
    put_field("correct", correct_);
    put_field("point", point_);
    put('\n');
  }

 private:
  void prepare_probe() {
    TouchRules rules;
    rules.axes = (1U << axes_) - 1U;
    rules.period_ns = kPeriod_ns;
    corrector_.set_machine(machine_);
    ProbeSettings& s = corrector_.settings;
    s.probe_delay_s = 10e-6;
    s.radius.coefficient.fill(1e3);
    s.uncertainty = {160.0, 1e3, 0.5, 250.0, 300.0, 1e-3, 1e-6, {}, {}};
    for (std::size_t a = 0; a < axes_; ++a) {
      rules.delay_ns[a] = static_cast<std::int64_t>(2'000 * (a + 1));
      s.latch_delay_s[a] = static_cast<double>(rules.delay_ns[a]) * 1e-9;
    }
    collector_.configure(rules);
    for (int n = 0; n < 10; ++n)
      cycle(false);
  }

  void travel() {
    LoadedCompensator::Input in{};
    LoadedCompensator::Output out{};
    for (std::size_t a = 0; a < axes_; ++a) {
      motion_[a].step(draw_, 0);
      in.axis[a] = {motion_[a].position(), true, true};
    }
    unit_->tick(in, out);
  }

  // Every axis reports; with an edge it has latched and counted it.
  const Touch* cycle(bool edge) {
    if (edge) ++edges_;
    for (std::size_t a = 0; a < axes_; ++a) {
      LatchReport report;
      report.counted = report.homed = report.moving = true;
      report.edge_count = edges_;
      report.latched = edge;
      report.time_ns = 1'000'000U + 2'000U * static_cast<std::uint32_t>(a);
      report.axis = {motion_[a].position(), -1e6, Direction::backward};
      collector_.report(a, report);
    }
    return collector_.finish_cycle();
  }

  void touch() {
    travel();
    quiet_ = std::max(quiet_, instructions_of([&] { cycle(false); }));
    const Touch* found = nullptr;
    const std::uint32_t collect = instructions_of([&] { found = cycle(true); });
    if (found == nullptr || !accepted(found->verdict)) stop("A touch was not accepted.");
    PoseError pose_error;
    const std::uint32_t error =
        instructions_of([&] { pose_error = unit_->error_at(found->latched); });
    ProbePoint made;
    const std::uint32_t correct =
        instructions_of([&] { made = corrector_.correct(*found, feature_, pose_error); });
    if (!pose_error.known || made.sequence != found->sequence) stop("A point is not of its touch.");
    collect_ = std::max(collect_, collect);
    error_ = std::max(error_, error);
    correct_ = std::max(correct_, correct);
    point_ = std::max(point_, error + correct);
  }

  const char* name_;
  std::size_t axes_;
  const MachineDescription& machine_;
  std::unique_ptr<MachineTables> tables_ = bench::make_tables(machine_);
  std::unique_ptr<LoadedCompensator> unit_ =
      std::make_unique<LoadedCompensator>(LoadedMachine<5>{make_runtime_chain(machine_)});
  std::array<AxisMotion, kMaxAxes> motion_{};
  Draw draw_{};
  TouchCollector collector_{};
  ProbeCorrector corrector_{};
  ProbeFeature feature_{1, Vec3(0.6, 0.0, 0.8)};
  std::uint16_t edges_ = 0;
  std::uint32_t quiet_ = 0;
  std::uint32_t collect_ = 0;
  std::uint32_t error_ = 0;
  std::uint32_t correct_ = 0;
  std::uint32_t point_ = 0;
};

// Over the grid of Table 3, the ball up to 0.2 mm off.
void measure_flanks() {
  FaceGear gear;
  const std::uint32_t derived = instructions_of([&] { gear = face_gear_of_table_3(); });
  const auto grid = std::make_unique<FaceGrid>();
  require(make_face_grid(gear, face_grid_of_table_3(), *grid));
  std::uint32_t most = 0;
  std::uint32_t count = 0;
  for (const auto& row : *grid) {
    for (const FaceGridNode& node : row) {
      const double off = 0.3 + 0.1 * static_cast<double>(count % 5);
      const Vec3 centre = node.point + off * node.normal;
      FaceTouch touch;
      most = std::max(most, instructions_of([&] {
                        touch = judge_touch(gear, {}, {0.5, 0.25}, centre);
                      }));
      if (touch.verdict != Reason::ok) stop(sentence(touch.verdict));
      ++count;
    }
  }
  put("flank");
  put_field("count", count);
  put_field("derive", derived);
  put_field("judge", most);
  put('\n');
}

}  // namespace
}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  counter.start();
  TouchRun("xyfz", volcomp::kXyfzMachine).measure();
  TouchRun("xyb_a", volcomp::bench::kGrinder).measure();
  TouchRun("five_axis", volcomp::bench::kFiveAxis).measure();
  measure_flanks();
  if (!counter.exact()) stop("QEMU was not started with -icount shift=6,sleep=off.");
  return 0;
}
