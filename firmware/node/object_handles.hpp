#pragma once
// The objects of the node by name, for who reads and writes them: object::late_cycles,
// object::probe::delay_ns.

#include "firmware/node/node_objects.hpp"

namespace volcomp::node::object {

#define HANDLE(index, sub, type, member, name) \
  inline constexpr object_lines::Handle<object_lines::type> member{index, sub, name};

#define NODE(index, sub, count, type, member, use, value, range, name) \
  HANDLE(index, sub, type, member, name)
#include "firmware/node/objects.def"

namespace probe {
#define PROBE(index, sub, count, type, member, use, value, range, name) \
  HANDLE(index, sub, type, member, name)
#include "firmware/node/objects.def"
}  // namespace probe

namespace flank {
#define FLANK(index, sub, count, type, member, use, value, range, name) \
  HANDLE(index, sub, type, member, name)
#include "firmware/node/objects.def"
}  // namespace flank

namespace stroke {
#define STROKE(index, sub, count, type, member, use, value, range, name) \
  HANDLE(index, sub, type, member, name)
#include "firmware/node/objects.def"
}  // namespace stroke

namespace thermal {
#define THERMAL(index, sub, count, type, member, use, value, range, name) \
  HANDLE(index, sub, type, member, name)
#include "firmware/node/objects.def"
}  // namespace thermal

#undef HANDLE

}  // namespace volcomp::node::object
