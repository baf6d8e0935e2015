#pragma once
// Stands between the commands of the grinder and its axes and learns the offsets of C: monitor,
// learning and offsets, linked into the controller or on a node of its bus.

#include <array>
#include <vector>

#include "host_sim/experiments/internal_helical/stroke_plan.hpp"
#include "host_sim/host/bus/watched_strokes.hpp"
#include "host_sim/host/tables/learned_tables.hpp"

namespace volcomp::internal_helical {

using host::LearnedTables;

// How the control learns: the right way and three wrong ones (docs/papers/internal-helical.md, "How
// to reproduce").
enum class LearningWay : std::uint8_t {
  right,
  c_alone,    // learns the lag of C, ignores that of Z
  one_table,  // for both directions
  coarse,     // nodes 1 mm apart
};
inline constexpr std::array<const char*, 4> kLearningWays{"right", "c-alone", "one-table",
                                                          "coarse"};

inline constexpr std::array<double, kMostLines> kWavelengths_mm{10.0, 5.0, 2.5, 1.25};

// `flank_per_x`: magnitude of dn per error of X at the pitch circle.
[[nodiscard]] host::WatchedStrokes watched_strokes(const host::GrindingFile& job,
                                                   double flank_per_x, LearningWay way);

// What the monitor has seen of one or more rounds; µm on the flank.
struct MonitorView {
  std::array<std::vector<double>, 2> stroke;  // mean by node, by direction
  std::vector<double> slot;                   // mean by slot against that of its direction
  std::vector<double> around;                 // amplitude of the orders 1, 2, … of C
  std::vector<double> along;   // amplitude by wavelength, kWavelengths_mm; rms of both directions
  Repeatability over_stroke;   // forward, rad
  Repeatability over_slots;    // rad
  bool knows_repeats = false;  // else the two hold the amplitude only
};

class GrinderControl {
 public:
  GrinderControl() = default;
  GrinderControl(const GrinderControl&) = delete;
  GrinderControl& operator=(const GrinderControl&) = delete;
  virtual ~GrinderControl() = default;

  // One SYNC: the axes are read, then they move on towards targets and offsets.
  virtual void cycle(const StrokeStep& step) = 0;
  // One step of all tables from what was watched since the last; in force from the next stroke on.
  // Like the two below while the machine stands outside the face; throws UserError.
  virtual void learn() = 0;

  // Since the last learn().
  [[nodiscard]] virtual MonitorView view() = 0;
  [[nodiscard]] virtual LearnedTables tables() = 0;
};

// Amplitudes of the orders of C in the mean of every slot.
[[nodiscard]] std::vector<double> orders_around(const std::vector<double>& slot_um);

}  // namespace volcomp::internal_helical
