#pragma once
// The tables of a machine with three linear axes as files of controllers. Units and sign of every
// format are printed, and the part of the model that it cannot hold is measured, not estimated.
//
//   siemens   $AA_ENC_COMP (axis on itself) and $AN_CEC (axis on the other two), nine files
//   linuxcnc  screw compensation, one file per axis, both directions
//   isg       ISG kernel and TwinCAT CNC, kw.ssfk, one file per axis, both directions

#include <array>
#include <string>
#include <vector>

#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/host/tables/table_model.hpp"

namespace volcomp::host {

struct ExportOptions {
  std::vector<std::string> formats;                       // of the three above
  std::size_t entries = 129;                              // most per table; 2 … 129
  std::vector<std::string> axis_names{"X1", "Y1", "Z1"};  // machine axes of the Siemens control
  std::vector<int> axis_numbers{1, 2, 3};                 // kopf.log_achs_nr
  int first_table = 0;                                    // t of the first $AN_CEC
  int cec_sign = 1;                                       // −1 where the dial gauge shows so
  int comp_type = 1;                                      // COMP_FILE_TYPE
};

struct ExportedFormat {
  std::string name;
  std::string units;                     // and resolution
  std::string sign;                      // what a positive entry means
  std::string not_held;                  // in words
  std::string to_do;                     // on the controller
  double half_step_um = 0.0;             // rounding of an entry
  Vec3 remainder_max_um = Vec3::Zero();  // X, Y, Z over all knots, mean of both directions
  double remainder_rms_um = 0.0;         // over all components
  bool both_directions = false;
  std::vector<NamedText> files;
};

struct ControllerExport {
  std::array<std::size_t, 3> entries{};  // per axis
  Vec3 reversal_um = Vec3::Zero();       // largest difference of the directions, axis on itself
  std::vector<ExportedFormat> formats;
};

// Throws UserError with `name` unless the axes are X, Y, Z, linear and along +X, +Y, +Z of the
// machine frame (tool with respect to work).
[[nodiscard]] ControllerExport export_tables(const TableModel& tables, const std::string& name,
                                             const ExportOptions& options);

}  // namespace volcomp::host
