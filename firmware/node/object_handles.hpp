#pragma once
// The objects of the node by name, for who reads and writes them: object::late_cycles,
// object::probe::delay_ns.

#include "firmware/node/node_objects.hpp"

namespace volcomp::node::object {

#define HANDLE(index, sub, count, type, member, use, value, range, name) \
  inline constexpr object_lines::Handle<object_lines::type> member{index, sub, name};

#define NODE HANDLE
#include "firmware/node/objects.def"

namespace probe {
#define PROBE HANDLE
#include "firmware/node/objects.def"
}  // namespace probe

namespace flank {
#define FLANK HANDLE
#include "firmware/node/objects.def"
}  // namespace flank

namespace stroke {
#define STROKE HANDLE
#include "firmware/node/objects.def"
}  // namespace stroke

namespace thermal {
#define THERMAL HANDLE
#include "firmware/node/objects.def"
}  // namespace thermal

#undef HANDLE

}  // namespace volcomp::node::object
