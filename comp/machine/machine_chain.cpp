#include "comp/machine/machine_chain.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "comp/machine/machine_limits.hpp"

namespace volcomp {
namespace {

Status check_joint(const Body& body, const Where& where) {
  const Joint& joint = body.joint;
  if (static_cast<int>(joint.axis) > 2 || (joint.sign != 1 && joint.sign != -1)) {
    return refuse(Reason::bad_joint, where);
  }
  // Entries of a rotation are cosines; a finite entry that is none is refused as not_a_rotation.
  constexpr double kAnyNumber = std::numeric_limits<double>::max();
  Reason reason = check_numbers(joint.offset.data(), joint.offset.size(), kMaxOffset_mm);
  if (reason == Reason::ok)
    reason = check_numbers(joint.orientation.data(), joint.orientation.size(), kAnyNumber);
  if (reason == Reason::ok && !is_rotation(joint_offset(joint).R)) reason = Reason::not_a_rotation;
  if (reason == Reason::ok)
    reason = check_numbers(body.constant_error.data(), body.constant_error.size(), kAnyNumber);
  return reason == Reason::ok ? Status{} : refuse(reason, where);
}

// The work and tool body exist and the lower-body array is one tree.
Status check_bodies(const MachineDescription& d) {
  const std::size_t n = d.body_count;
  if (n > kMaxBodies) {
    Where where;
    where.count = static_cast<int>(n);
    return refuse(Reason::too_many_bodies, where);
  }
  std::array<std::uint8_t, kMaxBodies> lower{};
  for (std::size_t k = 0; k < n; ++k)
    lower[k] = d.body[k].lower;
  if (const Status s = check_lower_body({lower.data(), n}); !s.ok()) return s;
  if (d.work_body == 0 || d.work_body > n || d.tool_body == 0 || d.tool_body > n)
    return refuse(Reason::bad_body);
  return {};
}

// Every joint is one, and the NC axes are 0, 1, 2… without gap or repetition.
Status check_joints(const MachineDescription& d, std::size_t& axes) {
  axes = 0;
  std::array<bool, kMaxAxes> seen{};
  for (std::size_t k = 0; k < d.body_count; ++k) {
    const Joint& joint = d.body[k].joint;
    Where where;
    where.body = static_cast<int>(k) + 1;
    where.axis = joint.letter;
    if (const Status s = check_joint(d.body[k], where); !s.ok()) return s;
    if (!joint.moves()) continue;
    if (axes == kMaxAxes) return refuse(Reason::too_many_axes, where);
    if (joint.nc_axis >= kMaxAxes || seen[joint.nc_axis])
      return refuse(Reason::bad_axis_index, where);
    seen[joint.nc_axis] = true;
    ++axes;
  }
  for (std::size_t a = 0; a < axes; ++a) {
    if (!seen[a]) return refuse(Reason::bad_axis_index);
  }
  return {};
}

// The correcting axes exist, and none is named twice. Those that orient the tool exist; what else
// they have to be is known to Compensator::stage().
Status check_correcting(const MachineDescription& d, std::size_t axes) {
  for (std::size_t o = 0; o < d.orienting_count; ++o) {
    if (d.orienting_count > kMaxOrienting || d.orienting[o] >= axes)
      return refuse(Reason::cannot_orient);
  }
  for (std::size_t c = 0; c < d.correcting_count; ++c) {
    Where where;
    where.field = "correcting";
    where.index = static_cast<int>(c);
    if (d.correcting_count > kMaxCorrecting || d.correcting[c] >= axes)
      return refuse(Reason::bad_axis_index, where);
    for (std::size_t before = 0; before < c; ++before) {
      if (d.correcting[before] == d.correcting[c]) return refuse(Reason::bad_axis_index, where);
    }
  }
  return {};
}

Status check_description(const MachineDescription& d) {
  std::size_t axes = 0;
  if (const Status s = check_bodies(d); !s.ok()) return s;
  if (const Status s = check_joints(d, axes); !s.ok()) return s;
  const Reason tool = check_numbers(d.tool_point.data(), d.tool_point.size(), kMaxOffset_mm);
  if (tool != Reason::ok) {
    Where where;
    where.field = "tool_point";
    return refuse(tool, where);
  }
  return check_correcting(d, axes);
}

}  // namespace

Reason check_numbers(const double* number, std::size_t count, double most) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!(std::abs(number[i]) <= most))
      return std::isfinite(number[i]) ? Reason::bound_exceeded : Reason::not_finite;
  }
  return Reason::ok;
}

ErrorSet zero_errors() {
  ErrorSet errors;
  errors.fill(ErrorMotion::Zero());
  return errors;
}

DirectionErrors zero_directions() {
  DirectionErrors directions;
  directions.fill(Vec3::Zero());
  return directions;
}

Status check_lower_body(Span<const std::uint8_t> lower) {
  int roots = 0;
  for (std::size_t k = 0; k < lower.size(); ++k) {
    if (lower[k] > k) {
      Where where;
      where.body = static_cast<int>(k) + 1;
      return refuse(Reason::parent_not_lower, where);
    }
    if (lower[k] == 0) ++roots;
  }
  return roots == 1 ? Status{} : refuse(Reason::not_one_root);
}

Status MachineChain::build(const MachineDescription& description, MachineChain& out) {
  if (const Status s = check_description(description); !s.ok()) return s;
  out.description_ = description;
  out.analyse();
  return {};
}

Status MachineChain::complete() {
  if (const Status s = check_description(description_); !s.ok()) return s;
  analyse();
  return {};
}

// Expects a checked description.
void MachineChain::analyse() {
  axis_count_ = 0;
  for (std::size_t k = 0; k < description_.body_count; ++k) {
    Joint& joint = description_.body[k].joint;
    if (!joint.moves()) {
      joint.nc_axis = 0;  // unused, but a valid index into a pose
      continue;
    }
    body_of_axis_[joint.nc_axis] = static_cast<std::uint8_t>(k);
    ++axis_count_;
  }
  paths_ = branch_paths(description_);
  for (const std::uint8_t body : work())
    description_.body[body].joint.branch = Branch::work;
  for (const std::uint8_t body : tool())
    description_.body[body].joint.branch = Branch::tool;
}

bool MachineChain::has_rotary() const {
  for (std::size_t a = 0; a < axis_count_; ++a) {
    if (axis(a).kind == JointKind::rotary) return true;
  }
  return false;
}

ErrorMotion MachineChain::error_of(std::uint8_t body, const ErrorSet& errors) const {
  const Body& b = description_.body[body];
  if (b.joint.moves()) return errors[b.joint.nc_axis];
  return Eigen::Map<const ErrorMotion>(b.constant_error.data());
}

Frame MachineChain::ideal(const BodyPath& path, const Pose& q) const {
  Frame frame;
  for (const std::uint8_t body : path) {
    frame = frame * joint_offset(joint(body)) * joint_motion(joint(body), q[joint(body).nc_axis]);
  }
  return frame;
}

}  // namespace volcomp
