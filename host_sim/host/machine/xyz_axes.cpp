#include "host_sim/host/machine/xyz_axes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/machine/inverse.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

XyzAxes::XyzAxes(const MachineFile& machine) : path_(machine.path) {
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const AxisFile& axis = machine.axes[a];
    rest_[a] = std::clamp(0.0, axis.lo, axis.hi);
    if (axis.rotary || axis.letter < 'X' || axis.letter > 'Z') continue;
    const auto k = static_cast<std::size_t>(axis.letter - 'X');
    axis_.at(k) = a;
    travel_.lo(static_cast<Eigen::Index>(k)) = axis.lo;
    travel_.hi(static_cast<Eigen::Index>(k)) = axis.hi;
  }
  const MachineChain& chain = machine.chain;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!has(k)) continue;
    to_base_.col(static_cast<Eigen::Index>(k)) =
        jacobian_column(chain, rest_, chain.tool_point(), axis_.at(k));
  }
  to_work_ = chain.ideal(chain.work(), rest_).R.transpose() * to_base_;
}

std::size_t XyzAxes::count() const {
  return static_cast<std::size_t>(
      std::count_if(axis_.begin(), axis_.end(), [](std::size_t axis) { return axis != kMaxAxes; }));
}

Pose XyzAxes::pose(const Vec3& at_mm) const {
  Pose q = rest_;
  for (std::size_t k = 0; k < 3; ++k) {
    if (has(k)) q.at(axis_.at(k)) = at_mm(static_cast<Eigen::Index>(k));
  }
  return q;
}

std::vector<Diagonal> XyzAxes::diagonals(bool faces) const {
  if (count() < 2) {
    throw UserError(fmt::format(
        "{}: a diagonal needs at least two of the linear axes X, Y and Z, this machine has {}",
        path_, count()));
  }
  std::vector<Diagonal> all;
  if (count() == 3) {
    for (const Diagonal& d : body_diagonals(travel_))
      all.push_back(d);
    if (!faces) return all;
  }
  for (const Diagonal& d : face_diagonals(travel_)) {
    const auto moves = [&](char letter) { return has(static_cast<std::size_t>(letter - 'X')); };
    if (moves(d.name[0]) && moves(d.name[1])) all.push_back(d);
  }
  return all;
}

}  // namespace volcomp::host
