#pragma once
// What instrument and surroundings add to figures taken from diagonals, in two ways. As ISO/TR
// 230-9 has it: standard uncertainties of independent contributions add as squares, and twice the
// root is stated (k = 2); the scatter of the machine is what is measured and no contribution. And
// as errors common to all readings, for the intervals of the figures (host/measure/intervals). The
// formulas are derived here from the distributions named; they were not checked against the printed
// report. Nothing has a default: what the user does not state is left out and named.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/host/measure/intervals/run_draws.hpp"

namespace volcomp::host {

// What is known of instrument and surroundings. Empty: not stated.
struct UncertaintyStatement {
  std::optional<double> device_um_per_m;  // expanded (k = 2), from the calibration certificate
  // Sideways distance between beam and diagonal at the far end, at most; both are parallel at best.
  std::optional<double> misalignment_mm;
  std::optional<double> expansion_um_per_m_K;         // coefficient of machine or work
  std::optional<double> temperature_K;                // ± limits of its temperature as measured
  std::optional<double> expansion_limits_um_per_m_K;  // ± limits of the coefficient
  std::optional<double> from_20_K;                    // distance from 20 °C
  std::optional<double> eve_um;     // range of a drift test as long as the measurement
  std::optional<double> volume_um;  // expanded (k = 2), of an error vector in the volume

  // Values of `other` where it has them, else those of this.
  [[nodiscard]] UncertaintyStatement overridden_by(const UncertaintyStatement& other) const;
};

// The table [uncertainty] of a TOML file, with keys as above. Throws UserError: unknown key, number
// that is negative or not finite.
[[nodiscard]] UncertaintyStatement read_uncertainty_file(const std::filesystem::path& path);
[[nodiscard]] UncertaintyStatement parse_uncertainty(const std::string& text,
                                                     const std::string& name);

// Refuses (UserError) what makes sense only together: temperature_K with expansion_um_per_m_K,
// expansion_limits_um_per_m_K with from_20_K.
void require_complete(const UncertaintyStatement& statement);

// How often each target was read.
struct Repetition {
  double length_mm = 0.0;  // from the first target to the last
  std::size_t runs = 0;    // of the direction with fewer
  bool both_directions = false;
};

struct Contribution {
  std::string name;
  double u_um = 0.0;  // standard uncertainty
};

enum class FigureKind : std::uint8_t {
  largest,        // largest mean deviation from the first point
  systematic,     // E, bidirectional systematic deviation
  reversal,       // B
  repeatability,  // R
};

// Contributions to one figure; those not stated are left out.
[[nodiscard]] std::vector<Contribution> contributions(const UncertaintyStatement& statement,
                                                      const Repetition& repetition,
                                                      FigureKind figure);

// k = 2; nothing without contributions.
[[nodiscard]] std::optional<double> expanded_um(const std::vector<Contribution>& contributions);

// What is common to the readings of a diagonal of this length, µm and µm/mm: everything that grows
// with the length as one scale, the drift as it is. The cosine error lies between 0 and r²/2L and
// is not taken off, so its root mean square counts, not its standard deviation as above.
[[nodiscard]] StatedErrors stated_errors(const UncertaintyStatement& statement, double length_mm);

// Keys and values of what is stated of diagonals, and of the volume.
struct StatedValue {
  std::string key;
  double value = 0.0;
};
[[nodiscard]] std::vector<StatedValue> stated_values(const UncertaintyStatement& statement,
                                                     bool of_diagonals, bool of_volume);

// The contributions left out, each as a text with the name of its key.
[[nodiscard]] std::vector<std::string> left_out(const UncertaintyStatement& statement,
                                                bool repeated);

}  // namespace volcomp::host
