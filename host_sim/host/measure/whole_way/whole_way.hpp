#pragma once
// Monte Carlo of the whole way from readings to the error that tables predict: each draw is a
// campaign as it may have been, from which build_tables() makes tables. Beside it the propagation
// to first order. Both know only what runs show and what is stated; interpolation and basis
// functions between targets are in neither.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/host/measure/intervals/interval.hpp"
#include "host_sim/host/measure/whole_way/campaign_statement.hpp"
#include "host_sim/host/measure/whole_way/task.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace volcomp::host {

inline constexpr std::size_t kFewestDraws = 100;
inline constexpr std::size_t kMostDraws = 100'000;
// Draws times places: what is kept of each draw must fit in memory.
inline constexpr std::size_t kMostDrawnPlaces = 4'000'000;

struct WholeWaySettings {
  std::size_t draws = 4000;
  std::uint64_t seed = 1;
  std::size_t threads = 1;          // changes nothing but the time
  Travel travel = Travel::unknown;  // in which all axes arrive: unknown is the mean of both
  BuildOptions build;               // those of the image
};

// Of one number over all draws.
struct DrawnNumber {
  double nominal = 0.0;  // without any error added
  double mean = 0.0;
  double deviation = 0.0;  // standard deviation
  double low = 0.0;        // 2.5 % and 97.5 % of the draws are below: order statistics ⌈K p⌉
  double high = 0.0;
  std::optional<double> first_order;  // standard uncertainty by propagation; none for a figure
                                      // that is 0 at the nominal
  // Of draws to first order; nothing where that is 0.
  [[nodiscard]] std::optional<double> ratio() const;
};

// Error of the tool point in base, mm.
struct PlaceUncertainty {
  Pose at{};
  std::array<DrawnNumber, 3> error;
};

// An extreme over all places, mm. First order need not hold for it.
struct TaskFigure {
  std::string key;   // for programs
  std::string name;  // for people
  DrawnNumber drawn;
  std::optional<FigureInterval> truth;  // interval of the true figure at these places
};

// What a group of inputs contributes to first order at the place with the largest uncertainty, mm.
struct GroupShare {
  std::string group;
  Vec3 u = Vec3::Zero();
};

struct TaskUncertainty {
  std::vector<PlaceUncertainty> places;
  std::vector<TaskFigure> figures;  // none of a single point
  std::size_t worst = 0;            // place with the largest uncertainty of the three components
  std::vector<GroupShare> shares;   // of that place, largest first
  std::size_t inputs = 0;
  std::vector<std::string> drawn_as_zero;
  std::vector<std::string> remarks;

  // 3/√(2 K): how far a standard deviation of K draws may be from that of the propagation.
  [[nodiscard]] static double ratio_band(std::size_t draws);
};

// Throws UserError: fewer than kFewestDraws or more than kMostDraws draws, too many places for
// them, nothing uncertain, a statement that does not fit, runs that build_tables() refuses.
[[nodiscard]] TaskUncertainty uncertainty_of_task(const MachineFile& machine,
                                                  const std::vector<RunsFile>& runs,
                                                  const CampaignStatement& stated, const Task& task,
                                                  const WholeWaySettings& settings,
                                                  const Progress& progress);

}  // namespace volcomp::host
