#include "host_sim/host/measure/identify/triangle.hpp"

#include <algorithm>

#include <Eigen/QR>

namespace volcomp::host::identify {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Room for some times as many rows as unknowns: each fold carries the triangle along.
Triangle::Triangle(Index unknowns)
    : block_(MatrixXd::Zero(4 * unknowns + 64, unknowns + 1)),
      R_(MatrixXd::Zero(unknowns, unknowns)),
      z_(VectorXd::Zero(unknowns)) {}

void Triangle::add(const VectorXd& row, double residual) {
  if (filled_ == block_.rows()) fold();
  block_.row(filled_).head(R_.cols()) = row.transpose();
  block_(filled_, R_.cols()) = residual;
  ++filled_;
  ++rows_;
}

void Triangle::fold() {
  const Index n = R_.cols();
  Eigen::Block<MatrixXd> rows = block_.topRows(filled_);
  const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> in_place(rows);
  rows.triangularView<Eigen::StrictlyLower>().setZero();
  filled_ = std::min(filled_, n);
  // What no unknown can change goes: the row below the triangle holds the residual alone.
  block_.bottomRows(block_.rows() - filled_).setZero();
}

void Triangle::finish() {
  fold();
  const Index n = R_.cols();
  R_ = block_.topLeftCorner(n, n).triangularView<Eigen::Upper>();
  z_ = block_.col(n).head(n);
  block_.resize(0, 0);
}

VectorXd Triangle::column_norms() const {
  VectorXd norms = R_.colwise().norm().transpose();
  for (Index j = 0; j < norms.size(); ++j)
    if (!(norms(j) > 0.0)) norms(j) = 1.0;
  return norms;
}

// With columns of unit length: they span eight decades.
VectorXd Triangle::solve() const {
  const VectorXd norms = column_norms();
  const MatrixXd scaled = R_ * norms.cwiseInverse().asDiagonal();
  return scaled.triangularView<Eigen::Upper>().solve(z_).cwiseQuotient(norms);
}

VectorXd Triangle::reduced(const VectorXd& function) const {
  return R_.transpose().triangularView<Eigen::Lower>().solve(function);
}

double Triangle::uncertainty(const VectorXd& function) const { return reduced(function).norm(); }

}  // namespace volcomp::host::identify
