#pragma once
// Coordinates X, Y and Z of a machine of any axes, in whatever order its file has them and in
// whatever sense they run.

#include "comp/metrology/tables/diagonals.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// The linear axes with the letters X, Y and Z. All other axes stand at 0, or at the end of their
// travel next to it.
class XyzAxes {
 public:
  explicit XyzAxes(const MachineFile& machine);

  [[nodiscard]] bool has(std::size_t k) const { return axis_.at(k) != kMaxAxes; }
  [[nodiscard]] std::size_t count() const;
  // 0 to 0 of an axis that the machine lacks.
  [[nodiscard]] const DiagonalBox& travel() const { return travel_; }

  // Pose of all axes, mm and rad. Coordinates of a missing axis are ignored.
  [[nodiscard]] Pose pose(const Vec3& at_mm) const;
  // Way of the tool relative to the work for a way of the coordinates, mm: an axis that carries the
  // work and counts along its own motion moves the tool the other way.
  [[nodiscard]] Vec3 in_base(const Vec3& way_mm) const { return to_base_ * way_mm; }
  [[nodiscard]] Vec3 in_work(const Vec3& way_mm) const { return to_work_ * way_mm; }

  // Body diagonals (ISO 230-6) of X, Y and Z, or the two diagonals of the plane of two; `faces`:
  // the six of the faces, too. Throws UserError where there is one axis or none.
  [[nodiscard]] std::vector<Diagonal> diagonals(bool faces) const;

 private:
  std::string path_;
  std::array<std::size_t, 3> axis_{kMaxAxes, kMaxAxes, kMaxAxes};
  DiagonalBox travel_{Vec3::Zero(), Vec3::Zero()};
  Pose rest_{};
  Mat3 to_base_ = Mat3::Zero();
  Mat3 to_work_ = Mat3::Zero();
};

}  // namespace volcomp::host
