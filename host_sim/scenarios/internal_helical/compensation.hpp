#pragma once
// The compensation beside the controller: monitor, learning and offsets of comp in one piece. It
// gets a ProcessState per SYNC and gives an offset of C; nothing else passes between the two, so a
// bus can come between them.

#include <memory>
#include <vector>

#include "comp/realtime/helix_instances.hpp"
#include "comp/tables/learning_choice.hpp"
#include "comp/tables/learning_guard.hpp"
#include "host_sim/scenarios/internal_helical/process.hpp"

namespace volcomp::sim {

// How it learns: the right way and the three wrong ones of seed 003 section 9.
enum class LearningWay : std::uint8_t {
  right,
  c_alone,    // looks at the lag of C and away from that of Z
  one_table,  // for both directions
  coarse,     // nodes 1 mm apart
};
inline constexpr std::array<const char*, 4> kLearningWays{"right", "c-alone", "one-table",
                                                          "coarse"};

// As the monitor has seen one or more rounds; µm on the flank.
struct MonitorView {
  std::array<std::vector<double>, 2> stroke;  // mean by node, by direction
  std::vector<double> slot;                   // mean by slot against that of its direction
  std::vector<double> around;                 // amplitude of the orders 1, 2, … of C
  std::vector<double> along;                  // amplitude by wavelength, kWavelengths_mm
  Repeatability over_stroke;                  // forward, rad
  Repeatability over_slots;                   // rad
};
inline constexpr std::array<double, kMostLines> kWavelengths_mm{10.0, 5.0, 2.5, 1.25};

// What has been learned, rad added to the command of C.
struct LearnedTables {
  double z0_mm = 0.0;
  double pitch_mm = 0.0;
  std::array<std::vector<double>, 2> stroke;  // T1 by direction
  std::vector<double> slot;                   // T2
};

class HelixCompensation {
 public:
  // `flank_per_x`: magnitude of dn per error of X at the pitch circle.
  HelixCompensation(const InternalGear& gear, double flank_per_x, LearningWay way);

  // Interrupt: 2^-32 turn.
  std::int32_t tick(const ProcessState& state);
  // Background: after every pass, and with enough of them.
  void collect();
  void learn();

  // Since the last learn().
  [[nodiscard]] MonitorView view() const;
  [[nodiscard]] LearnedTables tables() const;

 private:
  [[nodiscard]] std::vector<NodeSums> stroke_sums(Direction direction) const;
  [[nodiscard]] std::vector<NodeSums> slot_sums() const;
  template <std::size_t N>
  void step(OffsetLearner<N>& learner, const std::vector<NodeSums>& sums);

  InternalGear gear_;
  LearningWay way_;
  double pitch_mm_;
  std::size_t nodes_;
  std::unique_ptr<GrinderMonitor> monitor_ = std::make_unique<GrinderMonitor>();
  std::unique_ptr<GrinderOffsets> offsets_ = std::make_unique<GrinderOffsets>();
  std::array<OffsetLearner<kStrokeNodes>, 2> stroke_{};
  OffsetLearner<kGearSlots> slot_{};
};

}  // namespace volcomp::sim
