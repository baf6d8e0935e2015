#include "comp/tables/table_set.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "comp/core/to_double.hpp"
#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "comp/machine/machine_limits.hpp"
#include "comp/tables/reversal.hpp"

namespace volcomp {
namespace {

using Rows = std::array<Knot, 2>*;  // [knot][travel]

Float3 to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

AxisLookup make_lookup(const TableGrid& table, bool rotary) {
  AxisLookup l;
  l.q0 = table.q0;
  l.origin_nm = rotary ? 0.0F : static_cast<float>(to_double(table.q0));
  l.phase = rotary ? static_cast<std::uint32_t>(table.q0 >> 8) : 0U;
  if (table.periodic) {
    l.counted = 0;
    l.travel = l.fast_path_travel = 0xFFFFFFFFU;
    l.scale = table.knots << kFractionBits;
    return l;
  }
  const std::uint64_t segments = table.knots - 1U;
  const auto units = static_cast<std::uint64_t>(table.pitch) * segments;
  const std::uint64_t travel = rotary ? (units + 255U) >> 8U : units;  // the last knot is inside
  while ((travel << (l.shift + 1U)) < (std::uint64_t{1} << 32U))
    ++l.shift;
  l.travel = static_cast<std::uint32_t>(travel);
  l.fast_path_travel = rotary || l.travel <= kMaxFastPathTravel ? l.travel : 0U;
  l.scale = static_cast<std::uint32_t>((segments << (32U + kFractionBits)) / (travel << l.shift));
  l.margin = static_cast<std::uint32_t>(travel / segments / 2U);
  return l;
}

// Geometry of one linear axis at machine zero, as folding needs it.
struct AxisPlace {
  Mat3 R = Mat3::Identity();  // orientation of the frame in base
  Vec3 lever = Vec3::Zero();  // frame origin → tool point, mm, all axes at zero
  double sigma = 1.0;
};

// Ideal frames of all bodies at machine zero.
AxisPlace place_of(const MachineChain& chain, std::uint8_t wanted, const Vec3& tool_point) {
  const Pose zero{};
  const Vec3 tip = chain.ideal(chain.tool(), zero).apply(tool_point);
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    Frame frame;
    for (const std::uint8_t body : *path) {
      frame = frame * joint_offset(chain.joint(body));
      if (body == wanted) return {frame.R, tip - frame.t, branch_sign(chain.joint(body).branch)};
    }
  }
  return {};
}

ErrorMotion channels_of(const AxisTableView& table, std::size_t travel, std::size_t knot) {
  const Channels row = table.row(travel, knot);
  ErrorMotion e;
  for (std::size_t c = 0; c < 6; ++c)
    e(static_cast<Eigen::Index>(c)) = static_cast<double>(row[c]);
  return e;
}

// What the error of a frame does to the tool point: σ(R δ + R ε × lever) and σ R ε. `lever`: as
// long as the tool point is to be moved.
ErrorMotion at_tool_point(const AxisPlace& place, const Vec3& lever, const ErrorMotion& e) {
  const Vec3 turn = turned(place.R, rotation(e));
  ErrorMotion moved;
  moved.head<3>() = place.sigma * added(turned(place.R, translation(e)), 1.0, turn.cross(lever));
  moved.tail<3>() = place.sigma * turn;
  return moved;
}

// The rows of one knot in nm and rad. Folded, for any linear chain (docs/papers/xyfz.md, "What we
// do"): a = σ(R δ + R ε × c) + direction·q, w = σ R ε.
class RowSource {
 public:
  // Own function, for the flash of small boards.
  [[gnu::noinline]] RowSource(const TablesView& tables, std::size_t axis, const AxisPlace* folded)
      : table_(tables.axis[axis]),
        joint_(tables.chain.axis(axis)),
        direction_(tables.directions[axis]),
        folded_(folded),
        grows_(tables.expansion[axis].input != kNoTemperature),
        strain_(tables.strain[axis]),
        fixed_nm_(kNmPerMm * static_cast<double>(tables.expansion[axis].fixed_mm)) {}

