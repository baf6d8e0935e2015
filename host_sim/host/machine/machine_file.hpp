#pragma once
// A machine as its owner describes it: machine.toml. Every mandatory field is named when it is
// missing, every error carries file and line.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comp/machine/machine_chain.hpp"
#include "comp/machine/xyfz.hpp"
#include "comp/metrology/gears/internal_gear.hpp"
#include "comp/metrology/tables/abbe.hpp"
#include "comp/metrology/tables/error_table.hpp"
#include "comp/tables/thermal.hpp"
#include "firmware/node/ways.hpp"

namespace volcomp::host {

// How a correction reaches an axis: 2034h of the node.
using node::Way;

// The drive of an axis on the bus.
struct DriveFile {
  std::uint8_t node = 0;
  std::uint32_t scale_numerator = 1;  // run-time units (nm or 2^-40 turn) per unit of the drive
  std::uint32_t scale_denominator = 1;
  std::uint32_t units_per_turn =
      0;  // 2036h: instead of the fraction, which cannot hold it; 0: none
  std::optional<std::uint16_t> referenced_mask;  // bits of 6041h that mean it, 2033h; not said
  std::optional<std::array<double, 2>> software_limits_mm;  // 607Dh
  std::string model;  // name of a data sheet that comes with the program, or path; empty: not said
  Way way = Way::offset;
  std::optional<bool> reports_offset;  // 60B0h in a TPDO; not said: as the model, or it does
};

// The other devices on the bus.
struct BusFile {
  bool stated = false;     // the file has a [bus]
  std::uint8_t node = 32;  // that compensates
  std::uint8_t controller = 127;
  std::optional<double> cycle_hz;  // rate of SYNC
};

struct AxisFile {
  char letter = '\0';
  bool rotary = false;
  double lo = 0.0;  // travel, mm or rad
  double hi = 0.0;
  std::size_t targets = 11;
  double reference = 0.0;
  SensedPoint sensed;
  double latch_delay_us = 0.0;  // of the touch probe input of its drive
  DriveFile drive;
  // mm/s² or rad/s²: of the axis as it moves, and what its drive has beyond that; not said.
  std::optional<double> max_acceleration;
  std::optional<double> spare_acceleration;
  // Its error where the runs count as zero, in the convention and on the side of the file. For a
  // rotary axis: its position and tilt.
  ErrorMotion at_reference = ErrorMotion::Zero();

  [[nodiscard]] bool full_turn() const;  // rotary, from anywhere once round
  // Where target t of a campaign lies, of the equally spaced ones over the travel; all of them; the
  // one nearest to the reference.
  [[nodiscard]] double target(std::size_t t) const;
  [[nodiscard]] std::vector<double> all_targets() const;
  [[nodiscard]] std::size_t reference_target() const;
};

// A touch probe at the tool point.
struct ProbeFile {
  double radius_mm = 0.0;  // effective, of the ball
  double delay_us = 0.0;   // from the contact to the edge at the drives
  // For simulations: of kProbeClassNames; none: as the experiment has it.
  std::optional<std::size_t> probe_class;
  Vec3 stylus = Vec3::UnitZ();  // its axis, tool frame
};

// How a simulated laser drifts, and the machine under it.
inline constexpr std::array<const char*, 4> kDriftNames{"none", "walk", "ornstein", "exponential"};
struct LaserFile {
  std::size_t drift = 2;     // of kDriftNames
  double drift_mm = 0.3e-3;  // of a length: standard deviation, of a walk after a second, or end
  double drift_tau_s = 900.0;
  double dwell_s = 5.0;   // from one reading to the next
  double growth_K = 0.1;  // standard deviation: how much warmer an axis is while it is measured
  bool roll_by_level = false;  // of X and Y
};

// Squareness measured at a place: by circles of a ball bar about a point, or along three lines
// through it, each from two ends.
struct SquarenessFile {
  XyfzSquareness measured;
  Vec3 at = Vec3::Zero();
  std::optional<double> circle_radius;  // mm; none: along lines
  // Of the lines; without ends where only circles are stated.
  std::array<std::array<double, 2>, 3> segment{};
  std::size_t points = 7;  // per line

  [[nodiscard]] bool has_lines() const { return segment[0][0] < segment[0][1]; }
  [[nodiscard]] std::vector<double> line(std::size_t axis) const;
};

// How the axes grow, and how long tables are good for.
inline constexpr double kMostExpiry_days = 36'500.0;
struct ThermalFile {
  double reference_C = 20.0;  // of the campaign
  double expires_days = 0.0;  // after tables are built; 0: never
  Expansions expansion{};     // by NC axis
};

// Largest acceleration of the offset of an axis; of one that takes no offset: any.
struct OffsetAcceleration {
  double value = 0.0;   // mm/s² or rad/s²; 0: any
  bool stated = false;  // by the file; otherwise the default, which only `setup` switches on
  std::string origin;   // for complaints: "axis X: a tenth of 'max_acceleration_mm_per_s2'"
};

struct CorrectionFile {
  double limit_mm = 0.2;
  double rate_mm_per_s = 10.0;
  double hysteresis_mm = 0.002;
  double ramp_s = 0.2;
  double tick_hz = 1000.0;
  double max_speed_mm_per_s = 0.0;  // 0: position jumps are not checked
  // The same of rotary axes.
  double limit_rad = 1e-3;
  double rate_rad_per_s = 0.1;
  double hysteresis_rad = 1e-5;
  double max_speed_rad_per_s = 0.0;
  std::array<OffsetAcceleration, kMaxAxes> acceleration{};  // by NC axis

  // Defaults count as stated.
  [[nodiscard]] CorrectionFile with_default_acceleration() const;
};

// NC axes that take offsets: the correcting and the orienting ones.
[[nodiscard]] std::vector<std::size_t> axes_with_offsets(const MachineDescription& d);

// What a grinder of internal gears grinds, and how: [gear], [wheel] and [stroke].
struct GrindingFile {
  InternalGear gear;
  double width_mm = 0.0;         // of the gear
  double wheel_radius_mm = 0.0;  // of a form wheel
  double feed_mm_per_s = 0.0;    // of the stroke
  double acceleration_mm_per_s2 = 200.0;
  double overrun_mm = 10.0;  // beyond the gear, at each end
};

struct MachineFile {
  std::string path;
  std::string name;
  std::uint32_t id = 0;
  Convention convention = Convention::relative;
  Side side = Side::moving;
  MachineChain chain;
  std::vector<AxisFile> axes;  // by NC axis
  BusFile bus;
  std::vector<std::string> body_names;
  CorrectionFile correction;
  std::size_t refine = 8;
  Interpolation interpolation = Interpolation::catmull_rom;
  std::optional<SquarenessFile> squareness;
  ThermalFile thermal;
  std::optional<ProbeFile> probe;
  LaserFile laser;
  std::optional<GrindingFile> grinding;

  [[nodiscard]] std::size_t axis_index(char letter) const;  // throws UserError
  // Throws UserError unless the NC axes are these, in this order.
  void expect_axes(const std::string& letters) const;
};

// Throws UserError.
[[nodiscard]] MachineFile read_machine_file(const std::filesystem::path& path);
[[nodiscard]] MachineFile parse_machine(const std::string& text, const std::string& name);

// The machines that come with the program, by name ("xyfz"), in alphabetical order.
[[nodiscard]] std::vector<std::string> bundled_machines();
// One of them.
[[nodiscard]] std::filesystem::path bundled_machine(const std::string& name);

}  // namespace volcomp::host
