#pragma once
// A simulated machine measures itself: its probe touches spheres, or tracers follow it; the errors
// identified from that go into its tables, and the deviations of the simulated machine at other
// places judge the result.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/experiments/any_machine/verification.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/measure/identify/identification.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/simulated_readings.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"

namespace volcomp::self_calibration {

struct Options {
  std::filesystem::path plan;
  std::uint64_t seed = 1;    // of the errors of the machine, of what stands where, of the noise
  bool noise = true;         // of instruments, artefact and temperature
  std::size_t places = 300;  // of the verification, all over the travel
  bool leave_out = true;     // each set-up against the others
  sim::BusAxesFactory make_axes;  // touches through drives, latches and node; none: computed
  double cycle_hz = sim::kBusCycle_hz;
  sim::CellFactory make_cell = sim::make_integrated_cell;  // of the verification
};

// Error vectors all over the travel beside their best rigid motion, µm.
struct VolumeResidual {
  double rms = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

struct Result {
  Options options;
  sim::TrueMachine truth;
  host::identify::MeasurementPlan plan;      // as measured
  std::map<std::string, std::string> files;  // of its readings, by name
  std::size_t touches = 0;
  host::identify::Identified found;
  std::vector<std::uint8_t> image;
  VolumeResidual predicted;  // at the places of the verification, from the covariance
  std::vector<double> u_um;  // of each of these places
  any_machine::SpherePlan sphere;
  any_machine::MachineState before;
  any_machine::MachineState after;
  std::vector<host::HashedInput> inputs;

  [[nodiscard]] VolumeResidual residual(const any_machine::MachineState& state) const;
  // The same, but where the plan does not model reversal the mean of both directions, as the
  // prediction is. Takes the true reversal, which only a simulation has.
  [[nodiscard]] VolumeResidual without_unmodelled_reversal(
      const any_machine::MachineState& state) const;
  // Largest distance from the ball on the table, found at the first position; of the same.
  [[nodiscard]] double sphere_without_unmodelled_reversal_um(
      const any_machine::MachineState& state) const;
  [[nodiscard]] bool models_reversal() const;
  // The share of the places whose residual after compensation is within twice its predicted
  // standard uncertainty.
  [[nodiscard]] double coverage() const;
};

// Throws UserError.
[[nodiscard]] Result run_self_calibration(const Options& options, const host::Progress& progress);

}  // namespace volcomp::self_calibration
