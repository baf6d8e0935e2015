// The kernel of the folded machine by itself, directions known: compiled to assembly for the
// estimate of llvm-mca, never linked.

#include "comp/realtime/instances.hpp"

namespace volcomp {

struct Place {
  const Knot* knot;
  float t;
  std::uint32_t u;
};
Float3 folded_kernel(const XyfzCompensator::Tables& set, const std::array<Place, 3>& at);

Float3 folded_kernel(const XyfzCompensator::Tables& set, const std::array<Place, 3>& at) {
  const auto known = [&at](std::size_t axis) -> Located {
    return {at[axis].knot, nullptr, at[axis].t, at[axis].u};
  };
  const std::array<Located, 3> located{known(0), known(1), known(2)};
  return kernel::folded_error(CompiledMachine<kXyfzMachine>{}, set, located);
}

}  // namespace volcomp
