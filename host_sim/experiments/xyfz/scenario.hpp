#pragma once
// Runs the whole campaign of docs/papers/xyfz.md: measures, builds tables, compensates at tick
// rate, measures again.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/experiments/xyfz/draws.hpp"
#include "host_sim/experiments/xyfz/truth.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/parts_of_run.hpp"
#include "host_sim/host/report/positioning.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/campaign/measured_diagonals.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"

namespace volcomp::xyfz {

// The default machine: on PNP the paper's own variant does as well as the paper reports, on other
// diagonals it does not.
inline constexpr std::uint64_t kXyfzMachineSeed = 14;

// What the ball bar goes along to find squareness: three lines, with an error stated for the angle,
// or circles of kBallBar_mm, with all errors of its own.
enum class Functional : std::uint8_t { lines, circles };
inline constexpr std::array<const char*, 2> kFunctionalNames{"lines", "circles"};
inline constexpr double kBallBar_mm = 100.0;

struct XyfzOptions {
  std::filesystem::path machine;  // machine file
  std::filesystem::path
      campaign;  // where the run files are written and read back; empty: a temporary folder
  std::size_t draws = 50;
  std::uint64_t seed = 1;  // of the noise
  std::uint64_t machine_seed = kXyfzMachineSeed;
  std::size_t runs = 5;               // bidirectional, per axis, in a noisy campaign
  std::size_t knots = kDefaultKnots;  // per table: what the node has room for
  int volume_points = 800;
  int tick_points = 200'000;  // places at which the tick is compared with the double model
  sim::CellFactory make_cell = sim::make_integrated_cell;  // what drives the machine
  std::size_t threads = 1;   // for the noisy campaigns; 1 where machines share a bus
  std::size_t machines = 1;  // of machine_seed and the seeds after it: run_machines()
  // The paper's figures, to which the machine is tuned, are those of a perfect bar along lines.
  Functional noise_free = Functional::lines;
  Functional noisy = Functional::circles;
  std::optional<sim::NoiseSource> only;  // what errs in them; none: everything
  host::Shard shard{};                   // which of the noisy campaigns
};

// 0 = uncompensated, then the three models in the order of ModelKind.
inline constexpr std::array<const char*, 4> kModeNames{"uncompensated", "naive", "abbe",
                                                       "abbe_closed"};

struct ModeResult {
  std::vector<sim::MeasuredDiagonal> body;  // PPP NPP PNP PPN
  std::vector<sim::MeasuredDiagonal> face;
  sim::MeasuredDiagonal pnp_on_knots;
  host::VolumeFigures volume;
  double model_bound_nm = 0.0;

  [[nodiscard]] double faces_max_um() const;
};

// Samples of a motion.
struct Trace {
  std::vector<double> x;
  std::vector<double> y;
};

struct Dynamics {
  Trace line_offset_error_nm;  // applied − wanted offset, largest component, over mm of path
  double line_worst_nm = 0.0;
  double unit_nm = 1.0;         // of the drives: offsets are rounded to it
  Trace line_deviation_um;      // distance from the line, compensated
  Trace line_deviation_raw_um;  // uncompensated
  Trace circle_um;              // radial deviation over degrees, compensated
  Trace circle_raw_um;

  // As good as rounding allows.
  [[nodiscard]] bool line_is_good() const { return line_worst_nm <= 1.5 + 0.5 * unit_nm; }
};

struct PerAxisRemainder {
  Vec3 max_um = Vec3::Zero();  // what one-dimensional tables cannot represent, per component
  double rms_um = 0.0;
};

struct XyfzResult {
  host::MachineFile machine;
  XyfzOptions options;
  XyfzTuning tuning;
  sim::NoiseClasses noise;  // of the noisy campaigns
  std::array<ModeResult, 4> mode;
  std::vector<DrawResult> draws;  // of the shard, in order
  Dynamics dynamics;
  double tick_max_error_nm = 0.0;  // integer tick against the same model in double
  PerAxisRemainder per_axis;
  std::vector<Iso230Figures> positioning;  // of the first noisy campaign, mm
  std::vector<sim::LeverCheck> levers;     // realistic instruments
  std::vector<std::string> warnings;
  std::unique_ptr<host::BuiltTables>
      example;  // abbe_closed of the first noisy campaign (noise-free without draws)
  std::vector<host::Positioning> positioning_check;  // of the axes before, then after
  std::vector<Vec3> volume_points;                   // mm, a grid
  std::array<std::vector<Vec3>, 2> volume_error;     // there, before and after, mm
  std::vector<host::HashedInput> inputs;

  [[nodiscard]] double rate(
      std::size_t mode) const;  // PNP, noise-free, between the knots, per cent
  [[nodiscard]] double rate_on_knots(std::size_t mode) const;
  [[nodiscard]] double draw_quantile(std::size_t model, double fraction) const;
  [[nodiscard]] double draws_reaching(double wanted) const;  // share of abbe_closed
};

// Throws UserError.
[[nodiscard]] XyfzResult run_xyfz(const XyfzOptions& options, const host::Progress& progress);

}  // namespace volcomp::xyfz