  [[nodiscard]] ErrorMotion value(std::size_t travel, std::size_t knot) const {
    ErrorMotion e = channels_of(table_, travel, knot);
    const TableGrid& grid = table_.grid();
    const double q_nm = to_double(grid.q0 + grid.pitch * static_cast<std::int64_t>(knot));
    if (grows_)
      e(static_cast<Eigen::Index>(joint_.axis)) += thermal_growth(joint_, strain_, q_nm, fixed_nm_);
    if (folded_ == nullptr) return e;
    ErrorMotion row = at_tool_point(*folded_, kNmPerMm * folded_->lever, e);
    row.head<3>() = added(translation(row), q_nm, direction_);
    return row;
  }

 private:
  const AxisTableView& table_;
  const Joint& joint_;
  const Vec3& direction_;
  const AxisPlace* folded_;
  bool grows_;
  double strain_;
  double fixed_nm_;
};

// Rows of one axis and the differences to the next knot, periodic or ending flat.
void write_rows(const TableGrid& table, Rows rows, const RowSource& source) {
  for (std::size_t travel = 0; travel < 2; ++travel) {
    ErrorMotion here = source.value(travel, 0);
    const ErrorMotion first = here;
    for (std::size_t i = 0; i < table.knots; ++i) {
      const bool last = i + 1 == table.knots;
      const ErrorMotion next =
          !last ? source.value(travel, i + 1) : (table.periodic ? first : here);
      for (std::size_t c = 0; c < 6; ++c) {
        const auto channel = static_cast<Eigen::Index>(c);
        rows[i][travel].v[c] = static_cast<float>(here(channel));
        rows[i][travel].d[c] = static_cast<float>(next(channel) - here(channel));
      }
      here = next;
    }
  }
}

// Sums for the load-time bounds. Folded rows are already in base: their largest component counts.
// In the recursion frames turn, so that a component can reach the length of the vector: the 1-norm
// counts, an upper bound without a square root.
class Bounds {
 public:
  Bounds(bool folded, double arm_nm) : folded_(folded), arm_nm_(arm_nm) {}

  void include(const TableGrid& table, Rows rows, bool rotary) {
    double displacement = 0.0;
    double turn = 0.0;
    double steepest = 0.0;
    for (std::size_t i = 0; i < table.knots; ++i) {
      for (const Knot& row : rows[i]) {
        displacement = std::max(displacement, size(row.v, 0));
        turn = std::max(turn, size(row.v, 3));
        steepest = std::max(steepest, size(row.d, 0));
      }
    }
    add(displacement, turn);
    const double slope = rotary ? 0.0 : steepest / to_double(table.pitch);
    contraction_ = std::max(contraction_, turn + slope);
  }

  // A displacement, nm, and an angle, rad, that acts on every lever.
  void add(double displacement_nm, double turn_rad) {
    sum_nm_ += displacement_nm + turn_rad * arm_nm_;
  }

  [[nodiscard]] double size(const std::array<float, 6>& v, std::size_t first) const {
    double largest = 0.0;
    double sum = 0.0;
    for (std::size_t c = first; c < first + 3; ++c) {
      const double component = std::abs(static_cast<double>(v[c]));
      largest = std::max(largest, component);
      sum += component;
    }
    return folded_ ? largest : sum;
  }
  [[nodiscard]] double sum_nm() const { return sum_nm_; }
  [[nodiscard]] double contraction() const { return contraction_; }

