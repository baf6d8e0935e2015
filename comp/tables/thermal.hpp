#pragma once
// Linear expansion of the axes with temperature.
//
// A scale (or ballscrew) that is ΔT warmer than when the tables were measured is longer by α·ΔT: an
// axis that reads q has really gone from the fixed point of its scale, where the growth is zero, by
// (1 + α·ΔT)(q − q_fix). Actual minus nominal for the same reading (conventions of comp/machine):
//
//   E = +α·ΔT·(q − q_fix)   along the motion of the axis
//
// so a warmer scale drives the tool too far in the direction in which q counts; the motion takes it
// back. What stays at its place when the machine is as warm as at its reference is exactly the
// measured error: the term is zero there, and where no temperature is known.
//
// α is what the reading grows by, as the tool sees it: that of the scale where only the scale gets
// warm; of scale minus machine where both share one temperature and the part shall keep up with the
// machine. The term is linear in q, so that tables with linear interpolation hold it exactly: it is
// added when they are folded, and costs a tick nothing.

#include <array>
#include <cstdint>
#include <limits>

#include "comp/core/status.hpp"
#include "comp/machine/machine_description.hpp"

namespace volcomp {

inline constexpr std::size_t kTemperatureInputs = 4;
inline constexpr std::uint8_t kNoTemperature = 0xFF;  // no input: the axis keeps its length

inline constexpr float kMaxExpansion_per_K = 1e-4F;
inline constexpr float kMaxFixed_mm = 5000.0F;
inline constexpr float kLeastTemperature_C = -20.0F;  // what an input or a campaign may have
inline constexpr float kMostTemperature_C = 80.0F;

struct AxisExpansion {
  float per_K = 0.0F;                   // α; linear axes only
  float fixed_mm = 0.0F;                // q_fix, NC coordinate
  std::uint8_t input = kNoTemperature;  // 0…3
};
using Expansions = std::array<AxisExpansion, kMaxAxes>;  // by NC axis

// °C; not a number: not known.
using Temperatures = std::array<float, kTemperatureInputs>;
inline constexpr float kUnknownTemperature = std::numeric_limits<float>::quiet_NaN();
inline constexpr Temperatures kUnknownTemperatures{kUnknownTemperature, kUnknownTemperature,
                                                   kUnknownTemperature, kUnknownTemperature};

// α·ΔT of every NC axis; 0 where no temperature is known.
using Strains = std::array<double, kMaxAxes>;
[[nodiscard]] Strains strains(const Expansions& expansion, double reference_C,
                              const Temperatures& temperature);

// The displacement along the joint's own axis, in the unit of `q` and `fixed`: body value, moving
// side. The body moves by sign·q, whatever branch it is on.
[[nodiscard]] inline double thermal_growth(const Joint& joint, double strain, double q,
                                           double fixed) {
  return static_cast<double>(joint.sign) * strain * (q - fixed);
}

// −20…80 °C; not a number is no temperature.
[[nodiscard]] constexpr bool is_temperature(float celsius) {
  return celsius >= kLeastTemperature_C && celsius <= kMostTemperature_C;
}

// Refuses bad_thermal with the axis and the field: expansion (not within ±1e-4 per K, or of a
// rotary axis), fixed point (not within ±5 m), temperature input.
Status check_expansion(const AxisExpansion& expansion, const Joint& joint);

struct Provenance;
// Refuses bad_thermal with the field: reference temperature, expiry (before 1970).
Status check_validity(const Provenance& provenance);

// Whether tables are past their date. 0: a date that is never reached, a time that is not known.
[[nodiscard]] constexpr bool expired(std::int64_t expires_unix_s, std::int64_t now_unix_s) {
  return expires_unix_s != 0 && now_unix_s != 0 && now_unix_s >= expires_unix_s;
}

struct TablesView;
[[nodiscard]] Strains strains(const TablesView& tables, const Temperatures& temperature);
// By how much a correction changes at most, anywhere on the travel of any axis, when the axes of
// `tables` go on to other strains, nm.
[[nodiscard]] double largest_growth_nm(const TablesView& tables, const Strains& strain);

}  // namespace volcomp
