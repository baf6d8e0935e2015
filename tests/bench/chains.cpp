#include "tests/bench/chains.hpp"

#include <cstddef>

// What comp goes without for its boards.
#undef EIGEN_DONT_VECTORIZE
#include <Eigen/Core>

#ifdef VOLCOMP_BENCH_KDL
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/frames.hpp>
#endif

namespace volcomp::bench {
namespace {

constexpr std::size_t kJoints = 6;

// Small turns about all axes and a way along one of them.
template <class Number>
std::array<Eigen::Matrix<Number, 4, 4>, kJoints> joint_matrices() {
  std::array<Eigen::Matrix<Number, 4, 4>, kJoints> joints;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto e = Number(1e-5) * static_cast<Number>(k + 1);
    joints[k] << 1, -e, e, 100, e, 1, -e, 20, -e, e, 1, 3, 0, 0, 0, 1;
  }
  return joints;
}

template <class Number>
std::array<Number, 3> six_products(Number q) {
  static auto joints = joint_matrices<Number>();
  joints[0](0, 3) = q;
  static const Eigen::Matrix<Number, 4, 4> kTool = joint_matrices<Number>()[0];
  Eigen::Matrix<Number, 4, 4> T;
  Eigen::Matrix<Number, 4, 4> next;
  T.noalias() = kTool * joints[0];
  for (std::size_t k = 1; k < kJoints; ++k) {
    next.noalias() = T * joints[k];
    T = next;
  }
  const Eigen::Matrix<Number, 4, 1> point =
      T * Eigen::Matrix<Number, 4, 1>(Number(30), Number(-380), Number(-300), Number(1));
  return {point(0), point(1), point(2)};
}

}  // namespace

std::array<float, 3> six_products_float(float q) { return six_products(q); }
std::array<double, 3> six_products_double(double q) { return six_products(q); }

#ifdef VOLCOMP_BENCH_KDL

bool has_kdl() { return true; }

std::array<double, 3> six_kdl_frames(double q) {
  static auto frames = [] {
    std::array<KDL::Frame, kJoints> made;
    for (std::size_t k = 0; k < kJoints; ++k) {
      const double e = 1e-5 * static_cast<double>(k + 1);
      made[k] = KDL::Frame(KDL::Rotation::RPY(e, e, e), KDL::Vector(100.0, 20.0, 3.0));
    }
    return made;
  }();
  frames[0].p.x(q);
  KDL::Vector point(30.0, -380.0, -300.0);
  for (std::size_t k = kJoints; k > 0; --k)
    point = frames[k - 1] * point;
  return {point.x(), point.y(), point.z()};
}

std::array<double, 3> six_kdl_joints(double q) {
  static const KDL::Chain kChain = [] {
    KDL::Chain chain;
    for (const auto kind : {KDL::Joint::TransX, KDL::Joint::TransY, KDL::Joint::TransZ,
                            KDL::Joint::RotX, KDL::Joint::RotY, KDL::Joint::RotZ})
      chain.addSegment(KDL::Segment(KDL::Joint(kind), KDL::Frame(KDL::Vector(1.0, 2.0, 3.0))));
    return chain;
  }();
  static KDL::ChainFkSolverPos_recursive solver(kChain);
  static KDL::JntArray joints(kJoints);
  for (unsigned k = 0; k < kJoints; ++k)
    joints(k) = k < 3 ? q : 1e-3 * q;
  KDL::Frame end;
  static_cast<void>(solver.JntToCart(joints, end));
  return {end.p.x(), end.p.y(), end.p.z()};
}

#else

bool has_kdl() { return false; }
std::array<double, 3> six_kdl_frames(double /*q*/) { return {}; }
std::array<double, 3> six_kdl_joints(double /*q*/) { return {}; }

#endif

}  // namespace volcomp::bench
