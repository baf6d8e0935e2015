#pragma once
// All errors of a machine at once, by the house's estimator: a tracing interferometer reads at four
// stations that stand on the work how far reflectors on the tool are, all over the travels. Where
// the stations are against the datum of the work was measured before: so the work frame is that of
// the part, and what is constant is found, too.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/host/measure/identify/problem.hpp"
#include "host_sim/host/report/error_functions.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/tracer_stations.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Standard deviation of how much warmer each linear axis is at each station.
inline constexpr double kTracedGrowth_K = 0.1;

struct TracedPlan {
  host::identify::ErrorModel model;
  std::vector<Vec3> reflectors;   // besides the one in the tool point: from there, tool frame, mm
  std::size_t places = 0;         // of a station
  double repeatability_mm = 0.0;  // of the machine at a place, added to the reading in squares
  double station_mm = 0.25e-3;    // standard uncertainty of each coordinate of a station
};

// How its readings scatter.
struct TracerScatter {
  bool perfect = false;  // nothing scatters, drifts or grows, and stations stand where they should
  double reading_mm = kTracer_mm;
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;  // one of several with that seed
};

// What errs in it, for reports.
[[nodiscard]] std::string scatter_text(const TracedPlan& plan, const TracerScatter& scatter);

// A location of an axis on its fixed side or a constant on its moving side, mm or rad.
struct TracedValue {
  std::string name;  // EY0A, EX1A
  bool angular = false;
  double found = 0.0;
  double u = 0.0;
};

struct TracedErrors {
  std::shared_ptr<const host::BuiltTables> built;
  std::vector<host::ErrorCurves> functions;  // as in the tables, with twice their uncertainty
  std::vector<TracedValue> values;
  std::size_t readings = 0;
  std::size_t unknowns = 0;
  double chi2_over_dof = 0.0;
  // At places all over the travels: found − true error of the tool point, its standard uncertainty
  // (root of the trace), root mean square, and found − true turn of the tool against that at the
  // references, which no instrument but the reflectors knows.
  double largest_mm = 0.0;
  double rms_mm = 0.0;
  double u_rms_mm = 0.0;
  double largest_rad = 0.0;
};

// Throws UserError where the readings do not determine the errors.
[[nodiscard]] TracedErrors trace_errors(const TrueMachine& truth, const host::MachineFile& file,
                                        const TracedPlan& traced, const TracerScatter& scatter,
                                        std::size_t knots = kDefaultKnots);

// Without readings: why the plan does not determine its model, then what it does not see, by name;
// empty where it does. Dearer than an estimate.
[[nodiscard]] std::vector<std::string> refusal_of(const host::MachineFile& file,
                                                  const TracedPlan& traced);

}  // namespace volcomp::sim
