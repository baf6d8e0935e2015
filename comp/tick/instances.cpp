// The ready-made forms of the compensator, compiled once into the library: loaded machines of up
// to five axes and the XYFZ machine of docs/papers/xyfz.md compiled in. Also what the build
// inspects to prove that the tick needs no library.

#include "comp/tick/instances.hpp"

namespace volcomp {

template class Compensator<PositionMachine>;
template class Compensator<CompiledMachine<kXyfzMachine>>;

}  // namespace volcomp
