#include "host_sim/host/measure/identify/observation.hpp"

#include <Eigen/Geometry>

namespace volcomp::host::identify {
namespace {

Vec3 vector_of(const std::vector<double>& local, std::size_t first) {
  return {local[first], local[first + 1], local[first + 2]};
}

// One observation: ideal and actual geometry, and the readings made from them.
class Observation {
 public:
  Observation(const Problem& problem, const SetUp& setup, const Circumstances& at)
      : problem_(problem),
        chain_(problem.machine.chain),
        setup_(setup),
        at_(at),
        ideal_(ideal_geometry(chain_, at.q)),
        actual_(actual_tips(chain_, at.q, at.errors)),
        point_(at.tip + at.tip_correction),
        longer_(1.0 + at.kappa) {}

  std::vector<Reading> readings() {
    switch (setup_.kind) {
      case ObservationKind::tracer:
        return {tracer()};
      case ObservationKind::bar:
        return {bar()};
      case ObservationKind::diagonal:
        return {diagonal()};
      case ObservationKind::step:
        return {step()};
      case ObservationKind::centre:
        return centre();
      case ObservationKind::touch:
        return {touch()};
      case ObservationKind::rtest:
        return rtest();
      case ObservationKind::runs:
        break;
    }
    return runs();
  }

 private:
  // By what an error of a joint moves an ideal point, given in the work frame.
  [[nodiscard]] ErrorEffect moves(std::size_t axis, const Vec3& in_work) const {
    return ideal_.work.R.transpose() * point_effect(ideal_, axis, ideal_.work.apply(in_work));
  }

  // A reading that grows with the way of the tip along `direction`, work frame.
  [[nodiscard]] Reading along(const Vec3& direction) const {
    Reading r;
    const Vec3 tip = ideal_.in_work(point_);
    for (std::size_t a = 0; a < chain_.axis_count(); ++a)
      r.by_error.at(a) = direction.transpose() * moves(a, tip);
    r.by_tip = direction.transpose() * ideal_.tool_in_work();
    return r;
  }

  // The same of the tool alone, in base: a station on the bed does not see what carries the work.
  [[nodiscard]] Reading along_in_bed(const Vec3& direction) const {
    Reading r;
    const Vec3 tip = ideal_.tool.apply(point_);
    for (std::size_t a = 0; a < chain_.axis_count(); ++a) {
      r.by_error.at(a).setZero();
      if (ideal_.side.at(a) > 0.0)
        r.by_error.at(a) = direction.transpose() * point_effect(ideal_, a, tip);
    }
    r.by_tip = direction.transpose() * ideal_.tool.R;
    return r;
  }

  Reading tracer() const {
    const Vec3 station = vector_of(at_.local, 0);
    const Vec3 tip = setup_.in_bed ? actual_.tool.apply(point_) : actual_.in_work(point_);
    const Vec3 away = tip - station;
    const Vec3 direction = longer_ * away.normalized();
    Reading r = setup_.in_bed ? along_in_bed(direction) : along(direction);
    r.y = longer_ * away.norm() + at_.local[3];
    r.by_local.resize(4);
    r.by_local << -direction.transpose(), 1.0;
    r.by_kappa = away.norm();
    return r;
  }

  Reading bar() const {
    const std::array<Vec3, 2> plane = across(setup_.normal);
    const Vec3 socket = *setup_.station + at_.local[0] * plane[0] + at_.local[1] * plane[1];
    const Vec3 away = actual_.in_work(point_) - socket;
    const Vec3 direction = longer_ * away.normalized();
    Reading r = along(direction);
    r.y = longer_ * away.norm() - setup_.length + at_.local[2];
    r.by_local.resize(3);
    r.by_local << -direction.dot(plane[0]), -direction.dot(plane[1]), 1.0;
    r.by_kappa = away.norm();
    return r;
  }

  Reading diagonal() const {
    const Vec3& u = *setup_.along;
    Reading r = along(longer_ * u);
    const double way = u.dot(actual_.in_work(point_));
    r.y = longer_ * way + at_.local[0];
    r.by_local.resize(1);
    r.by_local << 1.0;
    r.by_kappa = way;
    return r;
  }

  // A plane mirror turns with the tool: its normal and so the length of the beam do, too.
  Reading step() const {
    const Vec3& u = *setup_.along;
    const std::array<Vec3, 2> tilt = across(*setup_.mirror);
    const Vec3 normal =
        exponential(at_.local[0] * tilt[0] + at_.local[1] * tilt[1]) * *setup_.mirror;
    const Vec3 m = actual_.work.R.transpose() * actual_.tool.R * normal;
    const Vec3 away = actual_.in_work(point_) - *setup_.beam;
    const double mu = m.dot(u);
    const Vec3 h = away - u * (m.dot(away) / mu);
    Reading r = along(longer_ / mu * m);
    const Vec3 turn = longer_ / mu * m.cross(h);
    for (std::size_t a = 0; a < chain_.axis_count(); ++a)
      r.by_error.at(a) += turn.transpose() * (ideal_.work.R.transpose() * turn_effect(ideal_, a));
    r.y = longer_ * m.dot(away) / mu + at_.local[2];
    r.by_local.resize(3);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Vec3 tilted =
          ideal_.tool_in_work() * tilt.at(static_cast<std::size_t>(i)).cross(normal);
      r.by_local(i) = longer_ / mu * tilted.dot(h);
    }
    r.by_local(2) = 1.0;
    r.by_kappa = m.dot(away) / mu;
    return r;
  }

