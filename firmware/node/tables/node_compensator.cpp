#include "firmware/node/tables/node_compensator.hpp"

namespace volcomp {

template class Compensator<node::NodeMachine, node::kNodeKnots>;

}  // namespace volcomp
