#pragma once
// Shared by the run-time tests: seeded numbers, random tables, an independent long double model of
// the machine (4×4 products, nothing in common with the recursion of comp), and a harness around
// the tick. Lengths in nm, angles in rad, tables as comp stores them (body values, moving side).

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/tick/instances.hpp"

namespace volcomp::test {

inline constexpr std::int64_t kTurn = kUnitsPerTurn;

#ifdef VOLCOMP_GTEST_SUBSET
inline constexpr int kManyPoints = 10'000;  // an emulated board
#elif defined(NDEBUG)
inline constexpr int kManyPoints = 1'000'000;
#else
inline constexpr int kManyPoints = 100'000;  // instrumented and unoptimised builds
#endif

inline std::uint64_t seed() {
  const char* text = std::getenv("VOLCOMP_TEST_SEED");
  return text == nullptr ? 20'200'428U : std::strtoull(text, nullptr, 10);
}

class Random {
 public:
  explicit Random(std::uint64_t offset = 0) : seed_(seed() + offset), bits_(seed_) {}

  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11U) * 0x1p-53;
  }
  std::int64_t integer(std::int64_t low, std::int64_t high) {  // inclusive
    const auto span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1U;
    const std::uint64_t drawn = bits_();
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) +
                                     (span == 0 ? drawn : drawn % span));
  }
  bool chance(double probability) { return in(0.0, 1.0) < probability; }
  [[nodiscard]] std::string trace() const { return "random seed " + std::to_string(seed_); }

 private:
  std::uint64_t seed_;
  std::mt19937_64 bits_;
};

// --- tables --------------------------------------------------------------------------------------

inline AxisTable random_table(std::int64_t q0, std::int64_t pitch, std::uint32_t knots,
                              double delta_nm, double epsilon, Random& random) {
  AxisTable table;
  table.q0 = q0;
  table.pitch = pitch;
  table.knots = knots;
  for (auto& column : table.value) {
    for (std::uint32_t i = 0; i < knots; ++i) {
      for (std::size_t c = 0; c < 6; ++c) {
        const double size = c < 3 ? delta_nm : epsilon;
        column[i][c] = static_cast<float>(random.in(-size, size));
      }
    }
  }
  return table;
}

// Strokes of the XYFZ machine (docs/papers/xyfz.md): −500…0, −300…0, −400…0 mm.
inline MachineTables xyfz_tables(double delta_nm, double epsilon, Random& random,
                                 const MachineDescription& machine = kXyfzMachine) {
  MachineTables tables;
  tables.machine = machine;
  tables.directions = xyfz_directions({127.264e-6, 222.190e-6, 17.356e-6});
  tables.axis[0] = random_table(-500'000'000, 50'000'000, 11, delta_nm, epsilon, random);
  tables.axis[1] = random_table(-300'000'000, 30'000'000, 11, delta_nm, epsilon, random);
  tables.axis[2] = random_table(-400'000'000, 40'000'000, 11, delta_nm, epsilon, random);
  return tables;
}

// Table of X: the same EXX everywhere.
inline MachineTables constant_tables(float x_nm) {
  MachineTables t;
  t.machine = kXyfzMachine;
  for (std::size_t a = 0; a < 3; ++a) {
    t.axis[a].q0 = -100'000'000;
    t.axis[a].pitch = 100'000'000;
    t.axis[a].knots = 2;
  }
  for (auto& column : t.axis[0].value)
    column[0][0] = column[1][0] = x_nm;
  return t;
}

inline Body moving_body(std::uint8_t lower, JointKind kind, Axis axis, int sign, std::uint8_t nc,
                        char letter, const std::array<double, 3>& offset = {}) {
  Body body;
  body.lower = lower;
  body.joint.kind = kind;
  body.joint.axis = axis;
  body.joint.sign = static_cast<std::int8_t>(sign);
  body.joint.nc_axis = nc;
  body.joint.letter = letter;
  body.joint.offset = offset;
  return body;
}

inline Vec3 tool_of(const MachineDescription& machine) {
  return {machine.tool_point[0], machine.tool_point[1], machine.tool_point[2]};
}

// --- independent model ---------------------------------------------------------------------------

using Real = long double;
using Real3 = std::array<Real, 3>;
using Six = std::array<Real, 6>;

struct Htm {
  std::array<std::array<Real, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

  Htm operator*(const Htm& other) const {
    Htm out;
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t c = 0; c < 4; ++c) {
        out.m[r][c] = 0;
        for (std::size_t k = 0; k < 4; ++k)
          out.m[r][c] += m[r][k] * other.m[k][c];
      }
    }
    return out;
  }
  [[nodiscard]] Real3 apply(const Real3& p) const {
    Real3 out{};
    for (std::size_t r = 0; r < 3; ++r)
      out[r] = m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3];
    return out;
  }
  [[nodiscard]] Real3 turn(const Real3& p) const {
    Htm rotation = *this;
    for (std::size_t r = 0; r < 3; ++r)
      rotation.m[r][3] = 0;
    return rotation.apply(p);
  }
  [[nodiscard]] Real3 apply_inverse(const Real3& p) const {
    Real3 out{};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t k = 0; k < 3; ++k)
        out[r] += m[k][r] * (p[k] - m[k][3]);
    }
    return out;
  }
};

