// Strokes on the bus: what the background makes of the passes.

#include "comp/core/bytes.hpp"
#include "comp/strokes/spectral_line.hpp"
#include "firmware/node/strokes/stroke_service.hpp"

namespace volcomp::node {

namespace {

constexpr std::array<Direction, 2> kDirections{Direction::forward, Direction::backward};
constexpr std::size_t kSlotTable = 2;

Status other_feed(std::int32_t feed_nm_per_s) {
  Where where;
  where.has_value = true;
  where.value = feed_nm_per_s / kNmPerMm;
  return refuse(Reason::feed_mismatch, where);
}

// More than 2 % apart.
bool apart(std::int32_t a, std::int32_t b) {
  const std::int64_t between = std::int64_t{a} - b;
  return 50 * (between < 0 ? -between : between) > (a < b ? a : b);
}

}  // namespace

void StrokeService::work() {
  if (!on_ || !monitor_.pass_waits()) return;
  Status status;
  {
    const Preemptible preemptible(preemption_);
    status = monitor_.collect();
  }
  if (!status.ok() && objects_.discarded < UINT32_MAX) ++objects_.discarded;
}

// --- learning

Status StrokeService::learn(LearnCommand command) {
  if (command == LearnCommand::none) return {};
  if (!on_) return bad("command");
  switch (command) {
    case LearnCommand::learn:
      if (const Status s = check_learning(); !s.ok()) return s;
      return update();
    case LearnCommand::start_over:
      offsets_.deactivate();
      objects_.table_feed = 0;
      return start_learners();
    case LearnCommand::stop:
      offsets_.deactivate();
      return {};
    case LearnCommand::resume:
      return put_in_force(objects_.table_feed);
    default:
      forget();
      return {};
  }
}

Status StrokeService::check_learning() {
  if (offsets_.pending()) return refuse(Reason::hand_over_pending);
  const auto target = static_cast<LearningTarget>(objects_.target);
  if (target != LearningTarget::synchronisation && target != LearningTarget::c_alone)
    return bad("target");
  work();
  RunningStatistics lag;
  RunningStatistics sync;
  for (const Direction direction : kDirections) {
    // Strokes of one direction suffice; the lags of the two directions have opposite signs.
    const StrokeSpectra& seen = monitor_.totals().spectra(direction);
    if (seen.of(FlankSignal::sync).count() == 0) continue;
    lag = seen.of(FlankSignal::lag_c);
    sync = seen.of(FlankSignal::sync);
  }
  if (sync.count() == 0) return refuse(Reason::too_few_points);
  const double e_c = lag.mean() / (kUmPerMm * settings_.flank_per_rad);
  const double e_s = sync.mean() / (kUmPerMm * settings_.flank_per_rad);
  const bool helix = settings_.turn_per_mm < 0.0 || settings_.turn_per_mm > 0.0;
  HelixEffect effect;
  const Status status = check_learning_target(
      target, helix, objects_.force != 0, settings_.flank_per_rad, settings_.turn_per_mm,
      helix ? (e_s - e_c) / settings_.turn_per_mm : 0.0, e_c, effect);
  objects_.prediction_um = {static_cast<float>(effect.z_um), static_cast<float>(effect.c_um),
                            static_cast<float>(effect.together_um)};
  return status.ok() ? check_feed() : status;
}

// Tables hold for one feed.
Status StrokeService::check_feed() const {
  if (slowest_ <= 0 || fastest_ < slowest_) return bad("feed");
  if (apart(slowest_, fastest_)) return other_feed(fastest_);
  if (objects_.table_feed != 0 && apart(objects_.table_feed, fastest_))
    return other_feed(objects_.table_feed);
  return {};
}

void StrokeService::forget() {
  slowest_ = INT32_MAX;
  fastest_ = 0;
  const Preemptible preemptible(preemption_);
  monitor_.totals().clear();
}

Status StrokeService::update() {
  const std::int32_t feed = objects_.table_feed != 0 ? objects_.table_feed : fastest_;
  std::array<LearnedTable, kStrokeTables> learned;
  {
    const Preemptible preemptible(preemption_);
    learned = {step(stroke_[0], 0), step(stroke_[1], 1), step(slot_, kSlotTable)};
  }
  objects_.learned = learned;
  if (const Status s = put_in_force(feed); !s.ok()) return s;
  forget();
  return {};
}

void StrokeService::sums_of(std::size_t table, Span<NodeSums> out) const {
  if (table == kSlotTable) {
    monitor_.totals().slot_sums(out);
  } else {
    monitor_.totals().stroke_sums(kDirections[table], out);
  }
}

std::size_t StrokeService::length(std::size_t table) const {
  return table == kSlotTable ? slot_.size() : stroke_[0].size();
}

template <std::size_t Nodes>
LearnedTable StrokeService::step(OffsetLearner<Nodes>& learner, std::size_t table) {
  const Span<NodeSums> sums{sums_.data(), learner.size()};
  sums_of(table, sums);
  const double rms = kUmPerMm * settings_.flank_per_rad *
                     rms_of_means(learner.rules(), {sums.data(), sums.size()});
  const LearnerStep step = learner.step(rms, {sums.data(), sums.size()});
  LearnedTable shown;
  shown.action = static_cast<std::uint8_t>(step.action);
  shown.result = static_cast<std::uint8_t>(step.report.result);
  shown.updated = static_cast<std::uint16_t>(step.report.updated);
  shown.clamped = static_cast<std::uint16_t>(step.report.clamped);
  shown.skipped = static_cast<std::uint16_t>(step.report.skipped);
  shown.flank_rms_um = rms;
  shown.weight = learner.rules().weight;
  return shown;
}

Status StrokeService::put_in_force(std::int32_t feed) {
  if (feed <= 0) return refuse(Reason::not_staged);
  Status status;
  {
    const Preemptible preemptible(preemption_);
    status = offsets_.stage({stroke_[0].table(), stroke_[1].table(), slot_.table(), settings_.z0_nm,
                             settings_.node_pitch_nm, feed});
  }
  if (!status.ok()) return status;
  objects_.table_feed = feed;
  return offsets_.activate();
}

// --- what is read

void StrokeService::show_side(std::size_t direction) {
  const auto& totals = monitor_.totals();
  const StrokeSpectra& seen = totals.spectra(kDirections[direction]);
  double* figure = objects_.figures[direction].data();
  for (const RunningStatistics& signal : seen.signal) {
    *figure++ = signal.count();
    *figure++ = signal.mean();
    *figure++ = signal.peak();
    *figure++ = signal.deviation();
    *figure++ = signal.rms();
  }
  double* line = objects_.lines[direction].data();
  for (const OrderLine& along : seen.order)
    *line++ = spectral_line(along).amplitude;
  for (std::size_t k = 0; k < kMostLines; ++k)
    *line++ = totals.time_amplitude(kDirections[direction], k);
  objects_.passes[direction] = totals.passes(kDirections[direction]);
}

void StrokeService::publish() {
  if (!on_) return;
  work();
  for (std::size_t use = 0; use < kFrameUses; ++use)
    objects_.frames[use] = monitor_.frames(static_cast<FrameUse>(use));
  objects_.passes_lost = monitor_.passes_lost();
  objects_.outside = monitor_.outside();
  objects_.out_of_table = offsets_.out_of_table();
  objects_.stale = offsets_.stale();
  show_side(0);
  show_side(1);
}

Span<const std::uint8_t> StrokeService::means(std::size_t table) {
  if (!on_) return {};
  work();
  const Span<NodeSums> sums{sums_.data(), length(table - 1)};
  sums_of(table - 1, sums);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double mean = sums[k].n == 0 ? 0.0 : sums[k].sum / static_cast<double>(sums[k].n);
    store_real(&image_[4 * k], mean);
  }
  return {image_.data(), 4 * sums.size()};
}

