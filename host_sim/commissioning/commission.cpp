#include "host_sim/commissioning/commission.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/realtime/compensator.hpp"
#include "comp/tables/image.hpp"
#include "comp/tables/squareness.hpp"
#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

constexpr int kBoundSteps = 7;

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
    throw UserError(
        fmt::format("{}: no target at the reference {} of axis {} [reference_out_of_range]",
                    runs.name, axis.reference, axis.letter));
  }
  return static_cast<int>(std::find(runs.positions.begin(), runs.positions.end(), closest) -
                          runs.positions.begin());
}

void note_warnings(const RunsFile& runs, const BuiltTable& built, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < built.warning_count; ++i) {
    std::string text = fmt::format("{}: {}", runs.name, code(built.warning[i]));
    if (built.warning[i] == Warning::outlier) {
      const Outlier& o = built.outlier[0];
      text += fmt::format(" ({} found, first: {} run {} target {} channel {}, kept in the mean)",
                          built.outlier_count, o.direction, o.run + 1, o.target + 1, o.channel);
    }
    out.push_back(text);
  }
}

void build_axis(const MachineFile& machine, const RunsFile& runs, std::size_t a,
                const CommissionOptions& options, Commissioned& out) {
  const AxisFile& axis = machine.axes[a];
  const Joint& joint = machine.chain.axis(a);
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
  require(build_table(measured, *out.built[a]), runs.name);
  note_warnings(runs, *out.built[a], out.warnings);

  const std::size_t most = (options.knots - 1) / (out.built[a]->table.knots - 1);
  const std::size_t wanted = options.refine == 0 ? machine.refine : options.refine;
  const std::size_t factor = std::max<std::size_t>(1, std::min(wanted, most));
  require(refine(out.built[a]->table, machine.interpolation, factor, *out.refined[a]), runs.name);
  convert_to_internal(joint, machine.convention, machine.side, *out.refined[a]);
}

// Positions of the letters X, Y, Z among the NC axes: squareness is defined between those three.
std::array<std::size_t, 3> linear_axes(const MachineFile& machine) {
  return {machine.axis_index('X'), machine.axis_index('Y'), machine.axis_index('Z')};
}

void close_loop(const MachineFile& machine, Commissioned& out) {
  const SquarenessFile& s = *machine.squareness;
  const std::array<std::size_t, 3> axis = linear_axes(machine);
  const auto error_at = [&](const Vec3& p) {
    Pose q{};
    for (std::size_t k = 0; k < 3; ++k)
      q[axis[k]] = p(static_cast<Eigen::Index>(k));
    return out.model.first_order(q, kUnknownTravels, Beyond::lever_as_given);
  };
  const std::vector<double> x = s.line(0);
  const std::vector<double> y = s.line(1);
  const std::vector<double> z = s.line(2);
  out.apparent = apparent_squareness(error_at, {s.at, x, y, z});
}

void apply_squareness(const MachineFile& machine, const CommissionOptions& options,
                      Commissioned& out) {
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

// The naive model knows no offsets: every frame at the machine zero point, squareness as turned
// bodies. Defined by the paper for the XYFZ machine only.
MachineChain naive_chain(const MachineFile& machine) {
  const XyfzSquareness s = machine.squareness ? machine.squareness->measured : XyfzSquareness{};
  MachineChain chain;
  require(MachineChain::build(xyfz_naive(s, {0.0, 0.0, 0.0}), chain), machine.path);
  return chain;
}

double model_bound_nm(const VolumetricModel& model) {
  const int steps =
      model.chain.axis_count() <= 3 ? kBoundSteps : 3;  // the grid grows with every axis
  return kNmPerMm * first_order_distance(model, steps);
}

}  // namespace

std::unique_ptr<Commissioned> commission(const MachineFile& machine,
                                         const std::vector<RunsFile>& runs,
                                         const CommissionOptions& options) {
  auto out = std::make_unique<Commissioned>();
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
  apply_squareness(machine, options, *out);
  out->tables.machine = out->chain.description();
  out->tables.directions = out->model.directions;
  out->tables.provenance.machine_id = machine.id;
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

}  // namespace volcomp::sim
