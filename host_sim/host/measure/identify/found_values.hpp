#pragma once
// Values of an estimate with their uncertainty: functions, single values, squareness, the error of
// a point over the volume.

#include <optional>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/identify/solution.hpp"

namespace volcomp::host::identify {

// With its standard uncertainty.
struct Measured {
  double value = 0.0;
  double u = 0.0;
};

// An error function at the targets of the machine file, body and moving side, mean of the two
// directions.
struct FoundFunction {
  Quantity quantity;
  std::vector<double> at;
  std::vector<Measured> value;

  [[nodiscard]] double largest_u() const;
};

struct FoundValue {
  Quantity quantity;
  Measured value;
};

// Of X, Y and Z, Y being the datum.
struct FoundSquareness {
  Measured a_xy;
  Measured a_xz;
  Measured a_yz;
};

// What the uncertainties leave of the error of the functional point over the travels, beside the
// best rigid motion, mm: root mean square, and, as the mean of draws, 95 % of the places and the
// worst.
struct FoundVolume {
  double rms = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

// The same over a plane of two linear axes, the others in the middle of their travel, rotary axes
// at their reference.
struct VolumeSection {
  std::size_t right = 0;  // axis of the columns
  std::size_t up = 0;     // axis of the rows
  std::vector<double> column;
  std::vector<double> row;
  std::vector<std::vector<double>> u;  // by row, mm
};

// Rows of unknowns as values: of an estimate, or 0 for a plan.
class Values {
 public:
  // All outlive it; `x` may be null.
  Values(const Equations& equations, const Triangle& triangle, const VectorXd* x)
      : unknowns_(equations.unknowns()), triangle_(triangle), x_(x) {}

  [[nodiscard]] Measured of(const VectorXd& row) const;
  [[nodiscard]] std::vector<FoundFunction> functions(const MachineFile& machine) const;
  [[nodiscard]] std::vector<FoundValue> singles() const;
  // None where straightness of X, Y or Z is no unknown.
  [[nodiscard]] std::optional<FoundSquareness> squareness(const MachineFile& machine) const;

 private:
  const Unknowns& unknowns_;
  const Triangle& triangle_;
  const VectorXd* x_;
};

// Linear axes in the middle of their travel, rotary ones at their reference.
[[nodiscard]] Pose middle_of(const Problem& problem);
// Places spread evenly over the whole travel (J. H. Halton, Numer. Math. 2, 1960).
[[nodiscard]] std::vector<Pose> places_of(const Machine& machine, std::size_t count);
[[nodiscard]] FoundVolume volume_of(const Equations& equations, const Triangle& triangle);
// One for each pair of linear axes.
[[nodiscard]] std::vector<VolumeSection> volume_sections(const Equations& equations,
                                                         const Triangle& triangle);

}  // namespace volcomp::host::identify
