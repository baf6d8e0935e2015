#pragma once
// The commanded position that makes the machine stand at the wanted one: q + E(q) = p.

#include "comp/machine/frame.hpp"

namespace volcomp {

// Fixed point q ← p − E(q), `evaluations` times from q = p. One evaluation leaves ‖J‖‖E‖ (nm), two
// ‖J‖²‖E‖ (below a pm for any machine tool), J = ∂E/∂q ≈ 1e-4.
template <class ErrorAt>
[[nodiscard]] Vec3 compensated_command(const ErrorAt& error_at, const Vec3& target,
                                       int evaluations) {
  Vec3 q = target;
  for (int i = 0; i < evaluations; ++i)
    q = target - error_at(q);
  return q;
}

}  // namespace volcomp
