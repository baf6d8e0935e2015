#pragma once
// Least squares by orthogonal triangularisation of rows that come one after the other: memory is
// that of the unknowns squared, whatever the number of rows.

#include <Eigen/Core>

namespace volcomp::host::identify {

class Triangle {
 public:
  explicit Triangle(Eigen::Index unknowns);

  void add(const Eigen::VectorXd& row, double residual);
  // All rows in, no more after it; R is upper triangular, JᵀJ = RᵀR.
  void finish();

  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  [[nodiscard]] const Eigen::MatrixXd& R() const { return R_; }
  // Norm of each column of J; 1 where it is 0.
  [[nodiscard]] Eigen::VectorXd column_norms() const;
  // Step of least squares.
  [[nodiscard]] Eigen::VectorXd solve() const;
  // Standard uncertainty of a linear function of the unknowns.
  [[nodiscard]] double uncertainty(const Eigen::VectorXd& function) const;
  // function R⁻¹.
  [[nodiscard]] Eigen::VectorXd reduced(const Eigen::VectorXd& function) const;

 private:
  void fold();

  Eigen::Index rows_ = 0;
  Eigen::Index filled_ = 0;
  Eigen::MatrixXd block_;  // what is triangular, rows below it, the residuals as last column
  Eigen::MatrixXd R_;
  Eigen::VectorXd z_;
};

}  // namespace volcomp::host::identify
