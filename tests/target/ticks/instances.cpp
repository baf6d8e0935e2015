#include "tests/target/ticks/machines.hpp"

namespace volcomp {

template class Compensator<GenericMachine>;
template class Compensator<GrinderMachine>;
template class Compensator<FiveAxisMachine>;
template class Compensator<EightAxisMachine>;

}  // namespace volcomp
