#pragma once
// Builds tables from a machine file and measured runs.

#include <memory>
#include <optional>
#include <vector>

#include "comp/metrology/tables/quantise.hpp"
#include "comp/metrology/tables/table_builder.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "comp/tick/compensator.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host {

// Which model of the paper the tables are for (docs/papers/xyfz.md, "How to reproduce"). All but
// the last are there for the comparison of the paper only.
enum class ModelKind : std::uint8_t {
  naive,        // no Abbe offsets, measured values as they are, squareness as rotations
  abbe,         // reading heads and sensed points, squareness as measured
  abbe_closed,  // the same with the squareness closure: the product's model
};

struct BuildOptions {
  ModelKind model = ModelKind::abbe_closed;
  SlopeFit slope = SlopeFit::least_squares;
  bool allow_resampling = true;
  std::size_t refine = 0;             // 0: that of the machine file
  std::size_t knots = kDefaultKnots;  // per table: what the node has room for; refines less
  bool bound = true;                  // compute model_bound_nm: dearer than all the rest together
  // One of many campaigns drawn about one that was accepted. What depends on the machine alone is
  // not looked at again, and the ends of a turn may be apart: their noise is no lost count.
  bool drawn = false;
};

// For callers that need only the tables of a model.
[[nodiscard]] inline BuildOptions tables_only(ModelKind model, std::size_t knots = kDefaultKnots) {
  BuildOptions options;
  options.model = model;
  options.knots = knots;
  options.bound = false;
  return options;
}

// How far the measured ends of a full turn were apart, largest of both directions, before the turn
// was closed.
struct TurnGap {
  double mm = 0.0;
  double rad = 0.0;
};

// Owns everything its parts refer to: the model points at the tables beside it.
struct BuiltTables {
  MachineChain chain;                                // of the chosen model
  std::vector<std::unique_ptr<BuiltTable>> built;    // by NC axis, as measured and averaged
  std::vector<std::unique_ptr<ErrorTable>> refined;  // internal convention, what is quantised
  std::vector<std::optional<TurnGap>> gaps;          // by NC axis, of full turns
  VolumetricModel model;
  XyfzSquareness apparent;  // what the tables show where it was measured, in the same way
  // By circles less along lines, where the file states both: what one would take for the other.
  std::optional<XyfzSquareness> circles_less_lines;
  XyfzSquareness parameters;  // what goes into the model
  MachineTables tables;
  double model_bound_nm = 0.0;        // first-order run-time model against the exact chain, 0 if
                                      // not computed
  std::vector<std::string> warnings;  // in words
};

// One run file per axis of the machine. Throws UserError naming file and place.
[[nodiscard]] std::unique_ptr<BuiltTables> build_tables(const MachineFile& machine,
                                                        const std::vector<RunsFile>& runs,
                                                        const BuildOptions& options);

// From errors that are known at the targets of the machine file, one table an axis: internal
// convention, both directions, place of rotary axes and slopes of straightness in them. Squareness
// of the machine file does not count. Throws UserError.
[[nodiscard]] std::unique_ptr<BuiltTables> tables_of_errors(const MachineFile& machine,
                                                            const std::vector<ErrorTable>& errors,
                                                            std::size_t knots = kDefaultKnots);

// A knot at each target of an axis; the errors at them are still to be written.
[[nodiscard]] ErrorTable table_at_targets(const AxisFile& axis);

// Tables of errors that are the same everywhere, by NC axis, internal convention, mm and rad.
[[nodiscard]] std::unique_ptr<BuiltTables> constant_tables(const MachineFile& machine,
                                                           const ErrorSet& errors,
                                                           std::size_t knots = kDefaultKnots);

[[nodiscard]] std::vector<std::uint8_t> make_image(const MachineTables& tables);

}  // namespace volcomp::host
