#pragma once
// A circular test evaluated after ISO 230-4 (quoted from memory, the print was not at hand): the
// figures of the standard with intervals, and what the form of the circles tells about two axes.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/metrology/circles/circle_figures.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_circles.hpp"
#include "host_sim/host/measure/intervals/circle_interval.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::host {

// Mean of the circles of one direction.
struct CirclePath {
  std::vector<double> theta;     // rad, in the order of time
  std::vector<double> radial;    // mm, of the bar
  std::vector<double> centred;   // about the centre of least squares, mm
  std::vector<double> residual;  // what the decomposition leaves, mm
  CircleFigures figures;
  std::array<CircleSpike, 4> spikes{};
};

// What the sensor of a bar of the usual class may be off by, ±, mm; from memory.
inline constexpr double kBallBarSensor = 0.5e-3;

struct BallBarSettings {
  std::uint64_t seed = 1;
  std::size_t draws = 4000;  // of the intervals
  // Of a reading, mm; 0: the spread of two or more circles each way.
  double sigma = 0.0;
};

struct BallBarEvaluation {
  CircleSettings settings;
  const char* squareness = "";                    // its name in tables
  std::array<std::optional<CirclePath>, 2> path;  // ccw, cw
  std::optional<CircleFigures> both;              // G(b) and D, about one common centre
  CircleDecomposition decomposition;              // of the mean paths
  double u_squareness = 0.0;  // rad: of the residuals, or of the spread of the circles if larger
  double sensor_squareness = 0.0;  // rad: what a sensor off by ± 0.5 µm could add at worst
  std::size_t draws = 0;           // behind the intervals: fewer where there are many readings
  std::optional<CircleIntervals> intervals;  // mm
  bool full = true;                          // full circles, not arcs
  std::vector<std::string> remarks;
};

// Throws UserError where circles of one direction have other angles than the first.
[[nodiscard]] BallBarEvaluation evaluate_ball_bar(const BallBarTest& test,
                                                  const BallBarSettings& settings);

// The decomposition of the mean paths alone. Throws UserError as evaluate_ball_bar.
[[nodiscard]] CircleDecomposition decompose_ball_bar(const BallBarTest& test);

// --- ball_bar_report.cpp: for people, for programs, as a page
[[nodiscard]] std::string ball_bar_text(const BallBarTest& test, const BallBarEvaluation& e);
[[nodiscard]] nlohmann::json ball_bar_json(const BallBarTest& test, const BallBarEvaluation& e,
                                           const BallBarSettings& settings);
[[nodiscard]] nlohmann::json ball_bar_document(const BallBarTest& test, const BallBarEvaluation& e,
                                               const RunContext& run, Origins origins);

}  // namespace volcomp::host
