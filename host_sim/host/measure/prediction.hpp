#pragma once
// Predicts from the tables in a node what a diagonal shows once they compensate it.

#include <filesystem>
#include <string>
#include <vector>

#include "comp/metrology/tables/diagonals.hpp"
#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/host/tables/table_model.hpp"

namespace volcomp::host {

struct PredictedDiagonal {
  std::vector<double> after_um;    // measured before, less the model
  double max_difference_um = 0.0;  // of what was measured after from it
  double rms_difference_um = 0.0;
};

// The model of a table image in double.
class TablesModel {
 public:
  // `box`: corners between which the diagonals were measured, mm. Throws UserError naming the
  // image: refused, or of another machine or chain than the file describes.
  TablesModel(const MachineFile& machine, const std::filesystem::path& image, DiagonalBox box);
  TablesModel(TablesModel&&) = default;
  TablesModel& operator=(TablesModel&&) = default;
  TablesModel(const TablesModel&) = delete;
  TablesModel& operator=(const TablesModel&) = delete;
  ~TablesModel() = default;

  // Deviation of the machine without compensation by the model of the tables, µm, relative to the
  // first distance. Throws UserError when the diagonal does not have the length of the box.
  [[nodiscard]] std::vector<double> deviations_um(const std::string& diagonal,
                                                  const std::vector<double>& distance_mm) const;

  // What is left of `before_um` after it, held against `after_um`.
  [[nodiscard]] PredictedDiagonal prediction(const std::string& diagonal,
                                             const std::vector<double>& distance_mm,
                                             const std::vector<double>& before_um,
                                             const std::vector<double>& after_um) const;

 private:
  DiagonalBox box_;
  XyzAxes axes_;
  TableModel tables_;
};

}  // namespace volcomp::host
