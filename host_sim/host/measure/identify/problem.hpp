#pragma once
// What is asked: a machine, what of its errors is unknown, with what it was measured, and the
// observations. Lengths mm, angles rad; errors as body values on the moving side.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "comp/machine/machine_chain.hpp"

namespace volcomp::host::identify {

using Channels = std::vector<std::size_t>;  // 0…5 = EX EY EZ EA EB EC
inline constexpr std::array<const char*, 6> kChannelNames{"EX", "EY", "EZ", "EA", "EB", "EC"};

// Travel of an axis, and where its table is zero.
struct Travel {
  double lo = 0.0;
  double hi = 1.0;
  double reference = 0.0;
  bool periodic = false;  // a full turn
};

struct Machine {
  MachineChain chain;
  std::array<Travel, kMaxAxes> travel;

  [[nodiscard]] std::string name_of(std::size_t axis) const {
    std::string name;
    name = chain.axis(axis).letter;
    return name;
  }
};

// Error functions of an axis.
struct AxisFunctions {
  std::size_t segments = 0;  // 0: none
  Channels channels;
  Channels reversal;  // that have a constant difference between the two directions
};

// Size of what repeats from one knot spacing to the next: σ of the curvature over a segment.
struct Curvature {
  double mm = 0.0;
  double rad = 0.0;
};

struct GaugeRow {
  std::size_t axis = 0;
  std::size_t channel = 0;  // whose slope over the travel is 0
};

struct ErrorModel {
  std::array<AxisFunctions, kMaxAxes> functions;
  std::array<Channels, kMaxAxes> location;  // of a rotary axis, on the fixed side (ISO 230-7)
  std::array<Channels, kMaxAxes> constant;  // of a rotary axis, on the moving side
  std::vector<GaugeRow> gauge;
  std::optional<Curvature> curvature;
};

// σ of an unknown about 0; infinite: free. None: there is no such unknown.
using Prior = std::optional<double>;
inline constexpr double kFree = std::numeric_limits<double>::infinity();

struct Stylus {
  std::string name;
  Vec3 offset = Vec3::Zero();  // point in the tool frame
  double radius = 0.0;
  Prior place;  // of each coordinate; none: the reference, exactly there
  Prior radius_prior;
};

// A distance between two spheres that is known.
struct Length {
  std::size_t a = 0;
  std::size_t b = 0;
  double length = 0.0;
  double sigma = 0.0;
};

struct Artefact {
  std::string name;
  std::vector<Vec3> spheres;
  std::vector<double> radius;
  Prior place;  // of each coordinate of its spheres; free: their rigid motion is held
  Prior scale;
  std::vector<Length> lengths;
};

enum class ObservationKind : std::uint8_t {
  tracer,    // displacement of a reflector against a station
  bar,       // radial deviation of a ball bar
  diagonal,  // displacement along a beam
  step,      // the same of a plane mirror on the tool
  centre,    // centre of a sphere of an artefact, in ideal work coordinates
  touch,     // one latched touch of a sphere
  rtest,     // centre of a table sphere in the frame of the tool
  runs,      // runs of one axis, up to six channels
};
inline constexpr std::array<const char*, 8> kKindNames{"tracer", "bar",   "diagonal", "step",
                                                       "centre", "touch", "rtest",    "runs"};

// Where an artefact lies in the work frame: p = R c + t.
struct Placement {
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();
};

using Directions = std::array<double, kMaxAxes>;  // +1 moving to larger NC q, −1 smaller, 0 unknown

// Readings taken without moving instrument or artefact. What a kind does not need stays empty.
struct SetUp {
  std::string name;
  ObservationKind kind = ObservationKind::tracer;
  std::vector<Pose> q;
  std::vector<Directions> d;        // as many as q
  std::vector<ErrorSet> known;      // errors that tables hold already, as many as q; empty: none
  std::vector<double> y;            // by observation, then component; a plan has none
  std::vector<double> sigma;        // as y
  Prior scale;                      // of its lengths
  Prior growth;                     // of each linear axis meanwhile, relative; not runs
  std::vector<std::size_t> stylus;  // one an observation; empty: the reference
  std::optional<Vec3> station;      // tracer, bar: socket
  Prior station_prior;              // tracer: of each coordinate of its station; none: free
  bool in_bed = false;              // tracer: station on the bed, else on the work
  double length = 0.0;              // bar
  Prior length_prior;               // bar
  Vec3 normal = Vec3::UnitZ();      // bar: of its plane
  std::optional<Vec3> along;        // diagonal, step: direction of the beam, work frame
  std::optional<Vec3> beam;         // step: a point of it
  std::optional<Vec3> mirror;       // step: normal, tool frame
  std::optional<std::size_t> artefact;
  std::vector<std::size_t> sphere;  // one an observation
  std::optional<Placement> pose;
  std::size_t axis = 0;       // runs
  Channels channels;          // runs
  Vec3 lever = Vec3::Zero();  // runs: L = lever + kappa q â
  double kappa = 0.0;
  bool slopes = true;  // runs: slope of straightness is unknown

  [[nodiscard]] std::size_t components() const;
  [[nodiscard]] bool has_pose() const {
    return kind == ObservationKind::centre || kind == ObservationKind::touch;
  }
};

struct Range {
  double lo = 0.0;
  double hi = 0.0;
};

struct Problem {
  Machine machine;
  ErrorModel model;
  std::vector<Stylus> styli;
  std::vector<Artefact> artefacts;
  std::vector<SetUp> setups;

  // Index of the reference stylus; none where no stylus is fixed.
  [[nodiscard]] std::optional<std::size_t> reference() const;
  // The one of an observation; none: the functional point itself.
  [[nodiscard]] std::optional<std::size_t> stylus_of(const SetUp& s, std::size_t i) const;
  // Tip of its stylus, tool frame, as the plan has it.
  [[nodiscard]] Vec3 tip_of(const SetUp& s, std::size_t i) const;
  // From where to where the readings move an axis; nothing where there are none of it.
  [[nodiscard]] std::optional<Range> range_of(std::size_t axis) const;
  // The rotary axes stand alike.
  [[nodiscard]] bool same_turn(const Pose& a, const Pose& b) const;
  [[nodiscard]] bool is_slide(std::size_t axis) const {
    return machine.chain.axis(axis).kind == JointKind::prismatic;
  }
};

// Asks for all that can be told of where the rotary axes are: of one with the work, or with the
// tool where the work turns, too, two displacements across it and two tilts. Of a last one with the
// tool alone the displacements are where the tip stands against it.
void ask_for_locations(Problem& problem);

// Unit vectors across a unit vector: the first turned from the coordinate axis least along it.
[[nodiscard]] std::array<Vec3, 2> across(const Vec3& n);

// Nuisances of a set-up alone, in this order: tracer S, l; bar two shifts of the socket in its
// plane, l; diagonal l; step two tilts of the mirror, l; centre and touch rotation and translation
// of the placement; rtest c; runs an offset a channel, then a slope of each straightness channel.
[[nodiscard]] std::size_t local_count(const Problem& problem, const SetUp& s);
// Straightness channels of a run that have an unknown slope: places in `channels`.
[[nodiscard]] std::vector<std::size_t> sloped_channels(const Problem& problem, const SetUp& s);

}  // namespace volcomp::host::identify
