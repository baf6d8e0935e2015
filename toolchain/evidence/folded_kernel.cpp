// The kernel of the folded machine by itself: compiled to assembly for the estimate of llvm-mca,
// never linked.

#include "comp/tick/instances.hpp"

namespace volcomp {

Float3 folded_kernel(const XyfzCompensator::Tables& set, const std::array<Located, 3>& at);

Float3 folded_kernel(const XyfzCompensator::Tables& set, const std::array<Located, 3>& at) {
  return kernel::folded_error(CompiledMachine<kXyfzMachine>{}, set, at);
}

}  // namespace volcomp
