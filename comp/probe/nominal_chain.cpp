#include "comp/probe/nominal_chain.hpp"

#include "comp/core/units.hpp"
#include "comp/machine/double3.hpp"
#include "comp/machine/fine_trig.hpp"

namespace volcomp {
namespace {

// A coordinate axis and the two that follow it.
class Triad {
 public:
  explicit Triad(Axis axis)
      : i(kNext[index(axis)]), j(kNext[index(axis) + 1U]), k(kNext[index(axis) + 2U]) {}
  int i;
  int j;
  int k;

  // Rotation about the axis: v ← J v.
  void turn(double* v, const FineSineCosine& t) const {
    const double vj = v[j];
    const double vk = v[k];
    v[j] = t.cosine * vj - t.sine * vk;
    v[k] = t.sine * vj + t.cosine * vk;
  }
  // R ← R J
  void turn_columns(Mat3& R, const FineSineCosine& t) const {
    for (int r = 0; r < 3; ++r) {
      const double a = R(r, j);
      const double b = R(r, k);
      R(r, j) = t.cosine * a + t.sine * b;
      R(r, k) = t.cosine * b - t.sine * a;
    }
  }

 private:
  static constexpr std::array<int, 5> kNext{0, 1, 2, 0, 1};
};

}  // namespace

void NominalChain::build(const MachineDescription& machine) {
  const BranchPaths paths = branch_paths(machine);
  steps_ = axes_ = 0;
  append(machine, paths.tool);
  tool_steps_ = steps_;
  append(machine, paths.work);
  for (std::size_t k = 0; k < machine.body_count; ++k) {
    const Joint& joint = machine.body[k].joint;
    if (!joint.moves()) continue;
    rotary_[joint.nc_axis] = joint.kind == JointKind::rotary;
    ++axes_;
  }
}

void NominalChain::append(const MachineDescription& machine, const BodyPath& bodies) {
  for (const std::uint8_t body : bodies) {
    const Joint& joint = machine.body[body].joint;
    Step& step = step_[steps_++];
    step.kind = joint.kind;
    step.axis = joint.axis;
    step.nc_axis = joint.nc_axis;
    step.sign = joint.sign;
    const Frame fixed = joint_offset(joint);
    step.offset = fixed.t * kNmPerMm;
    step.orientation = fixed.R;
    step.oriented = fixed.R != Mat3::Identity();
  }
}

// From the tip inwards: p ← H J p. A column is the motion of p by its axis and only turns from
// then on.
void NominalChain::walk_to_base(const LatchedPose& q, NominalPoint& nominal) const {
  std::array<Vec3*, kMaxAxes> passed;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::size_t count = 0;
  Vec3& p = nominal.base;
  for (std::size_t n = tool_steps_; n > 0; --n) {
    const Step& step = step_[n - 1];
    const Triad axis(step.axis);
    if (step.kind != JointKind::fixed) {
      Vec3& column = nominal.column[step.nc_axis];
      const double along = step.sign * q[step.nc_axis];
      if (step.kind == JointKind::prismatic) {
        p[axis.i] += along;
        column[axis.i] = step.sign;
        column[axis.j] = column[axis.k] = 0.0;
      } else {
        const FineSineCosine t = fine_sine_cosine(along);
        axis.turn(p.data(), t);
        axis.turn(nominal.tool_to_base.data(), t);
        axis.turn(nominal.tool_to_base.data() + 3, t);
        axis.turn(nominal.tool_to_base.data() + 6, t);
        for (std::size_t m = 0; m < count; ++m)
          axis.turn(passed[m]->data(), t);
        column[axis.i] = 0.0;
        column[axis.j] = -step.sign * p[axis.k];
        column[axis.k] = step.sign * p[axis.j];
      }
      passed[count++] = &column;
    }
    if (step.oriented) {
      p = turned(step.orientation, p);
      nominal.tool_to_base = product(step.orientation, nominal.tool_to_base);
      for (std::size_t m = 0; m < count; ++m)
        *passed[m] = turned(step.orientation, *passed[m]);
    }
    p = added(p, 1.0, step.offset);
  }
}

// From base outwards: p ← J⁻¹ H⁻¹ p. The work moves away under the point.
void NominalChain::walk_to_work(const LatchedPose& q, NominalPoint& nominal) const {
  Vec3& p = nominal.part;
  Mat3& R = nominal.part_to_base;
  for (std::size_t n = tool_steps_; n < steps_; ++n) {
    const Step& step = step_[n];
    p = added(p, -1.0, step.offset);
    if (step.oriented) {
      p = turned_back(step.orientation, p);
      R = product(R, step.orientation);
    }
    if (step.kind == JointKind::fixed) continue;
    const Triad axis(step.axis);
    const double along = step.sign * q[step.nc_axis];
    Vec3& column = nominal.column[step.nc_axis];
    if (step.kind == JointKind::prismatic) {
      column = added(Vec3::Zero(), -step.sign, R.col(axis.i));
      p[axis.i] -= along;
    } else {
      const Vec3 along_j = added(Vec3::Zero(), step.sign * p[axis.k], R.col(axis.j));
      column = added(along_j, -step.sign * p[axis.j], R.col(axis.k));
      FineSineCosine t = fine_sine_cosine(along);
      axis.turn_columns(R, t);
      t.sine = -t.sine;
      axis.turn(p.data(), t);
    }
  }
}

VOLCOMP_FLATTEN void NominalChain::at(const LatchedPose& q, const Vec3& tool_point,
                                      const Frame& part, NominalPoint& nominal) const {
  nominal.base = tool_point;
  nominal.tool_to_base.setIdentity();
  walk_to_base(q, nominal);
  nominal.part = nominal.base;
  nominal.part_to_base.setIdentity();
  walk_to_work(q, nominal);
  nominal.part = turned_back(part.R, added(nominal.part, -1.0, part.t));
  nominal.part_to_base = product(nominal.part_to_base, part.R);
}

}  // namespace volcomp
