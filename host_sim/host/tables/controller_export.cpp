#include "host_sim/host/tables/controller_export.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/formats/isg_ssfk.hpp"
#include "host_sim/host/tables/formats/linuxcnc_comp.hpp"
#include "host_sim/host/tables/formats/volumetric_files.hpp"

namespace volcomp::host {
namespace {

constexpr std::array<char, 3> kLetters{'X', 'Y', 'Z'};

using Grid = std::array<KnotGrid, 3>;

// An axis on itself, t by direction.
struct OwnTable {
  std::vector<double> nominal;
  std::vector<double> forward;
  std::vector<double> reverse;
};

Eigen::Index component(std::size_t axis) { return static_cast<Eigen::Index>(axis); }

std::string lower(char letter) {
  return fmt::format("{}", static_cast<char>(letter + ('a' - 'A')));
}

void check_axes(const VolumetricModel& model, const std::string& name) {
  std::string letters;
  for (std::size_t a = 0; a < model.chain.axis_count(); ++a)
    letters += model.chain.axis(a).letter;
  if (letters != "XYZ" || model.chain.has_rotary())
    throw UserError(fmt::format(
        "{}: the axes are {}; only machines with the linear axes X, Y, Z can be exported", name,
        letters));
  constexpr double kAlong = 1e-9;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3 column = jacobian_column(model.chain, Pose{}, model.tool_point, a);
    if ((column - Vec3::Unit(component(a))).norm() > kAlong)
      throw UserError(
          fmt::format("{}: axis {} does not move the tool along +{} with respect to the work", name,
                      letters[a], letters[a]));
  }
}

Grid grid_of(const TableModel& tables, std::size_t most) {
  Grid grid;
  for (std::size_t a = 0; a < grid.size(); ++a) {
    const ErrorTable& table = *tables.tables[a];
    const std::size_t knots = std::min(table.knots, most);
    grid[a] = {table.q0, (table.last() - table.q0) / static_cast<double>(knots - 1), knots};
  }
  return grid;
}

// Half the difference of the directions of an axis on itself. It is linear in the positions of the
// other axes, so its mean over them is its value in their middle.
double half_reversal(const VolumetricModel& model, const Grid& grid, std::size_t axis,
                     std::size_t knot) {
  Pose q{};
  for (std::size_t a = 0; a < grid.size(); ++a)
    q[a] = 0.5 * (grid[a].at(0) + grid[a].at(grid[a].knots - 1));
  q[axis] = grid[axis].at(knot);
  Travels travels{};
  travels[axis] = Travel::forward;
  const Vec3 forward = model.first_order(q, travels, Beyond::stand_at_end);
  travels[axis] = Travel::backward;
  const Vec3 backward = model.first_order(q, travels, Beyond::stand_at_end);
  return 0.5 * (forward - backward)(component(axis));
}

std::array<OwnTable, 3> own_tables(const VolumetricModel& model, const Grid& grid,
                                   const VolumetricFiles& files) {
  std::array<OwnTable, 3> own;
  for (std::size_t a = 0; a < own.size(); ++a) {
    for (std::size_t k = 0; k < grid[a].knots; ++k) {
      const double half = half_reversal(model, grid, a, k);
      own[a].nominal.push_back(grid[a].at(k));
      own[a].forward.push_back(files.own[a].offset[k] - half);
      own[a].reverse.push_back(files.own[a].offset[k] + half);
    }
  }
  return own;
}

// What is left when every axis is corrected by its own table alone.
void measure_own_only(const VolumetricModel& model, const Grid& grid, const VolumetricFiles& files,
                      ExportedFormat& out) {
  Vec3 worst = Vec3::Zero();
  double squares = 0.0;
  std::size_t count = 0;
  detail::for_each_knot(grid, [&](const std::array<std::size_t, 3>& at, const Vec3& q) {
    Vec3 left = model.first_order({q(0), q(1), q(2)}, kUnknownTravels, Beyond::stand_at_end);
    for (std::size_t a = 0; a < at.size(); ++a)
      left(component(a)) += files.own[a].offset[at[a]];
    worst = worst.cwiseMax(left.cwiseAbs());
    squares += left.squaredNorm();
    count += 3;
  });
  out.remainder_max_um = worst * kUmPerMm;
  out.remainder_rms_um = std::sqrt(squares / static_cast<double>(count)) * kUmPerMm;
}

ExportedFormat siemens(const VolumetricFiles& files, const ExportOptions& options) {
  ExportedFormat out;
  out.name = "siemens";
  out.units = "positions and entries mm, six decimals";
  out.sign = fmt::format(
      "$AA_ENC_COMP is added to the actual value, so an entry is minus the offset; $AN_CEC is "
      "added to the setpoint, so an entry is {} the offset",
      options.cec_sign > 0 ? "plus" : "minus");
  out.not_held =
      "products of two axes (an angle of one times the position of another), the difference of "
      "the directions";
  out.to_do =
      "MD38000 and MD18342 for the numbers of entries, MD32700 and MD32710 and SD41300 to enable; "
      "check both signs with one entry of 0.010 mm and a dial gauge";
  out.half_step_um = 0.5e-3;
  out.remainder_max_um = files.remainder_max_um;
  out.remainder_rms_um = files.remainder_rms_um;
  for (std::size_t a = 0; a < files.own.size(); ++a) {
    EncCompTable table = files.own[a];
    table.axis = options.axis_names[a];
    NamedText file{"siemens_enc_comp_" + lower(kLetters[a]) + ".ini", ""};
    require(write_enc_comp(table, file.text), file.name);
    out.files.push_back(file);
  }
  for (const CecTable& cross : files.cross) {
    const char from = cross.input.front();
    const char to = cross.output.front();
    CecTable table = cross;
    table.number += options.first_table;
    table.input = options.axis_names[static_cast<std::size_t>(from - 'X')];
    table.output = options.axis_names[static_cast<std::size_t>(to - 'X')];
    table.sign = options.cec_sign;
    NamedText file{"siemens_cec_" + lower(from) + "_to_" + lower(to) + ".ini", ""};
    require(write_cec(table, file.text), file.name);
    out.files.push_back(file);
  }
  return out;
}

constexpr const char* kOwnOnly =
    "everything an axis does to the other two: straightness, squareness, angles with levers";

ExportedFormat linuxcnc(const std::array<OwnTable, 3>& own, const ExportOptions& options) {
  ExportedFormat out;
  out.name = "linuxcnc";
  out.units = "mm, six decimals: [TRAJ] LINEAR_UNITS must be mm";
  out.sign = options.comp_type == 1
                 ? "columns 2 and 3 are trims: plus the offset, added to the motor command"
                 : "columns 2 and 3 are positions: nominal minus the offset";
  out.not_held = kOwnOnly;
  out.to_do = fmt::format(
      "per joint: COMP_FILE = the file, COMP_FILE_TYPE = {}; BACKLASH has no effect with it",
      options.comp_type);
  out.half_step_um = 0.5e-3;
  out.both_directions = true;
  for (std::size_t a = 0; a < own.size(); ++a) {
    NamedText file{"linuxcnc_" + lower(kLetters[a]) + ".comp", ""};
    require(write_linuxcnc({options.comp_type, own[a].nominal, own[a].forward, own[a].reverse},
                           file.text),
            file.name);
    out.files.push_back(file);
  }
  return out;
}

ExportedFormat isg(const std::array<OwnTable, 3>& own, const ExportOptions& options) {
  ExportedFormat out;
  out.name = "isg";
  out.units = "whole numbers of 0.1 µm (kw.ssfk.unit 1)";
  out.sign = "an entry is actual minus setpoint: minus the offset";
  out.not_held = kOwnOnly;
  out.to_do = "lr_param.ssfk (P-AXIS-00175) to enable; compare kopf.log_achs_nr with the machine";
  out.half_step_um = 0.05;
  out.both_directions = true;
  for (std::size_t a = 0; a < own.size(); ++a) {
    NamedText file{"isg_ssfk_" + lower(kLetters[a]) + ".lis", ""};
    require(write_ssfk({options.axis_numbers[a], std::string(1, kLetters[a]), own[a].nominal,
                        own[a].forward, own[a].reverse, false},
                       file.text),
            file.name);
    out.files.push_back(file);
  }
  return out;
}

Vec3 largest_reversal_um(const std::array<OwnTable, 3>& own) {
  Vec3 most = Vec3::Zero();
  for (std::size_t a = 0; a < own.size(); ++a) {
    for (std::size_t k = 0; k < own[a].nominal.size(); ++k)
      most(component(a)) =
          std::max(most(component(a)), std::abs(own[a].forward[k] - own[a].reverse[k]) * kUmPerMm);
  }
  return most;
}

}  // namespace

ControllerExport export_tables(const TableModel& tables, const std::string& name,
                               const ExportOptions& options) {
  check_axes(tables.model, name);
  const Grid grid = grid_of(tables, options.entries);
  VolumetricFiles files;
  require(volumetric_files(tables.model, grid, files), name);
  const std::array<OwnTable, 3> own = own_tables(tables.model, grid, files);

  ControllerExport out;
  for (std::size_t a = 0; a < grid.size(); ++a)
    out.entries[a] = grid[a].knots;
  out.reversal_um = largest_reversal_um(own);
  ExportedFormat own_only;
  measure_own_only(tables.model, grid, files, own_only);
  for (const std::string& format : options.formats) {
    if (format == "siemens") {
      out.formats.push_back(siemens(files, options));
      continue;
    }
    out.formats.push_back(format == "linuxcnc" ? linuxcnc(own, options) : isg(own, options));
    out.formats.back().remainder_max_um = own_only.remainder_max_um;
    out.formats.back().remainder_rms_um = own_only.remainder_rms_um;
  }
  return out;
}

}  // namespace volcomp::host
