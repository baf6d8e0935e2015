#include "host_sim/host/tables/build_tables.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "comp/metrology/circles/circle_squareness.hpp"
#include "comp/metrology/tables/squareness.hpp"
#include "comp/tables/image.hpp"
#include "comp/tick/instances.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/machine_facts.hpp"
#include "host_sim/host/tables/build_warnings.hpp"

namespace volcomp::host {
namespace {

constexpr int kBoundSteps = 7;

// A larger gap between the ends of a turn is no drift but a lost count, a wrong file or a loose
// table.
constexpr TurnGap kMostDrift{5e-3, 50e-6};

const RunsFile& runs_of(const std::vector<RunsFile>& runs, const MachineFile& machine,
                        char letter) {
  const RunsFile* found = nullptr;
  for (const RunsFile& file : runs) {
    if (file.letter != letter) continue;
    if (found != nullptr)
      throw UserError(fmt::format("{} and {}: both hold axis {}", found->name, file.name, letter));
    found = &file;
  }
  if (found == nullptr)
    throw UserError(fmt::format("{}: no runs given for axis {}", machine.path, letter));
  return *found;
}

// The target nearest to where the table is to be zero.
int reference_target(const RunsFile& runs, const AxisFile& axis) {
  const double closest =
      *std::min_element(runs.positions.begin(), runs.positions.end(), [&](double a, double b) {
        return std::abs(a - axis.reference) < std::abs(b - axis.reference);
      });
  if (std::abs(closest - axis.reference) > 1e-3) {
    throw UserError(fmt::format("{}: no target at the reference {} of axis {} [{}]", runs.name,
                                axis.reference, axis.letter, code(Reason::reference_out_of_range)));
  }
  return static_cast<int>(std::find(runs.positions.begin(), runs.positions.end(), closest) -
                          runs.positions.begin());
}

// What the builder has taken away at the reference, where the machine file knows it.
void add_at_reference(const ErrorMotion& at_reference, ErrorTable& table) {
  for (std::size_t i = 0; i < table.knots; ++i) {
    table.forward[i] += at_reference;
    table.backward[i] += at_reference;
  }
}

TurnGap gap_between(const ErrorMotion& forward, const ErrorMotion& backward) {
  const auto most = [&](auto part) {
    return std::max(part(forward).cwiseAbs().maxCoeff(), part(backward).cwiseAbs().maxCoeff());
  };
  return {most([](const ErrorMotion& e) { return translation(e); }),
          most([](const ErrorMotion& e) { return rotation(e); })};
}

// The last target of a full turn is the first again, and what was measured there differs by what
// has drifted meanwhile. That is no error of the axis: it is taken out as if it had grown evenly,
// of each direction by itself. The reference keeps its value.
std::optional<TurnGap> close_turn(const RunsFile& runs, const AxisFile& axis, const Joint& joint,
                                  const BuildOptions& options, ErrorTable& table) {
  if (!is_full_turn(table, joint)) return std::nullopt;
  const std::size_t last = table.knots - 1;
  const ErrorMotion forward = table.forward[last] - table.forward[0];
  const ErrorMotion backward = table.backward[last] - table.backward[0];
  const TurnGap gap = gap_between(forward, backward);
  if (!options.drawn && (gap.mm > kMostDrift.mm || gap.rad > kMostDrift.rad)) {
    throw UserError(fmt::format(
        "{}: the ends of the turn of {} differ by {:.2f} um and {:.2f} urad, more than "
        "drift explains [{}]",
        runs.name, axis.letter, 1e3 * gap.mm, 1e6 * gap.rad, code(Reason::not_periodic)));
  }
  for (std::size_t i = 0; i <= last; ++i) {
    const double turns = (table.knot(i) - axis.reference) / (table.last() - table.q0);
    table.forward[i] -= turns * forward;
    table.backward[i] -= turns * backward;
  }
  return gap;
}

// How often each segment is divided: as the machine file asks, as far as the table has room.
std::size_t refinement(const MachineFile& machine, const BuildOptions& options, std::size_t knots) {
  const std::size_t most = (options.knots - 1) / (knots - 1);
  const std::size_t wanted = options.refine == 0 ? machine.refine : options.refine;
  return std::max<std::size_t>(1, std::min(wanted, most));
}

void build_axis(const MachineFile& machine, const RunsFile& runs, std::size_t a,
                const BuildOptions& options, BuiltTables& out) {
  const AxisFile& axis = machine.axes[a];
  const Joint& joint = machine.chain.axis(a);
  check_targets(runs, axis, out.warnings);
  const RunViews views(runs);
  const bool naive = options.model == ModelKind::naive;
  MeasuredAxis measured;
  measured.letter = axis.letter;
  measured.axis = joint.axis;
  measured.kind = joint.kind;
  measured.positions = runs.positions;
  measured.up = views.up;
  measured.down = views.down;
  measured.convention = machine.convention;
  measured.sensed_at_zero = naive ? Vec3(Vec3::Zero()) : axis.sensed.at_zero;
  measured.kappa = naive ? 0 : axis.sensed.kappa;
  measured.reference = reference_target(runs, axis);
  measured.slope = options.slope;
  measured.allow_resampling = options.allow_resampling;
  require_runs(build_table(measured, *out.built[a]), runs);
  note_warnings(runs, axis, *out.built[a], out.warnings);
  if (!machine.squareness) note_slopes(runs, axis, *out.built[a], out.warnings);

  const std::size_t factor = refinement(machine, options, out.built[a]->table.knots);
  require(refine(out.built[a]->table, machine.interpolation, factor, *out.refined[a]), runs.name);
  if (axis.full_turn() && !is_full_turn(*out.refined[a], joint)) {
    out.warnings.push_back(
        fmt::format("{}: {} turns once round, but its targets do not: where none is, the value of "
                    "the nearest end is used",
                    runs.name, axis.letter));
  }
  out.gaps.push_back(close_turn(runs, axis, joint, options, *out.refined[a]));
  add_at_reference(axis.at_reference, *out.refined[a]);
  convert_to_internal(joint, machine.convention, machine.side, *out.refined[a]);
}

// Positions of the letters X, Y, Z among the NC axes: squareness is defined between those three.
std::array<std::size_t, 3> linear_axes(const MachineFile& machine) {
  return {machine.axis_index('X'), machine.axis_index('Y'), machine.axis_index('Z')};
}

void close_loop(const MachineFile& machine, BuiltTables& out) {
  const SquarenessFile& s = *machine.squareness;
  const std::array<std::size_t, 3> axis = linear_axes(machine);
  const auto error_at = [&](const Vec3& p) {
    Pose q{};
    for (std::size_t k = 0; k < 3; ++k)
      q[axis[k]] = p(static_cast<Eigen::Index>(k));
    return out.model.first_order(q, kUnknownTravels, Beyond::lever_as_given);
  };
  XyfzSquareness on_lines;
  if (s.has_lines()) {
    const std::vector<double> x = s.line(0);
    const std::vector<double> y = s.line(1);
    const std::vector<double> z = s.line(2);
    on_lines = apparent_squareness(error_at, {s.at, x, y, z});
  }
  out.apparent = on_lines;
  if (!s.circle_radius) return;
  require(squareness_on_circles(error_at, {s.at, *s.circle_radius}, out.apparent), machine.path);
  if (s.has_lines()) out.circles_less_lines = close_squareness(out.apparent, on_lines);
}

bool has_three_slides(const MachineFile& machine) {
  const std::string_view letters = "XYZ";
  return std::all_of(letters.begin(), letters.end(), [&](char letter) {
    return std::any_of(machine.axes.begin(), machine.axes.end(), [letter](const AxisFile& axis) {
      return axis.letter == letter && !axis.rotary;
    });
  });
}

void apply_squareness(const MachineFile& machine, const BuildOptions& options, BuiltTables& out) {
  if (!machine.squareness || options.model == ModelKind::naive) return;
  close_loop(machine, out);
  const XyfzSquareness& measured = machine.squareness->measured;
  out.parameters =
      options.model == ModelKind::abbe_closed ? close_squareness(measured, out.apparent) : measured;
  const std::array<std::size_t, 3> axis = linear_axes(machine);
  const DirectionErrors xyz = xyfz_directions(out.parameters);
  for (std::size_t k = 0; k < 3; ++k)
    out.model.directions[axis[k]] = xyz[k];
}

bool same_axes(const MachineChain& a, const MachineChain& b) {
  if (a.axis_count() != b.axis_count()) return false;
  for (std::size_t k = 0; k < a.axis_count(); ++k) {
    const Joint& x = a.axis(k);
    const Joint& y = b.axis(k);
    if (x.letter != y.letter || x.kind != y.kind || x.axis != y.axis || x.sign != y.sign ||
        x.branch != y.branch)
      return false;
  }
  return true;
}

// The naive model knows no offsets: every frame at the machine zero point, squareness as turned
// bodies. Defined by the paper for the XYFZ machine only.
MachineChain naive_chain(const MachineFile& machine) {
  const XyfzSquareness s = machine.squareness ? machine.squareness->measured : XyfzSquareness{};
  MachineChain chain;
  require(MachineChain::build(xyfz_naive(s, {0.0, 0.0, 0.0}), chain), machine.path);
  if (!same_axes(chain, machine.chain)) {
    throw UserError(fmt::format(
        "{}: the naive model is that of a machine with X and Y under the work and Z with the tool",
        machine.path));
  }
  return chain;
}

double model_bound_nm(const VolumetricModel& model) {
  const int steps =
      model.chain.axis_count() <= 3 ? kBoundSteps : 3;  // the grid grows with every axis
  return kNmPerMm * first_order_distance(model, steps);
}

// Folds as a node does: what a node would refuse is refused here, where it can be corrected.
void require_usable(const BuiltTables& c, const std::string& path) {
  const RuntimeChain chain = make_runtime_chain(c.tables.machine);
  if (chain.axes > OrientingCompensator::kAxes) return;  // only for a controller of its own
  for (std::size_t a = 0; a < chain.axes; ++a) {
    if (c.tables.axis[a].knots > kDefaultKnots) return;
  }
  const auto compensator = std::make_unique<OrientingCompensator>(OrientingMachine{chain});
  require(compensator->stage(c.tables, c.chain.tool_point(), 0), path);
}

// What the tables of a machine hold besides its errors.
void describe_machine(const MachineFile& machine, BuiltTables& out) {
  out.tables.machine = out.chain.description();
  out.tables.directions = out.model.directions;
  out.tables.provenance.machine_id = machine.id;
  out.tables.provenance.temperature_C = static_cast<float>(machine.thermal.reference_C);
  out.tables.expansion = out.model.expansion = machine.thermal.expansion;
  require_usable(out, machine.path);
}

}  // namespace

std::unique_ptr<BuiltTables> tables_of_errors(const MachineFile& machine,
                                              const std::vector<ErrorTable>& errors,
                                              std::size_t knots) {
  require_authority(machine);
  BuildOptions options;
  options.knots = knots;
  auto out = std::make_unique<BuiltTables>();
  out->chain = out->model.chain = machine.chain;
  out->model.tool_point = out->chain.tool_point();
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::string place = fmt::format("{}: axis {}", machine.path, machine.axes[a].letter);
    out->refined.push_back(std::make_unique<ErrorTable>());
    require(refine(errors[a], machine.interpolation, refinement(machine, options, errors[a].knots),
                   *out->refined[a]),
            place);
    out->model.table[a] = out->refined[a].get();
    require(quantise(*out->refined[a], out->chain.axis(a), options.knots, out->tables.axis[a]),
            place);
  }
  describe_machine(machine, *out);
  return out;
}

