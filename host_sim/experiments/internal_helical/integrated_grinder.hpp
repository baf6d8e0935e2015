#pragma once
// The integrated form: monitor, learning and offsets of comp beside the controller, called once per
// SYNC. Targets and offsets are counted in the units of the drives, as on a bus.

#include <memory>

#include "comp/strokes/helix_instances.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "host_sim/experiments/internal_helical/grinder_control.hpp"
#include "host_sim/experiments/internal_helical/grinder_plant.hpp"
#include "host_sim/sim/controller/machine_watch.hpp"

namespace volcomp::internal_helical {

class IntegratedGrinder final : public GrinderControl {
 public:
  // `plant` and `watch`, if any, must outlive it.
  IntegratedGrinder(const host::WatchedStrokes& watched, LearningWay way, GrinderPlant& plant,
                    sim::MachineWatch* watch = nullptr);

  void cycle(const StrokeStep& step) override;
  void learn() override;
  [[nodiscard]] MonitorView view() override;
  [[nodiscard]] LearnedTables tables() override;

 private:
  [[nodiscard]] HelixFrame frame(const StrokeStep& step);
  void collect();
  void show(const StrokeStep& step, std::int64_t offset_of_c);
  [[nodiscard]] std::vector<NodeSums> stroke_sums(Direction direction) const;
  [[nodiscard]] std::vector<NodeSums> slot_sums() const;
  [[nodiscard]] std::vector<double> means_on_flank(const std::vector<NodeSums>& sums) const;
  template <std::size_t N>
  void step(OffsetLearner<N>& learner, const std::vector<NodeSums>& sums);

  host::WatchedStrokes watched_;
  LearningWay way_;
  GrinderPlant& plant_;
  std::unique_ptr<sim::MachineObserver> observer_;  // null: nothing looks on
  sim::MachineSnapshot shown_;
  std::uint16_t sequence_ = 0;
  std::int32_t feed_nm_per_s_ = 0;
  std::unique_ptr<GrinderMonitor> monitor_ = std::make_unique<GrinderMonitor>();
  std::unique_ptr<GrinderOffsets> offsets_ = std::make_unique<GrinderOffsets>();
  std::array<OffsetLearner<kStrokeNodes>, 2> stroke_{};
  OffsetLearner<kGearSlots> slot_{};
};

}  // namespace volcomp::internal_helical