 private:
  bool folded_;
  double arm_nm_;
  double sum_nm_ = 0.0;
  double contraction_ = 0.0;
};

void fold_linear_axis(const TablesView& tables, std::size_t axis, const Vec3& tool_point,
                      const TableSetView& set) {
  const MachineChain& chain = tables.chain;
  const AxisPlace place = place_of(chain, chain.body_of_axis(axis), tool_point);
  write_rows(tables.axis[axis].grid(), set.rows[axis], RowSource(tables, axis, &place));
  set.travel_axis[axis] = to_float(place.R.col(static_cast<Eigen::Index>(chain.axis(axis).axis)));
}

// Constant errors of fixed bodies join the folded walk (work tip → tool tip): their displacement
// goes into the rows of the first axis, their angle acts on every axis met after them.
void fold_constant_errors(const TablesView& tables, const RuntimeChain& runtime,
                          const Vec3& tool_point, const TableSetView& set) {
  const MachineChain& chain = tables.chain;
  Vec3 shift = Vec3::Zero();
  Vec3 turn = Vec3::Zero();
  int first_axis = -1;
  for (std::size_t i = runtime.steps; i > 0; --i) {
    const RuntimeStep& step = runtime.step[i - 1];
    if (step.kind != JointKind::fixed) {
      set.turn_before[step.nc_axis] = to_float(turn);
      turn.setZero();
      if (first_axis < 0) first_axis = step.nc_axis;
      continue;
    }
    const AxisPlace place = place_of(chain, step.body, tool_point);
    const ErrorMotion own =
        at_tool_point(place, place.lever, chain.error_of(step.body, zero_errors()));
    shift += translation(own);
    turn += rotation(own);
  }
  if (first_axis < 0) return;
  const auto a = static_cast<std::size_t>(first_axis);
  const Float3 shift_nm = to_float(kNmPerMm * shift);
  for (std::size_t i = 0; i < tables.axis[a].grid().knots; ++i) {
    for (Knot& row : set.rows[a][i]) {
      for (std::size_t c = 0; c < 3; ++c)
        row.v[c] += shift_nm[c];
    }
  }
}

// The constant error of the fixed bodies that hang on an axis joins its rows.
void add_carried_error(const ChannelValues& error, Rows rows, std::size_t knots) {
  for (std::size_t i = 0; i < knots; ++i) {
    for (Knot& row : rows[i]) {
      act_after(row.v, error, true);
      act_after(row.d, error, false);
    }
  }
}

void copy_axis(const TablesView& tables, std::size_t axis, const RuntimeChain& runtime,
               const TableSetView& set) {
  write_rows(tables.axis[axis].grid(), set.rows[axis], RowSource(tables, axis, nullptr));
  for (std::size_t i = 0; i < runtime.steps; ++i) {
    const RuntimeStep& step = runtime.step[i];
    if (step.kind != JointKind::fixed && step.nc_axis == axis && step.has_error)
      add_carried_error(step.error, set.rows[axis], tables.axis[axis].grid().knots);
  }
  set.direction[axis] = to_float(tables.directions[axis]);
}

// Rows of J⁻¹ at machine zero (mm/mm), which are those of every pose.
Status fold_inverse(const MachineChain& chain, const RuntimeChain& runtime, const Vec3& tool_point,
                    const TableSetView& set) {
  const bool needed = runtime.folded || runtime.inverse.form == InverseForm::constant;
  if (!needed || runtime.correcting_count == 0) return {};
  const Pose zero{};
  for (Eigen::Index k = 0; k < 3; ++k) {
    MotionOffset offset;
    if (const Status s = motion_offset(chain, zero, tool_point, Vec3::Unit(k), offset); !s.ok())
      return s;
    for (std::size_t c = 0; c < runtime.correcting_count; ++c) {
      set.inverse[c][static_cast<std::size_t>(k)] =
          static_cast<float>(-offset.offset[runtime.correcting[c]]);
    }
  }
  return {};
}

double largest_position(const TableGrid& table) {
  return std::max(std::abs(to_double(table.q0)), std::abs(to_double(table.last())));
}

// Longest lever an angle acts on in the kernel: the travel of every axis and, where they are not
// folded into the rows, all offsets and the tool; nm. 1-norm: an upper bound without a square root.
double reach_nm(const TablesView& tables, bool folded, const Vec3& tool_point) {
  const MachineDescription& machine = tables.chain.description();
  double reach = folded ? 0.0 : kNmPerMm * tool_point.cwiseAbs().sum();
  for (std::size_t k = 0; k < machine.body_count && !folded; ++k) {
    reach += kNmPerMm * joint_offset(machine.body[k].joint).t.cwiseAbs().sum();
  }
  for (std::size_t a = 0; a < tables.chain.axis_count(); ++a) {
    if (tables.chain.axis(a).kind == JointKind::prismatic)
      reach += largest_position(tables.axis[a].grid());
  }
  return reach;
}

// Everything the tick adds up: rows, constant errors, squareness.
Bounds measure_bounds(const TablesView& tables, const RuntimeChain& runtime, const Vec3& tool_point,
                      const TableSetView& set) {
  Bounds bounds(runtime.folded, reach_nm(tables, runtime.folded, tool_point));
  for (std::size_t a = 0; a < runtime.axes; ++a) {
    const bool rotary = runtime.kind[a] == JointKind::rotary;
    const TableGrid& table = tables.axis[a].grid();
    bounds.include(table, set.rows[a], rotary);
    if (runtime.folded || rotary) continue;  // folded rows hold the squareness
    bounds.add(tables.directions[a].cwiseAbs().sum() * largest_position(table), 0.0);
  }
  for (std::size_t i = 0; i < runtime.steps; ++i) {
    const RuntimeStep& step = runtime.step[i];
    if (step.kind != JointKind::fixed) continue;  // in the rows
    const double displacement =
        runtime.folded ? 0.0 : bounds.size(step.error, 0);  // folded: in the rows
    bounds.add(displacement, bounds.size(step.error, 3));
  }
  return bounds;
}

// Own function: the second chain leaves the stack before folding begins.
[[gnu::noinline]] bool runs_on(const RuntimeChain& runtime, const MachineDescription& machine) {
  const RuntimeModel model = runtime.folded ? RuntimeModel::folded : RuntimeModel::second_order;
  return same_chain(runtime, make_runtime_chain(machine, model));
}

Status fold_axis(const TablesView& tables, std::size_t axis, const RuntimeChain& runtime,
                 const Vec3& tool_point, const TableSetView& set) {
  const AxisTableView& table = tables.axis[axis];
  const Joint& joint = tables.chain.axis(axis);
  Where where;
  where.axis = joint.letter;
  if (const Status s = check_knots(table.grid(), joint, set.knots); !s.ok()) return s;
  if (const Status s = check_values(table, joint); !s.ok()) return s;
  const Reason straight = check_numbers(tables.directions[axis].data(), 3, kMaxDirection_rad);
  if (straight != Reason::ok) return refuse(straight, where);
  set.lookup[axis] = make_lookup(table.grid(), runtime.kind[axis] == JointKind::rotary);
  if (runtime.folded) {
    fold_linear_axis(tables, axis, tool_point, set);
  } else {
    copy_axis(tables, axis, runtime, set);
  }
  return {};
}

}  // namespace