ErrorTable table_at_targets(const AxisFile& axis) {
  ErrorTable table;
  table.q0 = axis.lo;
  table.knots = axis.targets;
  table.pitch = (axis.hi - axis.lo) / static_cast<double>(axis.targets - 1);
  return table;
}

std::unique_ptr<BuiltTables> constant_tables(const MachineFile& machine, const ErrorSet& errors,
                                             std::size_t knots) {
  std::vector<ErrorTable> tables;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    ErrorTable table = table_at_targets(machine.axes[a]);
    for (std::size_t i = 0; i < table.knots; ++i)
      table.forward.at(i) = table.backward.at(i) = errors.at(a);
    tables.push_back(table);
  }
  return tables_of_errors(machine, tables, knots);
}

std::unique_ptr<BuiltTables> build_tables(const MachineFile& machine,
                                          const std::vector<RunsFile>& runs,
                                          const BuildOptions& options) {
  if (!options.drawn) require_authority(machine);
  auto out = std::make_unique<BuiltTables>();
  out->chain = options.model == ModelKind::naive ? naive_chain(machine) : machine.chain;
  out->model.chain = out->chain;
  out->model.tool_point = out->chain.tool_point();
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    out->built.push_back(std::make_unique<BuiltTable>());
    out->refined.push_back(std::make_unique<ErrorTable>());
    build_axis(machine, runs_of(runs, machine, machine.axes[a].letter), a, options, *out);
    out->model.table[a] = out->refined[a].get();
    require(quantise(*out->refined[a], out->chain.axis(a), options.knots, out->tables.axis[a]),
            machine.path);
  }
  if (!machine.squareness && has_three_slides(machine)) {
    out->warnings.push_back(
        fmt::format("{}: there is no [squareness]: X, Y and Z are taken as square to each other",
                    machine.path));
  }
  apply_squareness(machine, options, *out);
  describe_machine(machine, *out);
  if (options.bound) out->model_bound_nm = model_bound_nm(out->model);
  return out;
}

std::vector<std::uint8_t> make_image(const MachineTables& tables) {
  std::vector<std::uint8_t> image(image_size(tables));
  std::size_t written = 0;
  require(encode_image(tables, image, written), "table image");
  image.resize(written);
  return image;
}

}  // namespace volcomp::host
