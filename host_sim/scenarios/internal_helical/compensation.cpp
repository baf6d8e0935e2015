#include "host_sim/scenarios/internal_helical/compensation.hpp"

#include <cmath>

#include "comp/evaluation/spectral_line.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr double kFirstNode_mm = -0.5 * kFaceWidth_mm;
constexpr std::array<Direction, 2> kDirections{Direction::forward, Direction::backward};

// w, node spacing and passes are those of seed 003, addendum; limits keep a bad pass out and are
// several times what the simulated machine needs.
LearningRules stroke_rules(double pitch_mm) {
  LearningRules rules;
  rules.weight = 0.5;
  rules.least_samples = 8;
  rules.most_step = 1e-3;
  rules.most_offset = 2e-3;
  rules.most_slope = 1e-3;
  rules.spacing = pitch_mm;
  return rules;
}

// Slots are not smoothed: their errors need not resemble each other, and C has come to rest before
// the face, so there is no lag that would have to be kept out of the loop.
LearningRules slot_rules() {
  LearningRules rules = stroke_rules(1.0);
  rules.periodic = true;
  rules.least_samples = 2;  // passes: one each way
  rules.most_slope = 1e-4;
  rules.taps = {1.0};
  rules.tap_count = 1;
  return rules;
}

std::vector<double> means_on_flank(const InternalGear& gear, const std::vector<NodeSums>& sums) {
  std::vector<double> means;
  means.reserve(sums.size());
  for (const NodeSums& node : sums)
    means.push_back(node.n == 0 ? 0.0 : kUmPerMm * gear.normal_lever() * node.sum / node.n);
  return means;
}

}  // namespace

HelixCompensation::HelixCompensation(const InternalGear& gear, double flank_per_x, LearningWay way)
    : gear_(gear),
      way_(way),
      pitch_mm_(way == LearningWay::coarse ? 1.0 : 0.25),
      nodes_(static_cast<std::size_t>(std::lround(kFaceWidth_mm / pitch_mm_)) + 1) {
  HelixMonitorSettings settings;
  settings.turn_per_mm = gear.turn_per_mm;
  settings.flank_per_rad = gear.normal_lever();
  settings.flank_per_x = flank_per_x;
  settings.tick_ns = static_cast<std::int32_t>(kStrokeTick_s * 1e9);
  settings.z0_nm = to_nm(kFirstNode_mm);
  settings.node_pitch_nm = static_cast<std::uint32_t>(to_nm(pitch_mm_));
  settings.nodes = nodes_;
  settings.order_wavelength_mm = kWavelengths_mm;
  require(monitor_->configure(settings), "monitor");
  StrokeOffsetSettings offsets;
  offsets.rate = 20'000;  // 29 µrad per tick: the tables of the two directions meet within 0.1 s
  require(offsets_->configure(offsets), "offsets");
  for (auto& learner : stroke_)
    require(learner.start(stroke_rules(pitch_mm_), nodes_), "stroke table");
  require(slot_.start(slot_rules(), static_cast<std::size_t>(gear.teeth)), "slot table");
}

std::int32_t HelixCompensation::tick(const ProcessState& state) {
  HelixFrame frame = helix_frame(state);
  if (way_ == LearningWay::c_alone) frame.z.actual = frame.z.command;
  monitor_->tick(frame);
  return offsets_->tick(stroke_state(state));
}

void HelixCompensation::collect() {
  if (monitor_->pass_waits()) require(monitor_->collect(), "pass");
}

std::vector<NodeSums> HelixCompensation::stroke_sums(Direction direction) const {
  std::vector<NodeSums> sums(nodes_);
  monitor_->totals().stroke_sums(direction, sums);
  if (way_ != LearningWay::one_table) return sums;
  const Direction other =
      direction == Direction::forward ? Direction::backward : Direction::forward;
  std::vector<NodeSums> more(nodes_);
  monitor_->totals().stroke_sums(other, more);
  for (std::size_t j = 0; j < nodes_; ++j) {
    sums[j].n += more[j].n;
    sums[j].sum += more[j].sum;
    sums[j].sum_squares += more[j].sum_squares;
  }
  return sums;
}

std::vector<NodeSums> HelixCompensation::slot_sums() const {
  std::vector<NodeSums> sums(static_cast<std::size_t>(gear_.teeth));
  monitor_->totals().slot_sums(sums);
  return sums;
}

template <std::size_t N>
void HelixCompensation::step(OffsetLearner<N>& learner, const std::vector<NodeSums>& sums) {
  const double J = kUmPerMm * gear_.normal_lever() * rms_of_means(learner.rules(), sums);
  learner.step(J, sums);
}

void HelixCompensation::learn() {
  for (std::size_t d = 0; d < kDirections.size(); ++d)
    step(stroke_[d], stroke_sums(kDirections[d]));
  step(slot_, slot_sums());
  require(offsets_->stage({stroke_[0].table(), stroke_[1].table(), slot_.table(),
                           to_nm(kFirstNode_mm), static_cast<std::uint32_t>(to_nm(pitch_mm_)),
                           static_cast<std::int32_t>(to_nm(kStrokeFeed_mm_per_s))}),
          "tables");
  require(offsets_->activate(), "tables");
  monitor_->totals().clear();
}

MonitorView HelixCompensation::view() const {
  MonitorView view;
  std::array<OrderLine, kMostLines> lines{};
  for (std::size_t d = 0; d < kDirections.size(); ++d) {
    view.stroke[d] = means_on_flank(gear_, stroke_sums(kDirections[d]));
    for (std::size_t k = 0; k < kMostLines; ++k)
      lines[k].merge(monitor_->totals().spectra(kDirections[d]).order[k]);
  }
  for (const OrderLine& line : lines)
    view.along.push_back(spectral_line(line).amplitude);
  const std::vector<NodeSums> slots = slot_sums();
  view.slot = means_on_flank(gear_, slots);
  for (int order = 1; order <= gear_.teeth / 2; ++order)
    view.around.push_back(kUmPerMm * gear_.normal_lever() * order_around(slots, order).amplitude);
  const std::vector<NodeSums> forward = stroke_sums(Direction::forward);
  view.over_stroke = repeatability(forward, stroke_[0].rules().least_samples);
  view.over_slots = repeatability(slots, slot_.rules().least_samples);
  return view;
}

LearnedTables HelixCompensation::tables() const {
  const auto copy = [](Span<const double> t) { return std::vector<double>(t.begin(), t.end()); };
  return {kFirstNode_mm,
          pitch_mm_,
          {copy(stroke_[0].table()), copy(stroke_[1].table())},
          copy(slot_.table())};
}

}  // namespace volcomp::sim
