#include "host_sim/host/measure/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/tables/runtime_chain.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kLengthTolerance_mm = 0.5;

// The two ends of a diagonal in the box: P runs an axis up, N down; an axis without sign stays in
// the middle.
Diagonal diagonal_of(const DiagonalBox& box, const std::string& name) {
  std::array<int, 3> sign{};
  if (name.find_first_not_of("PN") == std::string::npos) {
    for (std::size_t k = 0; k < 3; ++k)
      sign.at(k) = name[k] == 'P' ? 1 : -1;
  } else {
    sign.at(static_cast<std::size_t>(name[0] - 'X')) = 1;
    sign.at(static_cast<std::size_t>(name[1] - 'X')) = name[2] == '+' ? 1 : -1;
  }
  Diagonal d;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double middle = 0.5 * (box.lo(i) + box.hi(i));
    d.start(i) = sign.at(k) == 0 ? middle : sign.at(k) > 0 ? box.lo(i) : box.hi(i);
    d.end(i) = sign.at(k) == 0 ? middle : sign.at(k) > 0 ? box.hi(i) : box.lo(i);
  }
  return d;
}

}  // namespace

TablesModel::TablesModel(const MachineFile& machine, const std::filesystem::path& image,
                         DiagonalBox box)
    : box_(std::move(box)), axes_(machine) {
  const std::unique_ptr<MachineTables> tables = read_tables_file(image);
  require_same_machine(*tables, shown_name(image), machine);
  tables_ = table_model(*tables, shown_name(image));
}

std::vector<double> TablesModel::deviations_um(const std::string& diagonal,
                                               const std::vector<double>& distance_mm) const {
  const Diagonal d = diagonal_of(box_, diagonal);
  const Vec3 direction = axes_.in_base(d.end - d.start).normalized();
  if (distance_mm.back() > d.length() + kLengthTolerance_mm || distance_mm.front() < 0.0)
    throw UserError(fmt::format(
        "diagonal {} is {:.3f} mm long between the corners of the box, measured were {:g} to {:g} "
        "mm; --box-mm says where it lies",
        diagonal, d.length(), distance_mm.front(), distance_mm.back()));
  const VolumetricModel& model = tables_.model;
  const bool rotary = model.chain.has_rotary();
  const auto error_along = [&](double distance) {
    const Pose q = axes_.pose(d.at(distance / d.length()));
    const Vec3 error = rotary ? model.second_order(q, kUnknownTravels, Beyond::stand_at_end)
                              : model.first_order(q, kUnknownTravels, Beyond::stand_at_end);
    return kUmPerMm * direction.dot(error);
  };
  std::vector<double> deviations;
  deviations.reserve(distance_mm.size());
  const double first = error_along(distance_mm.front());
  for (const double distance : distance_mm)
    deviations.push_back(error_along(distance) - first);
  return deviations;
}

PredictedDiagonal TablesModel::prediction(const std::string& diagonal,
                                          const std::vector<double>& distance_mm,
                                          const std::vector<double>& before_um,
                                          const std::vector<double>& after_um) const {
  const std::vector<double> model = deviations_um(diagonal, distance_mm);
  PredictedDiagonal p;
  double squares = 0.0;
  for (std::size_t t = 0; t < model.size(); ++t) {
    p.after_um.push_back(before_um[t] - model[t]);
    const double difference = after_um[t] - p.after_um[t];
    p.max_difference_um = std::max(p.max_difference_um, std::abs(difference));
    squares += difference * difference;
  }
  p.rms_difference_um = std::sqrt(squares / static_cast<double>(model.size()));
  return p;
}

}  // namespace volcomp::host
