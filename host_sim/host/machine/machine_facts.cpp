#include "host_sim/host/machine/machine_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "comp/machine/frame.hpp"
#include "comp/machine/inverse.hpp"
#include "comp/metrology/tables/pose_offset.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "comp/tables/image.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

double authority_at(const MachineChain& chain, const Pose& q) {
  MotionOffset offset;
  const Status status = motion_offset(chain, q, chain.tool_point(), Vec3::Zero(), offset);
  return status.ok() ? offset.authority : status.where.value;
}

// Linear axes move levers evenly, rotary ones turn directions: those are looked at more closely.
std::size_t steps_of(const AxisFile& axis, std::size_t axes) {
  if (!axis.rotary) return 3;
  return axes <= 5 ? 13 : 5;
}

double on_grid(const AxisFile& axis, std::size_t step, std::size_t steps) {
  return axis.lo + (axis.hi - axis.lo) * static_cast<double>(step) / static_cast<double>(steps - 1);
}

template <class Value>
LeastAuthority least_over_travel(const std::vector<AxisFile>& axes, const Value& value_at) {
  std::size_t places = 1;
  for (const AxisFile& axis : axes)
    places *= steps_of(axis, axes.size());
  LeastAuthority least;
  least.value = std::numeric_limits<double>::infinity();
  for (std::size_t place = 0; place < places; ++place) {
    Pose q{};
    std::size_t rest = place;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const std::size_t steps = steps_of(axes[a], axes.size());
      q[a] = on_grid(axes[a], rest % steps, steps);
      rest /= steps;
    }
    const double value = value_at(q);
    if (value < least.value) {
      least.value = value;
      least.at = q;
    }
    least.greatest = std::max(least.greatest, value);
  }
  return least;
}

// The smaller singular value of the directions seen along the axis of the tool: how much the axis
// of the tool turns, in the worst direction, per radian of all these axes together.
double turning_at(const MachineChain& chain, const Pose& q,
                  const std::vector<std::size_t>& rotary) {
  const Mat3 tool = chain.ideal(chain.tool(), q).R;
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  for (const std::size_t a : rotary) {
    const Vec3 across = tool.transpose() * turning_column(chain, q, a);
    square += across.head<2>() * across.head<2>().transpose();
  }
  const double half = 0.5 * square.trace();
  const double root = std::sqrt(std::max(0.0, half * half - square.determinant()));
  return std::sqrt(std::max(0.0, half - root));
}

}  // namespace

LeastAuthority least_authority(const MachineFile& machine) {
  return least_over_travel(machine.axes,
                           [&](const Pose& q) { return authority_at(machine.chain, q); });
}

void require_authority(const MachineFile& machine) {
  const double greatest = least_authority(machine).greatest;
  if (greatest >= kMinAuthority) return;
  throw UserError(fmt::format(
      "{}: the axes of [correction] cannot correct anywhere on the travel: authority at "
      "most {:.3f}, {} is needed [{}]",
      machine.path, greatest, kMinAuthority, code(Reason::no_authority)));
}

std::vector<std::size_t> rotary_axes(const MachineChain& chain) {
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    if (chain.axis(a).kind == JointKind::rotary) axes.push_back(a);
  }
  return axes;
}

std::vector<std::size_t> orienting_axes(const MachineChain& chain) {
  const MachineDescription& d = chain.description();
  return {d.orienting.begin(), d.orienting.begin() + d.orienting_count};
}

LeastAuthority least_turning(const MachineFile& machine, const std::vector<std::size_t>& rotary) {
  return least_over_travel(machine.axes,
                           [&](const Pose& q) { return turning_at(machine.chain, q, rotary); });
}

std::vector<std::string> motion_errors(char letter) {
  std::vector<std::string> names;
  for (const char* const channel : {"EX", "EY", "EZ", "EA", "EB", "EC"})
    names.push_back(fmt::format("{}{}", channel, letter));
  return names;
}

// ISO 230-1, 3.6: of a linear axis two directions, of a rotary one also two coordinates. The
// encoder defines the zero of its own coordinate.
std::vector<std::string> location_errors(const Joint& joint) {
  constexpr const char* kLinear = "XYZ";
  constexpr const char* kRotary = "ABC";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < 3 && joint.kind == JointKind::rotary; ++i) {
    if (i != index(joint.axis)) names.push_back(fmt::format("E{}0{}", kLinear[i], joint.letter));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (i != index(joint.axis)) names.push_back(fmt::format("E{}0{}", kRotary[i], joint.letter));
  }
  return names;
}

// As `volcomp build-tables` makes them: refined as far as the room allows.
std::size_t table_bytes(const MachineFile& machine, std::size_t knots) {
  const auto tables = std::make_unique<MachineTables>();
  tables->machine = machine.chain.description();
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const AxisFile& axis = machine.axes[a];
    const std::size_t segments = axis.targets - 1;
    if (axis.targets > knots)
      throw UserError(fmt::format("{}: {} targets of axis {} are more than the {} knots of a table",
                                  machine.path, axis.targets, axis.letter, knots));
    const std::size_t factor =
        std::max<std::size_t>(1, std::min(machine.refine, (knots - 1) / segments));
    ErrorTable table;
    table.q0 = axis.lo;
    table.knots = segments * factor + 1;
    table.pitch = (axis.hi - axis.lo) / static_cast<double>(segments * factor);
    for (std::size_t i = 0; i < table.knots; ++i) {
      table.forward[i].setZero();
      table.backward[i].setZero();
    }
    require(quantise(table, machine.chain.axis(a), knots, tables->axis[a]), machine.path);
  }
  return image_size(*tables);
}

}  // namespace volcomp::host