inline Htm shifted(const Real3& t) {
  Htm h;
  for (std::size_t r = 0; r < 3; ++r)
    h.m[r][3] = t[r];
  return h;
}

inline Htm turned(std::size_t axis, Real angle) {
  Htm h;
  const std::size_t j = (axis + 1) % 3;
  const std::size_t k = (axis + 2) % 3;
  h.m[j][j] = h.m[k][k] = std::cos(angle);
  h.m[k][j] = std::sin(angle);
  h.m[j][k] = -h.m[k][j];
  return h;
}

// Travel of a tick: 0 forward, 1 backward, 2 unknown (mean).
struct Interpolated {
  Six value{};
  Real held = 0;  // position the axis is treated to stand at, nm or rad
};

inline Interpolated interpolated(const AxisTable& t, bool rotary, std::int64_t q, int travel) {
  const std::int64_t turn = std::int64_t{1} << 40;
  const Real knots = t.knots;
  const Real span = t.periodic ? static_cast<Real>(turn) : static_cast<Real>(t.last() - t.q0);
  Real r = static_cast<Real>(q) - static_cast<Real>(t.q0);
  if (t.periodic) r -= std::floor(r / span) * span;
  r = r < 0 ? 0 : (r > span ? span : r);
  const Real place = r / span * (t.periodic ? knots : knots - 1);
  auto i = static_cast<std::uint32_t>(place);
  if (!t.periodic && i > t.knots - 2) i = t.knots - 2;
  const Real f = place - static_cast<Real>(i);
  const std::uint32_t next = (i + 1) % t.knots;
  const auto column = [&](std::size_t which, std::size_t c) {
    return (1 - f) * static_cast<Real>(t.value[which][i][c]) +
           f * static_cast<Real>(t.value[which][next][c]);
  };
  Interpolated out;
  for (std::size_t c = 0; c < 6; ++c) {
    out.value[c] = travel == 2 ? (column(0, c) + column(1, c)) / 2
                               : column(static_cast<std::size_t>(travel), c);
  }
  const Real position = static_cast<Real>(t.q0) + r;
  out.held = rotary ? position * 2 * std::acos(Real{-1}) / static_cast<Real>(turn) : position;
  return out;
}

// The whole machine at integer positions, for one travel of every axis.
class MachineModel {
 public:
  MachineModel(const MachineTables& tables, const std::array<double, 3>& tool_mm)
      : tables_(tables), tool_{} {
    for (std::size_t i = 0; i < 3; ++i)
      tool_[i] = static_cast<Real>(tool_mm[i]) * 1e6L;
  }

  void stand_at(const std::array<std::int64_t, kMaxAxes>& q,
                const std::array<int, kMaxAxes>& travel) {
    for (std::size_t k = 0; k < tables_.machine.body_count; ++k) {
      const Joint& joint = tables_.machine.body[k].joint;
      if (!joint.moves()) continue;
      at_[joint.nc_axis] =
          interpolated(tables_.axis[joint.nc_axis], joint.kind == JointKind::rotary,
                       q[joint.nc_axis], travel[joint.nc_axis]);
    }
  }

