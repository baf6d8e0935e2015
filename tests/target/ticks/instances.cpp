#include "tests/target/ticks/machines.hpp"

namespace volcomp {

template class Compensator<GenericMachine>;
template class Compensator<GrinderMachine>;
template class Compensator<FiveAxisMachine>;
template class Compensator<EightAxisMachine>;
template class Compensator<CompiledMachine<kXyfzMachine>, kDefaultKnots, OffsetLimiter<false>>;
template class Compensator<PositionMachine, kDefaultKnots, OffsetLimiter<false>>;
template class Compensator<OrientingMachine, kDefaultKnots, OffsetLimiter<false>>;
template class Compensator<GrinderMachine, kDefaultKnots, OffsetLimiter<false>>;
template class Compensator<FiveAxisMachine, kDefaultKnots, OffsetLimiter<false>>;

}  // namespace volcomp
