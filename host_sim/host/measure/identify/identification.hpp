#pragma once
// From a measured plan to the errors of the machine with their uncertainty: centres refined, every
// set-up checked against the others.

#include <memory>
#include <string>
#include <vector>

#include "host_sim/host/measure/identify/consistency.hpp"
#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "host_sim/host/measure/identify/rank.hpp"
#include "host_sim/host/measure/identify/weakest.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace volcomp::host::identify {

// Where an axis with functions was measured.
struct Visited {
  std::size_t axis = 0;
  double lo = 0.0;
  double hi = 0.0;
};

// What the estimate leaves of a reading, over its stated standard uncertainty.
struct Residual {
  ReadingPlace of;
  double over_sigma = 0.0;
};

// What was found of a stylus that is not the reference, against the plan.
struct FoundStylus {
  std::size_t stylus = 0;
  Vec3 correction = Vec3::Zero();  // of its offset, mm
  double known = 0.0;              // σ of a coordinate, mm; infinite: free

  // Farther off than what is known of it allows: another length, another tip, a wrong offset.
  [[nodiscard]] bool doubtful() const { return correction.cwiseAbs().maxCoeff() > 3.0 * known; }
};

struct Identified {
  std::vector<FoundFunction> functions;
  std::vector<FoundValue> values;  // reversals, locations, constants
  std::optional<FoundSquareness> squareness;
  std::vector<FoundStylus> styli;
  FoundVolume volume;
  std::vector<VolumeSection> sections;
  std::vector<WeakValue> weakest;
  std::vector<Residual> residuals;
  Consistency consistency;
  std::vector<ReadingPlace> outliers;
  std::vector<Visited> visited;
  PlanRank rank;  // by the readings alone, without gauge and what is known of styli
  Index unknowns = 0;
  Index rows = 0;
  int refinements = 0;              // of centres
  double largest_refinement = 0.0;  // mm, of all rounds together
  bool robust = false;
  std::unique_ptr<BuiltTables> tables;
};

struct IdentifySettings {
  bool robust = false;
  bool leave_out = true;  // each set-up against the others
};

// Throws UserError with the reason and its place; `plan` must have readings.
[[nodiscard]] Identified identify(const MeasurementPlan& plan, const IdentifySettings& settings,
                                  const Progress& progress);

// Errors of an estimate at the targets of the machine file, as tables.
[[nodiscard]] std::unique_ptr<BuiltTables> tables_of_estimate(const MachineFile& machine,
                                                              const Unknowns& unknowns,
                                                              const VectorXd& x,
                                                              std::size_t knots = kDefaultKnots);

}  // namespace volcomp::host::identify
