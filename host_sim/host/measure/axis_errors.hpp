#pragma once
// Identifies the six error functions of every axis from targets that each carries in turn, in the
// order in which the axes hang on one another (docs/papers/l300g.md, "What we do"), and makes
// tables of them.

#include <functional>
#include <vector>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "comp/tables/machine_tables.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Body values on the moving side, mm and rad, at equally spaced positions.
struct IdentifiedAxis {
  char letter = '\0';
  std::vector<double> nodes;
  std::vector<ErrorMotion> motion;
};

struct Identification {
  std::vector<IdentifiedAxis> axis;  // by NC axis
  ErrorMotion spread;      // standard uncertainty of the six of a node, per kTracker_mm of a target
  double condition = 0.0;  // of the targets
};

// Standard uncertainty that a laser tracker leaves of a target: only for `spread`.
inline constexpr double kTracker_mm = 0.3e-3;

// The targets that the moving body of an axis carries, in its frame, mm.
[[nodiscard]] Span<const Vec3> carried_targets();
// Where the machine stands while other axes are measured: each axis at the target position next to
// its reference, where its error has been identified and not interpolated.
[[nodiscard]] Pose reference_pose(const MachineFile& file);
// The branch of an axis, and how many bodies of it come before that of the axis.
struct AxisPlace {
  const BodyPath* path = nullptr;  // in the chain
  std::size_t before = 0;
};
[[nodiscard]] AxisPlace place_in_branch(const MachineChain& chain, std::size_t axis);
// Where the targets are that `axis` carries while the machine stands at `pose`: in base, mm, in the
// order of carried_targets().
using MeasureTargets = std::function<std::vector<Vec3>(std::size_t axis, const Pose& pose)>;

// At the target positions of the machine file. Throws UserError where an axis comes before one that
// carries it.
[[nodiscard]] Identification identify_axes(const MachineFile& file, const MeasureTargets& measure);

enum class TableKind : std::uint8_t {
  none,        // all zero: the machine as drawn
  identified,  // the identified functions
  means,       // the mean of each function, which the procedure of the paper finds
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
  // Turn of the tool against the work where the machine stands at q, work frame, rad.
  [[nodiscard]] Vec3 orientation_error(const Pose& q) const;

 private:
  std::array<ErrorTable, kMaxAxes> tables_;
  VolumetricModel model_;
};

// `machine`: the chain they are for.
[[nodiscard]] MachineTables tables_of(const Identification& found, const MachineFile& file,
                                      const MachineDescription& machine, TableKind kind,
                                      std::size_t knots);

}  // namespace volcomp::host
