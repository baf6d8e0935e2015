#include "host_sim/host/measure/axis_errors.hpp"

#include <algorithm>
#include <stdexcept>

#include "comp/metrology/fits/axis_identification.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// The targets span the working lever: nearer ones would amplify their noise on the way to the gear.
// They come in pairs, so that terms of second order in the angles cancel.
constexpr double kReach_mm = 150.0;
const std::array<Vec3, 6> kTargets{Vec3(kReach_mm, 0.0, 0.0), Vec3(-kReach_mm, 0.0, 0.0),
                                   Vec3(0.0, kReach_mm, 0.0), Vec3(0.0, -kReach_mm, 0.0),
                                   Vec3(0.0, 0.0, kReach_mm), Vec3(0.0, 0.0, -kReach_mm)};

class Identifier {
 public:
  Identifier(const MachineFile& file, const MeasureTargets& measure)
      : file_(file), measure_(measure), reference_(reference_pose(file)) {}

  IdentifiedAxis identify(std::size_t a) {
    IdentifiedAxis result;
    result.letter = file_.axes[a].letter;
    result.nodes = file_.axes[a].all_targets();
    const Pose at_zero{};
    require(check_order(file_.chain, a, identified_, reference_, at_zero),
            std::string("identification of axis ") + result.letter);
    const AxisPlace place = place_in_branch(file_.chain, a);
    const Frame parent =
        actual_frame(file_.chain, *place.path, place.before, reference_, at_reference_);
    std::vector<Vec3> measured = measure(a, result.nodes);
    fit(parent, a, measured, result);
    // The fit turns targets in a straight line. What that has missed is known now.
    take_away_second_order(parent, a, result, measured);
    fit(parent, a, measured, result);
    identified_ |= 1U << a;
    at_reference_[a] = result.motion[file_.axes[a].reference_target()];
    return result;
  }

 private:
  void fit(const Frame& parent, std::size_t a, const std::vector<Vec3>& measured,
           IdentifiedAxis& result) const {
    result.motion.resize(result.nodes.size());
    require(identify_axis(parent, file_.chain.axis(a),
                          {result.nodes, {kTargets.data(), kTargets.size()}, measured},
                          {result.motion.data(), result.motion.size()}),
            std::string("identification of axis ") + result.letter);
  }

  // 1 nm for P8, and again as much in every axis that hangs on this one.
  void take_away_second_order(const Frame& parent, std::size_t a, const IdentifiedAxis& found,
                              std::vector<Vec3>& measured) const {
    const Joint& joint = file_.chain.axis(a);
    for (std::size_t i = 0; i < found.nodes.size(); ++i) {
      const Vec3 angles = rotation(found.motion[i]);
      const Mat3 beyond =
          rotation_minus_identity(RotationModel::rxryrz, angles) - cross_matrix(angles);
      const Mat3 to_base = (parent * joint_offset(joint) * joint_motion(joint, found.nodes[i])).R;
      for (std::size_t k = 0; k < kTargets.size(); ++k)
        measured[i * kTargets.size() + k] -= to_base * (beyond * kTargets[k]);
    }
  }

  [[nodiscard]] std::vector<Vec3> measure(std::size_t a, const std::vector<double>& nodes) const {
    std::vector<Vec3> measured;
    for (const double q : nodes) {
      Pose pose = reference_;
      pose[a] = q;
      const std::vector<Vec3> targets = measure_(a, pose);
      measured.insert(measured.end(), targets.begin(), targets.end());
    }
    return measured;
  }

  const MachineFile& file_;
  const MeasureTargets& measure_;
  Pose reference_;
  std::uint32_t identified_ = 0;
  ErrorSet at_reference_ = zero_errors();
};

// What an uncertainty of the targets becomes, and how well they are spread: the same at every node.
void judge_targets(Identification& found) {
  std::array<Vec3, kTargets.size()> still;
  still.fill(Vec3::Zero());
  RigidFit fit;
  require(fit_rigid({kTargets.data(), kTargets.size()}, {still.data(), still.size()}, fit),
          "targets");
  found.spread = kTracker_mm * fit.cofactors.diagonal().cwiseSqrt();
  found.condition = fit.condition;
}

ErrorMotion mean_of(const std::vector<ErrorMotion>& motion) {
  ErrorMotion mean = ErrorMotion::Zero();
  for (const ErrorMotion& e : motion)
    mean += e / static_cast<double>(motion.size());
  return mean;
}

// The ends of a turn are one place, read twice.
void join_ends(const Joint& joint, ErrorTable& table) {
  if (!is_full_turn(table, joint)) return;
  ErrorMotion& first = table.forward[0];
  ErrorMotion& last = table.forward[table.knots - 1];
  first = last = ErrorMotion(0.5 * (first + last));
}

ErrorTable table_of(const IdentifiedAxis& axis, const Joint& joint, TableKind kind) {
  ErrorTable table;
  table.knots = axis.nodes.size();
  table.q0 = axis.nodes.front();
  table.pitch = (axis.nodes.back() - table.q0) / static_cast<double>(table.knots - 1);
  const ErrorMotion mean = mean_of(axis.motion);
  for (std::size_t i = 0; i < table.knots; ++i) {
    if (kind == TableKind::identified) table.forward[i] = axis.motion[i];
    if (kind == TableKind::means) table.forward[i] = mean;
    if (kind == TableKind::none) table.forward[i].setZero();
  }
  join_ends(joint, table);
  table.backward = table.forward;
  return table;
}

}  // namespace

AxisPlace place_in_branch(const MachineChain& chain, std::size_t axis) {
  const std::uint8_t body = chain.body_of_axis(axis);
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    const auto* const at = std::find(path->begin(), path->end(), body);
    if (at != path->end()) return {path, static_cast<std::size_t>(at - path->begin())};
  }
  throw std::logic_error("an axis on neither branch");
}

Span<const Vec3> carried_targets() { return {kTargets.data(), kTargets.size()}; }

Pose reference_pose(const MachineFile& file) {
  Pose pose{};
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    pose[a] = file.axes[a].target(file.axes[a].reference_target());
  return pose;
}

Identification identify_axes(const MachineFile& file, const MeasureTargets& measure) {
  Identification found;
  Identifier identifier(file, measure);
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    found.axis.push_back(identifier.identify(a));
  judge_targets(found);
  return found;
}

IdentifiedModel::IdentifiedModel(const Identification& found, TableKind kind,
                                 const MachineChain& chain) {
  model_.chain = chain;
  model_.tool_point = chain.tool_point();
  for (std::size_t a = 0; a < found.axis.size(); ++a) {
    tables_[a] = table_of(found.axis[a], chain.axis(a), kind);
    model_.table[a] = &tables_[a];
  }
}

Vec3 IdentifiedModel::orientation_error(const Pose& q) const {
  const PointPair points = ideal_points(model_.chain, q, model_.tool_point);
  return exact_error(model_.chain, q, model_.errors(q, kUnknownTravels), Vec3::Zero(),
                     RotationModel::rxryrz, points)
      .orientation_work;
}

MachineTables tables_of(const Identification& found, const MachineFile& file,
                        const MachineDescription& machine, TableKind kind, std::size_t knots) {
  MachineTables tables;
  tables.machine = machine;
  tables.provenance.machine_id = file.id;
  for (std::size_t a = 0; a < found.axis.size(); ++a)
    require(quantise(table_of(found.axis[a], file.chain.axis(a), kind), file.chain.axis(a), knots,
                     tables.axis[a]),
            file.path);
  return tables;
}

}  // namespace volcomp::host
