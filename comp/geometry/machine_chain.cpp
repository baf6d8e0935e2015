#include "comp/geometry/machine_chain.hpp"

#include <cmath>

#include <Eigen/LU>

namespace volcomp {
namespace {

Status check_joint(const Body& body, int number) {
  Where where;
  where.body = number;
  where.axis = body.joint.letter;
  const Joint& joint = body.joint;
  if (static_cast<int>(joint.axis) > 2 || (joint.sign != 1 && joint.sign != -1)) {
    return refuse(Reason::bad_joint, where);
  }
  const Frame offset = joint_offset(joint);
  if (!offset.t.allFinite() || !offset.R.allFinite()) return refuse(Reason::not_finite, where);
  const Mat3 defect = offset.R.transpose() * offset.R - Mat3::Identity();
  if (defect.cwiseAbs().maxCoeff() > 1e-9 || offset.R.determinant() < 0.0) {
    return refuse(Reason::not_a_rotation, where);
  }
  for (const double value : body.constant_error) {
    if (!std::isfinite(value)) return refuse(Reason::not_finite, where);
  }
  return {};
}

}  // namespace

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
  const std::size_t n = description.body_count;
  if (n > kMaxBodies) {
    Where where;
    where.count = static_cast<int>(n);
    return refuse(Reason::too_many_bodies, where);
  }
  std::array<std::uint8_t, kMaxBodies> lower{};
  for (std::size_t k = 0; k < n; ++k)
    lower[k] = description.body[k].lower;
  if (const Status s = check_lower_body({lower.data(), n}); !s.ok()) return s;
  if (description.work_body == 0 || description.work_body > n || description.tool_body == 0 ||
      description.tool_body > n) {
    return refuse(Reason::bad_body);
  }

  MachineChain chain;
  chain.description_ = description;
  std::array<bool, kMaxAxes> seen{};
  for (std::size_t k = 0; k < n; ++k) {
    const Body& body = description.body[k];
    if (const Status s = check_joint(body, static_cast<int>(k) + 1); !s.ok()) return s;
    if (!body.joint.moves()) {
      chain.description_.body[k].joint.nc_axis = 0;  // unused, but a valid index into a pose
      continue;
    }
    Where where;
    where.body = static_cast<int>(k) + 1;
    where.axis = body.joint.letter;
    if (chain.axis_count_ == kMaxAxes) return refuse(Reason::too_many_axes, where);
    if (body.joint.nc_axis >= kMaxAxes || seen[body.joint.nc_axis])
      return refuse(Reason::bad_axis_index, where);
    seen[body.joint.nc_axis] = true;
    chain.body_of_axis_[body.joint.nc_axis] = static_cast<std::uint8_t>(k);
    ++chain.axis_count_;
  }
  for (std::size_t a = 0; a < chain.axis_count_; ++a) {
    if (!seen[a]) return refuse(Reason::bad_axis_index);
  }
  for (std::size_t c = 0; c < description.correcting_count; ++c) {
    Where where;
    where.field = "correcting";
    where.index = static_cast<int>(c);
    if (description.correcting_count > kMaxCorrecting ||
        description.correcting[c] >= chain.axis_count_) {
      return refuse(Reason::bad_axis_index, where);
    }
    for (std::size_t before = 0; before < c; ++before) {
      if (description.correcting[before] == description.correcting[c])
        return refuse(Reason::bad_axis_index, where);
    }
  }

  chain.paths_ = branch_paths(description);
  for (const std::uint8_t body : chain.work())
    chain.description_.body[body].joint.branch = Branch::work;
  for (const std::uint8_t body : chain.tool())
    chain.description_.body[body].joint.branch = Branch::tool;
  out = chain;
  return {};
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
