#pragma once
// A ball bar on circles: the machine goes round a socket on its table, and the length of the bar is
// read (ISO 230-4). With its own set-up errors and noise; evaluated like a user's file.

#include <cstdint>

#include "comp/metrology/circles/circle_squareness.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_evaluation.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// Standard deviations but for the sensor, mm and rad; of bars of the usual class, from memory.
struct BallBarClass {
  double reading = 0.15e-3;
  double centre = 20e-3;                 // of the socket, each coordinate
  double start_angle = 1e-3;             // of the path against what the readings are labelled with
  double tilt = 0.5e-3;                  // of the bar out of the plane
  double length = 0.5e-3;                // after the calibrator, 100 mm
  double sensor = host::kBallBarSensor;  // ±, rectangular, of either part of its second harmonic
};

[[nodiscard]] inline BallBarClass perfect_ball_bar() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }

struct CirclePlan {
  Axis first = Axis::x;  // from this axis towards the second
  Axis second = Axis::y;
  Vec3 centre = Vec3::Zero();  // NC coordinates of X, Y and Z, mm
  double radius = 100.0;       // mm
  double feed = 1000.0;        // mm/min
  std::size_t readings = 360;  // a circle
  std::size_t circles = 2;     // each way
};

// Which random numbers: those of one draw and one placement of the bar.
struct BallBarDraw {
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;
  std::uint32_t setup = 0;
};

// The errors of the machine along the path, in the direction in which each axis travels. X, Y and Z
// are the NC axes `xyz`; the others stand at zero.
[[nodiscard]] host::BallBarTest measure_circles(const TrueMachine& machine, const CirclePlan& plan,
                                                const BallBarClass& bar, const BallBarDraw& draw,
                                                const std::array<std::size_t, 3>& xyz = {0, 1, 2});

// Squareness as three such tests about one point show it: XY, ZX and YZ, placements setup … setup
// + 2.
[[nodiscard]] XyfzSquareness squareness_by_circles(
    const TrueMachine& machine, const SquarenessCircles& place, const BallBarClass& bar,
    const BallBarDraw& draw, const std::array<std::size_t, 3>& xyz = {0, 1, 2});

}  // namespace volcomp::sim