  // Exact chain with Rx Ry Rz, base orientation, every error scaled.
  [[nodiscard]] Real3 exact(Real scale = 1) const {
    const MachineDescription& d = tables_.machine;
    Real3 p = branch(d.tool_body, scale).apply(tool_);
    for (std::size_t a = 0; a < kMaxAxes; ++a) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto e = static_cast<Eigen::Index>(i);
        p[i] += scale * static_cast<Real>(tables_.directions[a](e)) * at_[a].held;
      }
    }
    const Htm ideal_work = branch(d.work_body, 0);
    const Real3 nominal = ideal_work.apply_inverse(branch(d.tool_body, 0).apply(tool_));
    Real3 e = branch(d.work_body, scale).apply_inverse(p);
    for (std::size_t i = 0; i < 3; ++i)
      e[i] -= nominal[i];
    return ideal_work.turn(e);
  }

  // Moves an axis beside where its tables are read: nm or rad.
  void displace(std::size_t axis, Real by) { displaced_[axis] = by; }

  // The tool seen from the work: its point and the direction of its axis, Z of its frame.
  struct Tool {
    Real3 point;
    Real3 axis;
  };
  [[nodiscard]] Tool tool_in_work(Real scale) const {
    const MachineDescription& d = tables_.machine;
    const Htm tool = branch(d.tool_body, scale);
    const Htm work = branch(d.work_body, scale);
    Real3 p = tool.apply(tool_);
    for (std::size_t a = 0; a < kMaxAxes; ++a) {
      for (std::size_t i = 0; i < 3; ++i)
        p[i] += scale * static_cast<Real>(tables_.directions[a](static_cast<Eigen::Index>(i))) *
                at_[a].held;
    }
    const Real3 k = tool.turn({0, 0, 1});
    Real3 axis{};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t i = 0; i < 3; ++i)
        axis[r] += work.m[i][r] * k[i];
    }
    return {work.apply_inverse(p), axis};
  }

  // Tool point of the ideal machine, base frame.
  [[nodiscard]] Real3 nominal() const { return branch(tables_.machine.tool_body, 0).apply(tool_); }

  // First order: the odd part of the exact error; what is left of it is of third order.
  [[nodiscard]] Real3 first_order() const {
    const Real3 plus = exact(1);
    const Real3 minus = exact(-1);
    return {(plus[0] - minus[0]) / 2, (plus[1] - minus[1]) / 2, (plus[2] - minus[2]) / 2};
  }

  [[nodiscard]] const Interpolated& at(std::size_t axis) const { return at_[axis]; }

 private:
  [[nodiscard]] Htm branch(std::uint8_t tip, Real scale) const {
    const MachineDescription& d = tables_.machine;
    Htm chain;
    for (std::uint8_t k = tip; k != 0; k = d.body[k - 1U].lower)
      chain = step(d.body[k - 1U], scale) * chain;
    return chain;
  }

  [[nodiscard]] Htm step(const Body& body, Real scale) const {
    const Joint& joint = body.joint;
    Htm h;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        h.m[r][c] = static_cast<Real>(joint.orientation[3 * r + c]);
      h.m[r][3] = static_cast<Real>(joint.offset[r]) * 1e6L;
    }
    Six e{};
    if (joint.moves()) {
      const Interpolated& at = at_[joint.nc_axis];
      const Real motion = joint.sign * (at.held + displaced_[joint.nc_axis]);
      Real3 along{};
      along[index(joint.axis)] = motion;
      h = h *
          (joint.kind == JointKind::rotary ? turned(index(joint.axis), motion) : shifted(along));
      e = at.value;
    } else {
      for (std::size_t i = 0; i < 6; ++i)
        e[i] = static_cast<Real>(body.constant_error[i]) * (i < 3 ? 1e6L : 1.0L);
    }
    return h * shifted({scale * e[0], scale * e[1], scale * e[2]}) * turned(0, scale * e[3]) *
           turned(1, scale * e[4]) * turned(2, scale * e[5]);
  }

  const MachineTables& tables_;
  Real3 tool_;
  std::array<Interpolated, kMaxAxes> at_{};
  std::array<Real, kMaxAxes> displaced_{};
};

// --- harness -------------------------------------------------------------------------------------

// Nothing limited, nothing delayed: the output is the computed offset of this very tick.
template <std::size_t Axes>
CompensatorSettings<Axes> open_settings() {
  CompensatorSettings<Axes> settings;
  settings.source = PositionSource::actual;
  settings.ramp_ticks = 1;
  for (AxisLimits& l : settings.axis)
    l = {{4'194'303, 1'000'000'000, 1'000'000'000, 0}, 0, 0};
  return settings;
}

template <class Compensator>
struct Runner {
  using Positions = std::array<std::int64_t, Compensator::kAxes>;

  Runner() : compensator(std::make_unique<Compensator>()) { all_valid(); }
  explicit Runner(const MachineDescription& machine, RuntimeModel model = RuntimeModel::automatic)
      : compensator(std::make_unique<Compensator>(
            std::decay_t<decltype(compensator->machine())>{make_runtime_chain(machine, model)})) {
    all_valid();
  }

  // Settings, tables and activation; the first tick is still to come.
  Status start(const MachineTables& tables, const typename Compensator::Settings& settings =
                                                open_settings<Compensator::kAxes>()) {
    if (const Status s = compensator->configure(settings); !s.ok()) return s;
    return swap(tables);
  }
  Status swap(const MachineTables& tables) {
    const Status s = compensator->stage(tables, tool_of(tables.machine), 0);
    return s.ok() ? compensator->activate() : s;
  }
  const typename Compensator::Output& tick(const Positions& q) {
    for (std::size_t a = 0; a < q.size(); ++a)
      in.axis[a].position = q[a];
    return tick();
  }
  const typename Compensator::Output& tick() {
    compensator->tick(in, out);
    return out;
  }
  void all_valid() {
    for (AxisSample& sample : in.axis)
      sample.valid = sample.homed = true;
  }

  std::unique_ptr<Compensator> compensator;
  typename Compensator::Input in{};
  typename Compensator::Output out{};
};

using LoadedRunner = Runner<LoadedCompensator>;
using OrientingRunner = Runner<OrientingCompensator>;
using XyfzRunner = Runner<XyfzCompensator>;

// Scales all values so that the load-time bound S is `bound_nm`.
inline void scale_to_bound(MachineTables& tables, double bound_nm) {
  LoadedRunner probe(tables.machine);
  ASSERT_TRUE(probe.start(tables).ok());
  const double factor = bound_nm / probe.compensator->fold_report().bound_nm;
  for (AxisTable& table : tables.axis) {
    for (auto& column : table.value) {
      for (Channels& knot : column) {
        for (float& v : knot)
          v *= static_cast<float>(factor);
      }
    }
  }
  for (Vec3& direction : tables.directions)
    direction *= factor;
}

}  // namespace volcomp::test
