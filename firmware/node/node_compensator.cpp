#include "firmware/node/node_compensator.hpp"

namespace volcomp {

template class Compensator<LoadedMachine<node::kNodeAxes>, node::kNodeKnots>;

}  // namespace volcomp
