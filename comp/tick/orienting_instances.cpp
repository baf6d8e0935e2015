// Apart from the others, whose small functions would else be shared and no longer inlined: the
// flash of small boards.

#include "comp/tick/instances.hpp"

namespace volcomp {

template class Compensator<OrientingMachine>;

}  // namespace volcomp