// --- tables as bytes

LearnedLayout StrokeService::layout(std::uint32_t machine_id) const {
  return {machine_id,
          static_cast<std::uint16_t>(stroke_[0].size()),
          static_cast<std::uint16_t>(slot_.size()),
          settings_.z0_nm,
          settings_.node_pitch_nm,
          objects_.table_feed};
}

Span<const std::uint8_t> StrokeService::image(std::uint32_t machine_id) {
  if (!on_ || objects_.table_feed == 0) return {};
  const LearnedLayout its = layout(machine_id);
  encode_learned(its, {stroke_[0].table(), stroke_[1].table(), slot_.table()},
                 {image_.data(), its.bytes()});
  return {image_.data(), its.bytes()};
}

Status StrokeService::accept(std::size_t size, std::uint32_t machine_id) {
  if (!on_) return bad("command");
  const Span<const std::uint8_t> image{image_.data(), size};
  const LearnedLayout mine = layout(machine_id);
  const double most = stroke_[0].rules().most_offset;
  if (const Status s = check_learned(image, mine, most); !s.ok()) return s;
  const auto from = [image](std::size_t first) {
    return [image, first](std::size_t j) { return learned_value(image, first + j); };
  };
  stroke_[0].load(from(0));
  stroke_[1].load(from(mine.nodes));
  slot_.load(from(2 * std::size_t{mine.nodes}));
  objects_.table_feed = learned_feed(image);
  return {};
}

}  // namespace volcomp::node
