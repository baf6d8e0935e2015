#pragma once
// The L300G as a machine that probes, with random errors of all axes, and touches with the latches
// of a straight motion.

#include "comp/core/units.hpp"
#include "comp/probe/probe_corrector.hpp"
#include "tests/oracle/l300g_machine.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {

constexpr double kUnitsPerDegree = static_cast<double>(kUnitsPerTurn) / 360.0;

inline const SwingArm kProbeArm{173.7135, -39.025 * kPi / 180.0};
inline const L300gDatum kProbeDatum{0.0, 168.8053};

inline MachineDescription probing_machine() { return l300g_machine(kProbeArm, kProbeDatum); }

// X 0…300 mm, Y 150…350 mm, B −60…0°, A periodic.
inline MachineTables probing_tables(double delta_nm, double epsilon, Random& random) {
  MachineTables tables;
  tables.machine = probing_machine();
  tables.directions = zero_directions();
  const auto degree = static_cast<std::int64_t>(kUnitsPerDegree);
  tables.axis[0] = random_table(0, 30'000'000, 11, delta_nm, epsilon, random);
  tables.axis[1] = random_table(150'000'000, 20'000'000, 11, delta_nm, epsilon, random);
  tables.axis[2] = random_table(-60 * degree, 6 * degree, 11, delta_nm, epsilon, random);
  tables.axis[3] = random_table(0, kUnitsPerTurn / 16, 16, delta_nm, epsilon, random);
  tables.axis[3].periodic = true;
  return tables;
}

inline Vec3 tool_nm(const MachineDescription& machine) { return tool_of(machine) * kNmPerMm; }

inline ProbeCorrector corrector_of(const MachineDescription& machine) {
  ProbeCorrector corrector;
  corrector.set_machine(machine);
  return corrector;
}

inline ProbeCorrector probing_corrector() { return corrector_of(probing_machine()); }

// A pose where gears are touched.
inline std::array<std::int64_t, kMaxAxes> random_probing_pose(Random& random) {
  const auto degrees = [](double d) { return static_cast<std::int64_t>(d * kUnitsPerDegree); };
  return {random.integer(10'000'000, 290'000'000), random.integer(170'000'000, 340'000'000),
          degrees(random.in(-50.0, -25.0)), degrees(random.in(-400.0, 400.0))};
}

inline Touch touch_at(const std::array<std::int64_t, kMaxAxes>& q) {
  Touch touch;
  for (std::size_t a = 0; a < 4; ++a)
    touch.latched[a] = {q[a], 0.0, Direction::forward};
  return touch;
}

inline Vec3 vec(const Real3& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

inline Vec3 vec(const std::array<std::int64_t, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace volcomp::test
