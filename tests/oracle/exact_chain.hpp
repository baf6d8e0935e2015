#pragma once
// Shared by the commissioning tests: replayable random numbers and an oracle that shares nothing
// with comp but its data types: 4×4 products in long double, straight from the definitions.

#include <cstdint>
#include <limits>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "comp/machine/machine_chain.hpp"
#include "comp/metrology/tables/error_table.hpp"

namespace volcomp::test {

// Uniform numbers from a fixed seed, which VOLCOMP_TEST_SEED replaces; prints the seed in use.
class Random {
 public:
  Random();

  double uniform(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine_); }
  double normal(double sigma) { return sigma * std::normal_distribution(0.0, 1.0)(engine_); }
  int integer(int lo, int hi) { return std::uniform_int_distribution(lo, hi)(engine_); }
  Vec3 vector(double largest) {
    return {uniform(-largest, largest), uniform(-largest, largest), uniform(-largest, largest)};
  }
  ErrorMotion error(double mm, double rad) {
    ErrorMotion e;
    e << vector(mm), vector(rad);
    return e;
  }
  template <class Enum>
  Enum pick(std::initializer_list<Enum> from) {
    return *(from.begin() + integer(0, static_cast<int>(from.size()) - 1));
  }

 private:
  std::mt19937_64 engine_;
};

// --- oracle ---------------------------------------------------------------------------------

// On some targets no more than a double: the oracle is then as coarse as what it judges.
using Real = long double;
inline constexpr auto kRealEpsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());
using Real3 = Eigen::Matrix<Real, 3, 1>;
using Real33 = Eigen::Matrix<Real, 3, 3>;
using Real44 = Eigen::Matrix<Real, 4, 4>;

[[nodiscard]] Real33 skew(const Real3& a);

// Rotation about coordinate axis 0, 1 or 2.
[[nodiscard]] Real33 turn_about(int axis, Real angle);

// The error rotation by its definition: product of elementary rotations, power series, or the
// products truncated.
[[nodiscard]] Real33 error_rotation(RotationModel model, const Vec3& angles);

[[nodiscard]] Real44 homogeneous(const Real33& R, const Real3& t);
[[nodiscard]] Real3 transform(const Real44& T, const Real3& p);

// J(s q), H and N of one joint.
[[nodiscard]] Real44 motion_of(const Joint& joint, double q);
[[nodiscard]] Real44 offset_of(const Joint& joint);
[[nodiscard]] Real44 deviation_of(const ErrorMotion& e, RotationModel model);

// Pose of a body (1-based) in the root frame: product of H J N along the lower-body array. Without
// `errors` the ideal pose.
[[nodiscard]] Real44 body_pose(const MachineDescription& machine, int body, const Pose& q,
                               const ErrorSet* errors, RotationModel model);

// A machine with random topology, joints (fixed ones with constant errors) and offsets.
[[nodiscard]] MachineDescription random_machine(Random& random, double mm, double rad);

[[nodiscard]] MachineChain chain_of(const MachineDescription& machine);

inline Vec3 to_double(const Real3& v) { return v.cast<double>(); }

}  // namespace volcomp::test