  // Centre of the sphere where its placement says, without the turn.
  [[nodiscard]] Vec3 turned_sphere() const {
    return longer_ * (at_.placement.R * (at_.sphere + at_.sphere_correction));
  }

  // Measurement adds the error: measured + E = true place.
  std::vector<Reading> centre() const {
    const Vec3 error = actual_.in_work(point_) - ideal_.in_work(at_.tip);
    const Vec3 turned = turned_sphere();
    const Vec3 y = turned + at_.placement.t - error;
    const Mat3 turn = -cross_matrix(turned);
    std::vector<Reading> out;
    for (Eigen::Index k = 0; k < 3; ++k) {
      Reading r = along(-Vec3::Unit(k));
      r.y = y(k);
      r.by_local.resize(6);
      r.by_local << turn.row(k), Row3::Unit(k);
      r.by_sphere = longer_ * at_.placement.R.row(k);
      r.by_kappa = turned(k) / longer_;
      out.push_back(r);
    }
    return out;
  }

  Reading touch() const {
    const Vec3 turned = turned_sphere();
    const Vec3 away = actual_.in_work(point_) - turned - at_.placement.t;
    const Vec3 n = away.normalized();
    Reading r = along(n);
    r.y = away.norm() - at_.sphere_radius - at_.tip_radius;
    r.by_local.resize(6);
    r.by_local << n.transpose() * cross_matrix(turned), -n.transpose();
    r.by_sphere = -longer_ * (n.transpose() * at_.placement.R);
    r.by_kappa = -n.dot(turned) / longer_;
    r.by_tip_radius = -1.0;
    return r;
  }

  std::vector<Reading> rtest() const {
    const Vec3 sphere = vector_of(at_.local, 0);
    const Vec3 y = actual_.tool.apply_inverse(actual_.work.apply(sphere)) - point_;
    const Mat3 back = ideal_.tool_in_work().transpose();
    std::vector<Reading> out(3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      Reading& r = out[static_cast<std::size_t>(k)];
      r.y = y(k);
      for (std::size_t a = 0; a < chain_.axis_count(); ++a)
        r.by_error.at(a) = -back.row(k) * moves(a, sphere);
      r.by_local.resize(3);
      r.by_local << back.row(k);
      r.by_tip = -Row3::Unit(k);
    }
    return out;
  }

  std::vector<Reading> runs() const {
    const Axis along = chain_.axis(setup_.axis).axis;
    const double q = at_.q.at(setup_.axis);
    const Vec3 lever = setup_.lever + setup_.kappa * q * unit_vector(along);
    Eigen::Matrix<double, 6, 6> seen = Eigen::Matrix<double, 6, 6>::Identity();
    seen.topRightCorner<3, 3>() = -cross_matrix(lever);
    const ErrorMotion value = seen * at_.errors.at(setup_.axis);
    const std::vector<std::size_t> sloped = sloped_channels(problem_, setup_);
    const double from_reference = q - problem_.machine.travel.at(setup_.axis).reference;
    std::vector<Reading> out(setup_.channels.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      Reading& r = out[k];
      const auto channel = static_cast<Eigen::Index>(setup_.channels[k]);
      for (auto& row : r.by_error)
        row.setZero();
      r.by_error.at(setup_.axis) = seen.row(channel);
      r.by_local = LocalRow::Zero(static_cast<Eigen::Index>(at_.local.size()));
      r.by_local(static_cast<Eigen::Index>(k)) = 1.0;
      for (std::size_t s = 0; s < sloped.size(); ++s)
        if (sloped[s] == k) r.by_local(static_cast<Eigen::Index>(out.size() + s)) = from_reference;
      r.y = value(channel);
      for (std::size_t i = 0; i < at_.local.size(); ++i)
        r.y += r.by_local(static_cast<Eigen::Index>(i)) * at_.local[i];
    }
    return out;
  }

  const Problem& problem_;
  const MachineChain& chain_;
  const SetUp& setup_;
  const Circumstances& at_;
  ChainGeometry ideal_;
  TipFrames actual_;
  Vec3 point_;
  double longer_;
};

}  // namespace

std::vector<Reading> reading_of(const Problem& problem, const SetUp& setup,
                                const Circumstances& at) {
  return Observation(problem, setup, at).readings();
}

}  // namespace volcomp::host::identify
