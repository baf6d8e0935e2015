#pragma once
// Calibrating a touch probe on an artefact of known diameter: computes effective radius, lobing map
// and their uncertainty, in the form of a node, from the centres of its ball in many touches.
//
// A ball whose centre stands in c at a touch shows the radius |c − p| − R in this direction on a
// sphere of radius R about p, and R − |c − p| in a ring. Place and mean radius come from
// fit_sphere() or fit_circle(), the map from fit_lobing(). Its terms of first order are equivalent
// to a shift of p: p is moved until none is left. They stay only where the tool has turned against
// the artefact between the touches, which separates them.

#include <cstdint>
#include <optional>

#include "comp/machine/joint.hpp"
#include "comp/probe/lobing.hpp"
#include "host_sim/host/measure/touch_csv.hpp"

namespace volcomp::host {

enum class ArtefactShape : std::uint8_t { sphere, ring };

struct ProbeArtefact {
  ArtefactShape shape = ArtefactShape::sphere;
  double diameter_mm = 0.0;
  std::optional<double> expanded_um;  // uncertainty (k = 2) of the diameter, from its certificate
  Axis ring_axis = Axis::z;           // of a ring, in the coordinates of the touches
};

enum class ProbeModel : std::uint8_t {
  lobing,    // by direction, to third order
  constant,  // one radius for all directions
};

// mm; uncertainties are standard ones.
struct ProbeCalibration {
  LobingMap radius;            // by direction; the first coefficient is the effective radius
  std::uint32_t known = 0;     // a bit per coefficient that the touches determine; the others are 0
  Vec3 centre = Vec3::Zero();  // of the artefact, in the coordinates of the touches
  std::size_t touches = 0;
  std::size_t parameters = 0;  // that were fitted, the place of the artefact among them
  double repeatability = 0.0;  // standard deviation of the residuals
  double largest = 0.0;        // residual of largest magnitude, signed
  std::size_t worst_line = 0;  // its line in the file
  double least_radius = 0.0;   // of the map, in the directions that were touched
  double most_radius = 0.0;
  double u_effective = 0.0;  // of the effective radius
  double u_map = 0.0;        // of the radius in a touched direction, root of the mean square
};

// Throws UserError naming the file, and the line where it has one: too few touches, touches that
// do not show the artefact (all in one plane, all alike), a radius that no ball has, residuals that
// are no lobing.
[[nodiscard]] ProbeCalibration calibrate_probe(const TouchFile& file, const ProbeArtefact& artefact,
                                               ProbeModel model);

}  // namespace volcomp::host
