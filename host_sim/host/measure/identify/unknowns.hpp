#pragma once
// The unknowns of a problem as one vector: error functions, reversals, locations and constants of
// rotary axes; styli and artefacts; what each set-up has for itself. What holds exactly (functions
// are 0 at their reference, hold no mean on the fixed side, and the gauge) is eliminated, never a
// heavy row.

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "host_sim/host/measure/identify/error_function.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Row6 = Eigen::Matrix<double, 1, 6>;

// What the values of a problem are reported as.
enum class QuantityKind : std::uint8_t { function, reversal, location, constant };

// Of the machine: a function by its channel, or a single value.
struct Quantity {
  QuantityKind kind = QuantityKind::function;
  std::size_t axis = 0;
  std::size_t channel = 0;
  std::string name;  // EXX, "rev EXX", EX0C, EX1B

  [[nodiscard]] bool angular() const { return channel >= 3; }
};

class Unknowns {
 public:
  // `gauge`: whether the gauge rows of the model are eliminated, too. The problem outlives it.
  Unknowns(const Problem& problem, bool gauge);

  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] Index size() const { return size_; }
  // Those of the machine come first: functions, reversals, locations, constants.
  [[nodiscard]] Index of_machine() const { return of_machine_; }
  // Where they begin; none where there are none.
  [[nodiscard]] std::optional<Index> stylus(std::size_t s) const { return stylus_[s]; }
  [[nodiscard]] std::optional<Index> stylus_radius(std::size_t s) const { return radius_[s]; }
  [[nodiscard]] std::optional<Index> spheres(std::size_t artefact) const {
    return spheres_[artefact];
  }
  [[nodiscard]] std::optional<Index> artefact_scale(std::size_t a) const { return scale_[a]; }
  [[nodiscard]] Index local(std::size_t setup) const { return local_[setup]; }
  [[nodiscard]] std::optional<Index> setup_scale(std::size_t setup) const {
    return setup_scale_[setup];
  }
  // How much a linear axis has grown at that set-up, relative.
  [[nodiscard]] std::optional<Index> setup_growth(std::size_t setup, std::size_t axis) const {
    return setup_growth_[setup].at(axis);
  }
  // Whether a step of an unknown is an angle, of which 300 mm count.
  [[nodiscard]] bool is_angle(Index i) const { return angle_[static_cast<std::size_t>(i)]; }

  // Errors of an axis, body and moving side, with these unknowns.
  [[nodiscard]] ErrorMotion error(std::size_t axis, double q, double d, const VectorXd& x) const;
  [[nodiscard]] ErrorSet errors(const Pose& q, const Directions& d, const VectorXd& x) const;
  // row += de_dx of the six errors of an axis, each times its weight.
  void add_errors(std::size_t axis, double q, double d, const Row6& weight, VectorXd& row) const;

  [[nodiscard]] const std::vector<Quantity>& quantities() const { return quantities_; }
  // Places where a quantity is reported: samples of a function, one of the others.
  [[nodiscard]] std::vector<double> places(const Quantity& quantity) const;
  // Row of its value there.
  [[nodiscard]] VectorXd value_row(const Quantity& quantity, double place) const;

  // One row a segment of every function: curvature over its σ.
  [[nodiscard]] std::vector<VectorXd> curvature_rows() const;
  // One row a coefficient before elimination, over its σ, mm or rad.
  [[nodiscard]] std::vector<VectorXd> coefficient_rows(double mm, double rad) const;

 private:
  struct Term {
    Index unknown;
    double factor;
  };
  struct Function {
    FunctionBasis basis;
    std::size_t first;  // of its coefficients before elimination
  };

  void count_functions();
  void eliminate(bool gauge);
  [[nodiscard]] std::vector<VectorXd> constraints(bool gauge) const;
  void constrain_axis(std::size_t axis, std::vector<VectorXd>& rows) const;
  void count_single_values();
  void count_shared();
  void count_setups();
  void take(std::size_t count, bool angle);
  void add_coefficients(const BasisPieces& pieces, const Function& f, double weight,
                        VectorXd& row) const;
  [[nodiscard]] std::string name(const Quantity& quantity) const;
  void add_single(QuantityKind kind, std::size_t axis, std::size_t channel);

  const Problem& problem_;
  std::array<std::array<std::optional<Function>, 6>, kMaxAxes> function_;
  std::array<std::array<std::optional<Index>, 6>, kMaxAxes> reversal_, location_, constant_;
  std::size_t coefficients_ = 0;
  std::vector<std::vector<Term>> coefficient_;  // each in terms of the unknowns
  std::vector<std::optional<Index>> stylus_, radius_, spheres_, scale_, setup_scale_;
  std::vector<std::array<std::optional<Index>, kMaxAxes>> setup_growth_;
  std::vector<Index> local_;
  std::vector<bool> angle_;
  std::vector<Quantity> quantities_;
  Index size_ = 0;
  Index of_machine_ = 0;
};

}  // namespace volcomp::host::identify
