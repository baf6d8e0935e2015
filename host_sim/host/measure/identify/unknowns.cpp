#include "host_sim/host/measure/identify/unknowns.hpp"

#include <algorithm>
#include <cmath>

#include "comp/machine/frame.hpp"

namespace volcomp::host::identify {
namespace {

bool contains(const Channels& channels, std::size_t channel) {
  return std::find(channels.begin(), channels.end(), channel) != channels.end();
}

// Ideal rotation of a rotary axis; acts on both halves.
Mat3 turned_by(const Problem& problem, std::size_t axis, double q) {
  return joint_motion(problem.machine.chain.axis(axis), q).R;
}

// Eliminates ρ x = 0 from the columns of T: each less its part along the pivot's, which goes.
void eliminate_row(const VectorXd& constraint, MatrixXd& T) {
  const VectorXd r = T.transpose() * constraint;
  Index pivot = 0;
  if (!(r.cwiseAbs().maxCoeff(&pivot) > 0.0)) return;
  const VectorXd gone = T.col(pivot);
  MatrixXd kept(T.rows(), T.cols() - 1);
  Index out = 0;
  for (Index j = 0; j < T.cols(); ++j)
    if (j != pivot) kept.col(out++) = T.col(j) - gone * (r(j) / r(pivot));
  T = std::move(kept);
}

}  // namespace

Unknowns::Unknowns(const Problem& problem, bool gauge) : problem_(problem) {
  count_functions();
  eliminate(gauge);
  count_single_values();
  count_shared();
  count_setups();
}

void Unknowns::take(std::size_t count, bool angle) {
  size_ += static_cast<Index>(count);
  angle_.resize(angle_.size() + count, angle);
}

std::string Unknowns::name(const Quantity& quantity) const {
  const std::string channel = kChannelNames.at(quantity.channel);
  const std::string axis = problem_.machine.name_of(quantity.axis);
  switch (quantity.kind) {
    case QuantityKind::reversal:
      return "rev " + channel + axis;
    case QuantityKind::location:
      return channel + "0" + axis;
    case QuantityKind::constant:
      return channel + "1" + axis;
    case QuantityKind::function:
      break;
  }
  return channel + axis;
}

void Unknowns::count_functions() {
  for (std::size_t a = 0; a < problem_.machine.chain.axis_count(); ++a) {
    const AxisFunctions& f = problem_.model.functions.at(a);
    const Travel& travel = problem_.machine.travel.at(a);
    if (f.segments == 0) continue;
    for (std::size_t c = 0; c < 6; ++c) {
      if (!contains(f.channels, c)) continue;
      const FunctionBasis basis(travel.lo, travel.hi, travel.periodic, f.segments);
      function_.at(a).at(c) = Function{basis, coefficients_};
      coefficients_ += basis.size();
      Quantity quantity{QuantityKind::function, a, c, {}};
      quantity.name = name(quantity);
      quantities_.push_back(quantity);
    }
  }
}

// A rotary axis holds no mean on the fixed side: that is where it is (ISO 230-7), and would be tied
// to its location. One row for each channel across its axis.
void Unknowns::constrain_axis(std::size_t axis, std::vector<VectorXd>& rows) const {
  const std::size_t own = index(problem_.machine.chain.axis(axis).axis);
  for (std::size_t half = 0; half < 6; half += 3) {
    for (std::size_t fixed = 0; fixed < 3; ++fixed) {
      if (fixed == own || !function_.at(axis).at(half + fixed)) continue;
      VectorXd row = VectorXd::Zero(static_cast<Index>(coefficients_));
      for (std::size_t moving = 0; moving < 3; ++moving) {
        const auto& f = function_.at(axis).at(half + moving);
        if (!f || moving == own) continue;
        for (const double q : f->basis.samples()) {
          const Mat3 J = turned_by(problem_, axis, q);
          const double turned = J(static_cast<Index>(fixed), static_cast<Index>(moving));
          for (const BasisPiece& piece : f->basis.at(q))
            row(static_cast<Index>(f->first + piece.coefficient)) += turned * piece.value;
        }
      }
      rows.push_back(row);
    }
  }
}

std::vector<VectorXd> Unknowns::constraints(bool gauge) const {
  std::vector<VectorXd> rows;
  const auto empty = [&] { return VectorXd(VectorXd::Zero(static_cast<Index>(coefficients_))); };
  for (const Quantity& quantity : quantities_) {
    const Function& f = *function_.at(quantity.axis).at(quantity.channel);
    VectorXd row = empty();
    for (const BasisPiece& piece : f.basis.at(problem_.machine.travel.at(quantity.axis).reference))
      row(static_cast<Index>(f.first + piece.coefficient)) += piece.value;
    rows.push_back(row);
  }
  for (std::size_t a = 0; a < problem_.machine.chain.axis_count(); ++a)
    if (!problem_.is_slide(a)) constrain_axis(a, rows);
  if (!gauge) return rows;
  for (const GaugeRow& g : problem_.model.gauge) {
    const auto& f = function_.at(g.axis).at(g.channel);
    if (!f) continue;
    VectorXd row = empty();
    const std::vector<double> samples = f->basis.samples();
    const std::vector<double> weight = f->basis.slope_weights();
    for (std::size_t k = 0; k < samples.size(); ++k)
      for (const BasisPiece& piece : f->basis.at(samples[k]))
        row(static_cast<Index>(f->first + piece.coefficient)) += weight[k] * piece.value;
    rows.push_back(row);
  }
  return rows;
}

void Unknowns::eliminate(bool gauge) {
  const auto count = static_cast<Index>(coefficients_);
  MatrixXd T = MatrixXd::Identity(count, count);
  for (const VectorXd& row : constraints(gauge))
    eliminate_row(row, T);
  coefficient_.assign(coefficients_, {});
  std::vector<bool> angular(coefficients_, false);
  for (const Quantity& quantity : quantities_) {
    const Function& f = *function_.at(quantity.axis).at(quantity.channel);
    for (std::size_t m = 0; m < f.basis.size(); ++m)
      angular[f.first + m] = quantity.angular();
  }
  for (Index j = 0; j < T.cols(); ++j) {
    Index largest = 0;
    T.col(j).cwiseAbs().maxCoeff(&largest);
    take(1, angular[static_cast<std::size_t>(largest)]);
    for (Index i = 0; i < count; ++i)
      if (std::abs(T(i, j)) > 0.0)
        coefficient_[static_cast<std::size_t>(i)].push_back({j, T(i, j)});
  }
}

void Unknowns::add_single(QuantityKind kind, std::size_t axis, std::size_t channel) {
  auto& where = kind == QuantityKind::reversal   ? reversal_
                : kind == QuantityKind::location ? location_
                                                 : constant_;
  where.at(axis).at(channel) = size_;
  take(1, channel >= 3);
  Quantity quantity{kind, axis, channel, {}};
  quantity.name = name(quantity);
  quantities_.push_back(quantity);
}

void Unknowns::count_single_values() {
  const ErrorModel& model = problem_.model;
  const std::size_t axes = problem_.machine.chain.axis_count();
  for (std::size_t a = 0; a < axes; ++a)
    for (const std::size_t c : model.functions.at(a).reversal)
      add_single(QuantityKind::reversal, a, c);
  for (std::size_t a = 0; a < axes; ++a)
    for (const std::size_t c : model.location.at(a))
      add_single(QuantityKind::location, a, c);
  for (std::size_t a = 0; a < axes; ++a)
    for (const std::size_t c : model.constant.at(a))
      add_single(QuantityKind::constant, a, c);
  of_machine_ = size_;
}

void Unknowns::count_shared() {
  const auto add = [&](const Prior& prior, std::size_t count) {
    const Index at = size_;
    if (!prior) return std::optional<Index>{};
    take(count, false);
    return std::optional<Index>{at};
  };
  for (const Stylus& s : problem_.styli) {
    stylus_.push_back(add(s.place, 3));
    radius_.push_back(add(s.radius_prior, 1));
  }
  for (const Artefact& a : problem_.artefacts) {
    spheres_.push_back(add(a.place, 3 * a.spheres.size()));
    scale_.push_back(add(a.scale, 1));
  }
}

void Unknowns::count_setups() {
  for (const SetUp& s : problem_.setups) {
    local_.push_back(size_);
    const std::size_t count = local_count(problem_, s);
    // The first unknowns of these kinds are angles: turns of a placement, tilts of a mirror.
    const std::size_t angles = s.has_pose() ? 3 : s.kind == ObservationKind::step ? 2 : 0;
    take(angles, true);
    take(count - angles, false);
    const Index at = size_;
    setup_scale_.push_back(s.scale ? std::optional<Index>{at} : std::nullopt);
    if (s.scale) take(1, true);
    auto& growth = setup_growth_.emplace_back();
    for (std::size_t a = 0; s.growth && a < problem_.machine.chain.axis_count(); ++a) {
      if (!problem_.is_slide(a)) continue;
      growth.at(a) = size_;
      take(1, true);
    }
  }
}

void Unknowns::add_coefficients(const BasisPieces& pieces, const Function& f, double weight,
                                VectorXd& row) const {
  for (const BasisPiece& piece : pieces)
    for (const Term& term : coefficient_[f.first + piece.coefficient])
      row(term.unknown) += weight * piece.value * term.factor;
}

void Unknowns::add_errors(std::size_t axis, double q, double d, const Row6& weight,
                          VectorXd& row) const {
  Row6 fixed = weight;
  if (!problem_.model.location.at(axis).empty()) {
    const Mat3 J = turned_by(problem_, axis, q);
    fixed.head<3>() = weight.head<3>() * J.transpose();
    fixed.tail<3>() = weight.tail<3>() * J.transpose();
  }
  for (std::size_t c = 0; c < 6; ++c) {
    const auto at = static_cast<Index>(c);
    if (const auto& f = function_.at(axis).at(c))
      add_coefficients(f->basis.at(q), *f, weight(at), row);
    if (const auto& b = reversal_.at(axis).at(c)) row(*b) += 0.5 * d * weight(at);
    if (const auto& l = location_.at(axis).at(c)) row(*l) += fixed(at);
    if (const auto& k = constant_.at(axis).at(c)) row(*k) += weight(at);
  }
}

ErrorMotion Unknowns::error(std::size_t axis, double q, double d, const VectorXd& x) const {
  ErrorMotion e = ErrorMotion::Zero();
  ErrorMotion fixed = ErrorMotion::Zero();
  for (std::size_t c = 0; c < 6; ++c) {
    double& value = e(static_cast<Index>(c));
    if (const auto& f = function_.at(axis).at(c))
      for (const BasisPiece& piece : f->basis.at(q))
        for (const Term& term : coefficient_[f->first + piece.coefficient])
          value += piece.value * term.factor * x(term.unknown);
    if (const auto& b = reversal_.at(axis).at(c)) value += 0.5 * d * x(*b);
    if (const auto& k = constant_.at(axis).at(c)) value += x(*k);
    if (const auto& l = location_.at(axis).at(c)) fixed(static_cast<Index>(c)) = x(*l);
  }
  if (problem_.model.location.at(axis).empty()) return e;
  const Mat3 back = turned_by(problem_, axis, q).transpose();
  e.head<3>() += back * fixed.head<3>();
  e.tail<3>() += back * fixed.tail<3>();
  return e;
}

ErrorSet Unknowns::errors(const Pose& q, const Directions& d, const VectorXd& x) const {
  ErrorSet set = zero_errors();
  for (std::size_t a = 0; a < problem_.machine.chain.axis_count(); ++a)
    set.at(a) = error(a, q.at(a), d.at(a), x);
  return set;
}

std::vector<double> Unknowns::places(const Quantity& quantity) const {
  if (quantity.kind != QuantityKind::function)
    return {problem_.machine.travel.at(quantity.axis).reference};
  return function_.at(quantity.axis).at(quantity.channel)->basis.samples();
}

VectorXd Unknowns::value_row(const Quantity& quantity, double place) const {
  VectorXd row = VectorXd::Zero(size_);
  const auto single = [&](const auto& where) {
    row(*where.at(quantity.axis).at(quantity.channel)) = 1.0;
  };
  switch (quantity.kind) {
    case QuantityKind::function: {
      const Function& f = *function_.at(quantity.axis).at(quantity.channel);
      add_coefficients(f.basis.at(place), f, 1.0, row);
      break;
    }
    case QuantityKind::reversal:
      single(reversal_);
      break;
    case QuantityKind::location:
      single(location_);
      break;
    case QuantityKind::constant:
      single(constant_);
      break;
  }
  return row;
}

std::vector<VectorXd> Unknowns::curvature_rows() const {
  std::vector<VectorXd> rows;
  const auto& curvature = problem_.model.curvature;
  if (!curvature) return rows;
  for (const Quantity& quantity : quantities_) {
    if (quantity.kind != QuantityKind::function) continue;
    const Function& f = *function_.at(quantity.axis).at(quantity.channel);
    const double sigma = quantity.angular() ? curvature->rad : curvature->mm;
    for (std::size_t k = 0; k < f.basis.segments(); ++k) {
      rows.emplace_back(VectorXd::Zero(size_));
      add_coefficients(f.basis.curvature(k), f, 1.0 / sigma, rows.back());
    }
  }
  return rows;
}

std::vector<VectorXd> Unknowns::coefficient_rows(double mm, double rad) const {
  std::vector<VectorXd> rows;
  for (const Quantity& quantity : quantities_) {
    if (quantity.kind != QuantityKind::function) continue;
    const Function& f = *function_.at(quantity.axis).at(quantity.channel);
    for (std::size_t m = 0; m < f.basis.size(); ++m) {
      rows.emplace_back(VectorXd::Zero(size_));
      for (const Term& term : coefficient_[f.first + m])
        rows.back()(term.unknown) = term.factor / (quantity.angular() ? rad : mm);
    }
  }
  return rows;
}

}  // namespace volcomp::host::identify
