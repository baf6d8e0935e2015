#pragma once
// The six error functions of every axis from targets that each carries in turn, in the order in
// which the axes hang on one another (seed 000 section 2.2).

#include <vector>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Body values on the moving side, mm and rad.
struct IdentifiedAxis {
  char letter = '\0';
  std::vector<double> nodes;
  std::vector<ErrorMotion> motion;
  std::vector<ErrorMotion> truth;

  [[nodiscard]] double largest_difference() const;
};

struct Identification {
  std::vector<IdentifiedAxis> axis;  // by NC axis
  ErrorMotion spread;      // standard uncertainty of the six of a node, per kTracker_mm of a target
  double condition = 0.0;  // of the targets

  // Identified − true, mm or rad.
  [[nodiscard]] double max_error() const;
};

// What a laser tracker leaves of a target, 1 σ: only for `spread`, the readings are perfect.
inline constexpr double kTracker_mm = 0.3e-3;

// At the equally spaced targets of the machine file. Throws UserError where an axis comes before
// one that carries it.
[[nodiscard]] Identification identify_axes(const TrueMachine& truth, const host::MachineFile& file);

enum class TableKind : std::uint8_t {
  none,        // all zero: the machine as drawn
  identified,  // the 24 functions
  means,       // of each function: all that the procedure of seed 000 aims at
};
inline constexpr std::array<const char*, 3> kTableKinds{"none", "identified", "means"};

// What was identified as a model of the machine.
class IdentifiedModel {
 public:
  IdentifiedModel(const Identification& found, TableKind kind, const MachineChain& chain);
  IdentifiedModel(const IdentifiedModel&) = delete;  // it holds its tables
  IdentifiedModel& operator=(const IdentifiedModel&) = delete;
  ~IdentifiedModel() = default;

  [[nodiscard]] const VolumetricModel& volumetric() const { return model_; }
  // Of the tool against the work where the machine stands at q, work frame, rad.
  [[nodiscard]] Vec3 orientation_error(const Pose& q) const;

 private:
  std::array<ErrorTable, kMaxAxes> tables_;
  VolumetricModel model_;
};

// `machine`: the chain they are for.
[[nodiscard]] MachineTables tables_of(const Identification& found, const host::MachineFile& file,
                                      const MachineDescription& machine, TableKind kind,
                                      std::size_t knots);

}  // namespace volcomp::sim
