#pragma once
// Machines that grow with temperature.

#include "comp/metrology/tables/volumetric_model.hpp"
#include "tests/oracle/table_table_machine.hpp"

namespace volcomp::test {

inline constexpr double kSteel_per_K = 11.7e-6;
inline constexpr auto kSteel = static_cast<float>(kSteel_per_K);

inline Temperatures warm(float x, float y, float z) { return {x, y, z, kUnknownTemperature}; }

// Against 21.5 degrees.
inline void let_grow(MachineTables& tables) {
  tables.provenance.temperature_C = 21.5F;
  tables.expansion[0] = {kSteel, -200.0F, 0};
  tables.expansion[1] = {-8.5e-6F, 150.0F, 1};
  tables.expansion[2] = {23.8e-6F, 0.0F, 2};
}

inline MachineTables five_axes(double delta_nm, double epsilon, Random& random) {
  MachineTables t;
  t.machine = table_table();
  for (std::size_t a = 0; a < 3; ++a)
    t.axis[a] = random_table(-250'000'000, 33'333'333, 16, delta_nm, epsilon, random);
  t.axis[3] = random_table(-kTurn * 110 / 360, kTurn * 10 / 360, 23, delta_nm, epsilon, random);
  t.axis[4] = whole_turn(37, delta_nm, epsilon, random);
  return t;
}

inline Status stage_warm(LoadedRunner& runner, const MachineTables& tables, const Temperatures& t) {
  const Status s = runner.compensator->stage(tables, tool_of(tables.machine), 0, t);
  return s.ok() ? runner.compensator->activate() : s;
}

inline Vec3 error_of_tick(const LoadedRunner& runner) {
  const Float3& e = runner.compensator->last_error_nm();
  return {static_cast<double>(e[0]), static_cast<double>(e[1]), static_cast<double>(e[2])};
}

}  // namespace volcomp::test
