#include "host_sim/host/measure/identify/rank.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include "host_sim/host/measure/identify/solution.hpp"

namespace volcomp::host::identify {
namespace {

// Value rows of all quantities, mm over 1e-3 and rad over 1e-5, functions over the root of the
// number of their samples; and which quantity a row belongs to.
struct ValueRows {
  MatrixXd F;
  std::vector<std::size_t> quantity;
};

ValueRows value_rows(const Unknowns& unknowns) {
  constexpr double kUnit_mm = 1e-3;
  constexpr double kUnit_rad = 1e-5;
  ValueRows rows;
  std::vector<VectorXd> list;
  for (std::size_t g = 0; g < unknowns.quantities().size(); ++g) {
    const Quantity& quantity = unknowns.quantities()[g];
    const std::vector<double> places = unknowns.places(quantity);
    const double unit =
        (quantity.angular() ? kUnit_rad : kUnit_mm) * std::sqrt(static_cast<double>(places.size()));
    for (const double place : places) {
      list.emplace_back(unknowns.value_row(quantity, place) / unit);
      rows.quantity.push_back(g);
    }
  }
  rows.F.resize(static_cast<Index>(list.size()), unknowns.size());
  for (std::size_t i = 0; i < list.size(); ++i)
    rows.F.row(static_cast<Index>(i)) = list[i].transpose();
  return rows;
}

// Null space in the units of the unknowns, each vector with a largest entry of 1.
MatrixXd null_space(const Triangle& triangle, PlanRank& out) {
  const VectorXd norms = triangle.column_norms();
  const MatrixXd scaled = triangle.R() * norms.cwiseInverse().asDiagonal();
  const Eigen::BDCSVD<MatrixXd> svd(scaled, Eigen::ComputeFullV);
  const VectorXd& s = svd.singularValues();
  Index rank = 0;
  while (rank < s.size() && s(rank) > kSingularShare * s(0))
    ++rank;
  out.rank = static_cast<std::size_t>(rank);
  out.nullity = out.unknowns - out.rank;
  out.least = s(s.size() - 1) / s(0);
  MatrixXd V =
      norms.cwiseInverse().asDiagonal() * svd.matrixV().rightCols(static_cast<Index>(out.nullity));
  for (Index j = 0; j < V.cols(); ++j)
    V.col(j) /= V.col(j).cwiseAbs().maxCoeff();
  return V;
}

// Left vectors of what the null space does to the machine.
MatrixXd unseen_directions(const MatrixXd& Z) {
  constexpr double kNuisanceOnly = 1e-3;
  constexpr double kIndependent = 1e-6;
  std::vector<Index> kept;
  for (Index j = 0; j < Z.cols(); ++j)
    if (Z.col(j).norm() >= kNuisanceOnly) kept.push_back(j);
  if (kept.empty()) return MatrixXd::Zero(Z.rows(), 0);
  MatrixXd normed(Z.rows(), static_cast<Index>(kept.size()));
  for (std::size_t j = 0; j < kept.size(); ++j)
    normed.col(static_cast<Index>(j)) = Z.col(kept[j]).normalized();
  const Eigen::BDCSVD<MatrixXd> svd(normed, Eigen::ComputeThinU);
  const VectorXd& s = svd.singularValues();
  Index count = 0;
  while (count < s.size() && s(count) > kIndependent * s(0))
    ++count;
  return svd.matrixU().leftCols(count);
}

std::vector<MatrixXd> by_quantity(const MatrixXd& U, const ValueRows& rows, std::size_t count) {
  std::vector<MatrixXd> parts(count);
  for (std::size_t g = 0; g < count; ++g) {
    std::vector<Index> mine;
    for (std::size_t i = 0; i < rows.quantity.size(); ++i)
      if (rows.quantity[i] == g) mine.push_back(static_cast<Index>(i));
    parts[g].resize(static_cast<Index>(mine.size()), U.cols());
    for (std::size_t i = 0; i < mine.size(); ++i)
      parts[g].row(static_cast<Index>(i)) = U.row(mine[i]);
  }
  return parts;
}

// Connected parts of the graph of quantities that move together.
std::vector<std::vector<std::string>> connected(const std::vector<MatrixXd>& part,
                                                const std::vector<std::string>& name,
                                                const std::vector<std::size_t>& unseen) {
  constexpr double kTogether = 0.01;
  std::vector<std::size_t> group(unseen.size());
  for (std::size_t i = 0; i < group.size(); ++i)
    group[i] = i;
  for (std::size_t i = 0; i < unseen.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const MatrixXd& a = part[unseen[i]];
      const MatrixXd& b = part[unseen[j]];
      if (!((a * b.transpose()).norm() > kTogether * a.norm() * b.norm())) continue;
      const std::size_t from = group[i];
      for (std::size_t& g : group)
        if (g == from) g = group[j];
    }
  }
  std::vector<std::vector<std::string>> out;
  for (std::size_t g = 0; g < unseen.size(); ++g) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < unseen.size(); ++i)
      if (group[i] == g) names.push_back(name[unseen[i]]);
    std::sort(names.begin(), names.end());
    if (!names.empty()) out.push_back(names);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

PlanRank rank_of(const Problem& problem) {
  constexpr double kSeen = 1e-4;
  const Problem consistent = Equations::made_consistent(problem);
  const Equations equations(consistent, false);
  const Unknowns& unknowns = equations.unknowns();
  KnownBefore known;
  known.places = false;
  const Triangle triangle = triangle_at(equations, equations.start(), known);
  PlanRank out;
  out.unknowns = static_cast<std::size_t>(unknowns.size());
  const MatrixXd V = null_space(triangle, out);
  if (out.nullity == 0) return out;
  const ValueRows rows = value_rows(unknowns);
  const MatrixXd U = unseen_directions(rows.F * V);
  out.nullity_functions = static_cast<std::size_t>(U.cols());
  const std::vector<MatrixXd> part = by_quantity(U, rows, unknowns.quantities().size());
  std::vector<std::string> name;
  std::vector<std::size_t> unseen;
  for (std::size_t g = 0; g < part.size(); ++g) {
    name.push_back(unknowns.quantities()[g].name);
    if (!(part[g].squaredNorm() > kSeen)) continue;
    unseen.push_back(g);
    out.unseen.push_back(name.back());
  }
  std::sort(out.unseen.begin(), out.unseen.end());
  out.together = connected(part, name, unseen);
  return out;
}

double least_singular(const Problem& problem) {
  const Equations equations(problem, true);
  const Triangle triangle = triangle_at(equations, equations.start(), {});
  PlanRank out;
  out.unknowns = static_cast<std::size_t>(equations.unknowns().size());
  null_space(triangle, out);
  return out.least;
}

}  // namespace volcomp::host::identify
