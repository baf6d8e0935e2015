#include "host_sim/host/tables/formats/volumetric_files.hpp"

#include <memory>

#include "comp/core/units.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kMostKnots = 129;
constexpr std::array<char, 3> kLetters{'X', 'Y', 'Z'};
using Tables = PerAxisTables<kMostKnots>;

std::string axis_name(std::size_t axis) { return std::string(1, kLetters[axis]) + "1"; }

// −f of one axis on one component.
std::vector<double> offsets(const Tables& tables, std::size_t axis, std::size_t component,
                            std::size_t knots, double constant) {
  std::vector<double> t;
  for (std::size_t k = 0; k < knots; ++k)
    t.push_back(-constant - tables.f[axis][k](static_cast<Eigen::Index>(component)));
  return t;
}

}  // namespace

Status volumetric_files(const VolumetricModel& model, const std::array<KnotGrid, 3>& grid,
                        VolumetricFiles& out) {
  if (model.chain.axis_count() != 3) return refuse(Reason::axes_mismatch);
  for (std::size_t a = 0; a < 3; ++a) {
    Where where;
    where.axis = kLetters[a];
    where.count = static_cast<int>(grid[a].knots);
    if (grid[a].knots < 2) return refuse(Reason::too_few_knots, where);
    if (grid[a].knots > kMostKnots) return refuse(Reason::too_many_knots, where);
  }
  const auto error_at = [&model](const Vec3& q) {
    Pose pose{};
    for (std::size_t a = 0; a < 3; ++a)
      pose[a] = q(static_cast<Eigen::Index>(a));
    return model.first_order(pose, kUnknownTravels, Beyond::stand_at_end);
  };
  const auto tables = std::make_unique<Tables>();
  per_axis_grid_mean(error_at, grid, *tables);

  VolumetricFiles files;
  int number = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const KnotGrid& g = grid[axis];
    for (std::size_t component = 0; component < 3; ++component) {
      const bool own = axis == component;
      const double constant = own ? tables->constant(static_cast<Eigen::Index>(axis)) : 0.0;
      const std::vector<double> t = offsets(*tables, axis, component, g.knots, constant);
      if (own) {
        files.own[axis] = {axis_name(axis), t, g.q0, g.pitch, false, false};
        continue;
      }
      files.cross[static_cast<std::size_t>(number)] = {
          number, axis_name(axis), axis_name(component), t, g.q0, g.pitch, 0, false, false, 1};
      ++number;
    }
  }
  files.remainder_max_um = tables->residual_max * kUmPerMm;
  files.remainder_rms_um = tables->residual_rms * kUmPerMm;
  out = files;
  return {};
}

}  // namespace volcomp::host