Status fold_tables(const TablesView& tables, const RuntimeChain& runtime, const Vec3& tool_point,
                   const TableSetView& set, FoldReport& report) {
  const MachineChain& chain = tables.chain;
  if (chain.axis_count() != runtime.axes || chain.axis_count() > set.axes)
    return refuse(Reason::axes_mismatch);
  if (!runs_on(runtime, chain.description())) return refuse(Reason::machine_mismatch);
  const Reason tool = check_numbers(tool_point.data(), 3, kMaxOffset_mm);
  if (tool != Reason::ok) {
    Where where;
    where.field = "tool_point";
    return refuse(tool, where);
  }

  *set.tool_nm = to_float(kNmPerMm * tool_point);
  kernel::orient(*set.tool_nm, runtime.tool_orientation);
  kernel::add(*set.tool_nm, runtime.tool_offset_nm);
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    if (const Status s = fold_axis(tables, a, runtime, tool_point, set); !s.ok()) return s;
  }
  if (runtime.folded && runtime.has_constant_error)
    fold_constant_errors(tables, runtime, tool_point, set);
  if (const Status s = fold_inverse(chain, runtime, tool_point, set); !s.ok()) return s;

  const Bounds bounds = measure_bounds(tables, runtime, tool_point, set);
  report.bound_nm = bounds.sum_nm();
  report.contraction = bounds.contraction();
  report.within_1nm = bounds.sum_nm() <= kClaimBound_nm;
  Where where;
  where.has_value = true;
  where.value = bounds.sum_nm() / kNmPerMm;
  if (!(bounds.sum_nm() <= kMaxBound_nm)) return refuse(Reason::bound_exceeded, where);
  where.value = bounds.contraction();
  if (!(bounds.contraction() <= kMaxContraction))
    return refuse(Reason::contraction_exceeded, where);
  measure_reversals(tables, runtime, set, report);
  return {};
}

}  // namespace volcomp
