#pragma once
// The equations of a problem at an estimate: a row of the unknowns and what is left, both over the
// standard uncertainty, for every reading and for everything known beforehand.

#include <functional>
#include <vector>

#include "host_sim/host/measure/identify/observation.hpp"
#include "host_sim/host/measure/identify/unknowns.hpp"

namespace volcomp::host::identify {

struct Estimate {
  VectorXd x;                        // turns and ways of placements stay 0 here
  std::vector<Placement> placement;  // by set-up
};

// Which component of which reading.
struct ReadingPlace {
  std::size_t setup = 0;
  std::size_t observation = 0;
  std::size_t component = 0;
};

// What is known beforehand and counts.
struct KnownBefore {
  bool places = true;  // places and radii of styli, places of stations
  bool weak = false;   // so much of everything that every part of a plan can be solved
};

class Equations {
 public:
  // The problem outlives it.
  Equations(const Problem& problem, bool gauge) : problem_(problem), unknowns_(problem, gauge) {}

  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] const Unknowns& unknowns() const { return unknowns_; }

  // Functions 0, placements by plan or by the rigid fit of what was measured, the rest by the mean
  // of what it is added to; then what each set-up has for itself, alone.
  [[nodiscard]] Estimate start() const;
  // Without readings: placements and stations of the plan, coordinates moved so that an ideal
  // machine finds every sphere exactly.
  [[nodiscard]] static Problem made_consistent(const Problem& problem);

  using VisitReading =
      std::function<void(const ReadingPlace& at, const VectorXd& row, double residual)>;
  void visit_readings(const Estimate& e, const VisitReading& visit) const;
  // Those of one set-up.
  void visit_setup(std::size_t setup, const Estimate& e, const VisitReading& visit) const;

  using VisitKnown = std::function<void(const VectorXd& row, double residual)>;
  void visit_known(const Estimate& e, const KnownBefore& which, const VisitKnown& visit) const;

  // Estimate moved by a step of all unknowns.
  void move(const VectorXd& step, Estimate& e) const;

 private:
  [[nodiscard]] Circumstances circumstances(std::size_t setup, std::size_t i,
                                            const Estimate& e) const;
  [[nodiscard]] VectorXd row_of(std::size_t setup, std::size_t i, const Reading& reading,
                                const Circumstances& at) const;
  void start_setup(std::size_t setup, Estimate& e) const;
  void settle_setup(std::size_t setup, Estimate& e) const;
  void visit_styli(const Estimate& e, const VisitKnown& visit) const;
  void visit_artefacts(const Estimate& e, const VisitKnown& visit) const;
  void visit_lengths(std::size_t artefact, const Estimate& e, const VisitKnown& visit) const;
  void visit_weak(const Estimate& e, const VisitKnown& visit) const;

  const Problem& problem_;
  Unknowns unknowns_;
};

}  // namespace volcomp::host::identify
