#include "firmware/node/node_compensator.hpp"

namespace volcomp {

template class Compensator<node::NodeMachine, node::kNodeKnots>;

}  // namespace volcomp
