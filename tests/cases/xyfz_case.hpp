#pragma once
// The XYFZ machine of a case of docs/papers/xyfz.md: chain, tables in the internal convention,
// model.

#include <memory>

#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

[[nodiscard]] XyfzOffsets offsets_of(const json& in);
[[nodiscard]] XyfzSquareness squareness_of(const json& a_xy_xz_yz);
[[nodiscard]] MachineChain chain_of(const MachineDescription& description);
[[nodiscard]] Pose pose_of(const Vec3& q);

// Relative values of X, Y, Z turned into the internal convention.
[[nodiscard]] ErrorSet internal_errors(const MachineChain& chain,
                                       const std::array<ErrorMotion, 3>& relative, const Pose& q);

// A table {q0, h, f[knot][6]}, same values in both directions, as given. More knots than fit: only
// the count is set.
[[nodiscard]] ErrorTable table_of(const json& table);

// The three tables of a case and the optimised model over them.
struct XyfzCase {
  explicit XyfzCase(const json& in);
  XyfzCase(const XyfzCase&) = delete;
  XyfzCase& operator=(const XyfzCase&) = delete;

  std::array<ErrorTable, 3> relative;  // as given
  std::array<ErrorTable, 3> internal;
  VolumetricModel model;

  [[nodiscard]] Vec3 error(const Vec3& q) const;
};

// Memory for tables is large: cases live on the heap.
[[nodiscard]] inline std::unique_ptr<XyfzCase> xyfz_case(const json& in) {
  return std::make_unique<XyfzCase>(in);
}

}  // namespace volcomp::cases
