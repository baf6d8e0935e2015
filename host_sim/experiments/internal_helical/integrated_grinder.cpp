#include "host_sim/experiments/internal_helical/integrated_grinder.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/strokes/spectral_line.hpp"
#include "firmware/node/wire_scale.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {
namespace {

constexpr std::array<Direction, 2> kDirections{Direction::forward, Direction::backward};

// 2^-31 turn at the drive of C, 2^-40 turn for the compensation.
constexpr std::int64_t kFiner = 512;
constexpr node::WireScale kScaleOfC{kFiner, 1, true};

StrokeState stroke_state(const StrokeStep& step) {
  StrokeState s;
  s.z_command = step.z;
  s.feed_nm_per_s = step.feed_nm_per_s;
  s.slot = step.slot;
  s.stroke = step.stroke;
  s.in_face = step.in_face;
  s.stroke_end = step.stroke_end;
  s.fresh = true;
  s.homed = true;
  return s;
}

}  // namespace

IntegratedGrinder::IntegratedGrinder(const host::WatchedStrokes& watched, LearningWay way,
                                     GrinderPlant& plant, sim::MachineWatch* watch)
    : watched_(watched),
      way_(way),
      plant_(plant),
      observer_(watch != nullptr ? watch->enter() : nullptr) {
  host::require(monitor_->configure(watched.monitor), "monitor");
  host::require(offsets_->configure(watched.offsets), "offsets");
  for (auto& learner : stroke_)
    host::require(learner.start(watched.along, watched.monitor.nodes), "stroke table");
  host::require(slot_.start(watched.around, watched.slots), "slot table");
}

HelixFrame IntegratedGrinder::frame(const StrokeStep& step) {
  HelixFrame f;
  f.x = {step.x, plant_.read_x(), 0, true};
  f.z = {step.z, plant_.read_z(), 0, true};
  f.c = {kFiner * step.c, kFiner * plant_.read_c(), 0, true};
  if (watched_.target == LearningTarget::c_alone) f.z.actual = f.z.command;
  f.sequence = ++sequence_;
  f.slot = step.slot;
  f.stroke = step.stroke;
  f.in_face = step.in_face;
  return f;
}

void IntegratedGrinder::cycle(const StrokeStep& step) {
  if (step.stroke_end) collect();
  feed_nm_per_s_ = step.feed_nm_per_s;
  monitor_->tick(frame(step));
  const std::int32_t offset = offsets_->tick(stroke_state(step));
  plant_.follow_x(step.x);
  plant_.follow_z(step.z);
  const std::int64_t demand = step.c + node::offset_to_wire(offset, kScaleOfC);
  plant_.follow_c(demand);
  if (observer_) show(step, kFiner * (demand - step.c));
}

void IntegratedGrinder::show(const StrokeStep& step, std::int64_t offset_of_c) {
  ++shown_.cycle;
  shown_.period_s = kStrokeTick_s;
  shown_.axes = 3;
  const auto linear = [](char letter, std::int64_t target, std::int64_t actual) {
    sim::AxisSnapshot axis;
    axis.letter = letter;
    axis.target = target;
    axis.position = static_cast<double>(actual) / kNmPerMm;
    return axis;
  };
  sim::AxisSnapshot& c = shown_.axis[2];
  shown_.axis[0] = linear('X', step.x, plant_.read_x());
  shown_.axis[1] = linear('Z', step.z, plant_.read_z());
  c.letter = 'C';
  c.rotary = true;
  c.target = kFiner * step.c;
  c.offset = offset_of_c;
  c.position = static_cast<double>(plant_.read_c()) / kWirePerRad;
  observer_->cycle(shown_);
}

void IntegratedGrinder::collect() {
  if (monitor_->pass_waits()) host::require(monitor_->collect(), "pass");
}

std::vector<NodeSums> IntegratedGrinder::stroke_sums(Direction direction) const {
  const std::size_t nodes = watched_.monitor.nodes;
  std::vector<NodeSums> sums(nodes);
  monitor_->totals().stroke_sums(direction, sums);
  if (way_ != LearningWay::one_table) return sums;
  const Direction other =
      direction == Direction::forward ? Direction::backward : Direction::forward;
  std::vector<NodeSums> more(nodes);
  monitor_->totals().stroke_sums(other, more);
  for (std::size_t j = 0; j < nodes; ++j) {
    sums[j].n += more[j].n;
    sums[j].sum += more[j].sum;
    sums[j].sum_squares += more[j].sum_squares;
  }
  return sums;
}

std::vector<NodeSums> IntegratedGrinder::slot_sums() const {
  std::vector<NodeSums> sums(watched_.slots);
  monitor_->totals().slot_sums(sums);
  return sums;
}

template <std::size_t N>
void IntegratedGrinder::step(OffsetLearner<N>& learner, const std::vector<NodeSums>& sums) {
  const double J = kUmPerMm * watched_.monitor.flank_per_rad * rms_of_means(learner.rules(), sums);
  learner.step(J, sums);
}

void IntegratedGrinder::learn() {
  collect();
  for (std::size_t d = 0; d < kDirections.size(); ++d)
    step(stroke_[d], stroke_sums(kDirections[d]));
  step(slot_, slot_sums());
  host::require(
      offsets_->stage({stroke_[0].table(), stroke_[1].table(), slot_.table(),
                       watched_.monitor.z0_nm, watched_.monitor.node_pitch_nm, feed_nm_per_s_}),
      "tables");
  host::require(offsets_->activate(), "tables");
  monitor_->totals().clear();
}

std::vector<double> IntegratedGrinder::means_on_flank(const std::vector<NodeSums>& sums) const {
  std::vector<double> means;
  means.reserve(sums.size());
  for (const NodeSums& node : sums)
    means.push_back(node.n == 0 ? 0.0
                                : kUmPerMm * watched_.monitor.flank_per_rad * node.sum / node.n);
  return means;
}

MonitorView IntegratedGrinder::view() {
  collect();
  MonitorView view;
  for (std::size_t d = 0; d < kDirections.size(); ++d)
    view.stroke[d] = means_on_flank(stroke_sums(kDirections[d]));
  for (std::size_t k = 0; k < kMostLines; ++k) {
    const auto amplitude = [this, k](Direction d) {
      return spectral_line(monitor_->totals().spectra(d).order[k]).amplitude;
    };
    view.along.push_back(std::hypot(amplitude(kDirections[0]), amplitude(kDirections[1])) /
                         std::sqrt(2.0));
  }
  const std::vector<NodeSums> slots = slot_sums();
  view.slot = means_on_flank(slots);
  view.around = orders_around(view.slot);
  const std::vector<NodeSums> forward = stroke_sums(Direction::forward);
  view.over_stroke = repeatability(forward, stroke_[0].rules().least_samples);
  view.over_slots = repeatability(slots, slot_.rules().least_samples);
  view.knows_repeats = true;
  return view;
}

LearnedTables IntegratedGrinder::tables() {
  const auto copy = [](Span<const double> t) { return std::vector<double>(t.begin(), t.end()); };
  return {static_cast<double>(watched_.monitor.z0_nm) / kNmPerMm,
          watched_.monitor.node_pitch_nm / kNmPerMm,
          {copy(stroke_[0].table()), copy(stroke_[1].table())},
          copy(slot_.table())};
}

}  // namespace volcomp::internal_helical
