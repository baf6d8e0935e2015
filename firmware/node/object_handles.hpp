#pragma once
// The objects of the node by name, for who reads and writes them: object::late_cycles,
// object::probe::delay_ns.

#include "firmware/node/node_objects.hpp"

namespace volcomp::node::object {

using namespace canopen::object;

// What a handler reads or writes, as bytes.
#define DOMAIN_HANDLE(index, sub, count, member, use, name) \
  OBJECT_HANDLE(index, sub, count, u8, member, use, , any, name)
// A row of the array `member`, or a value of a row: began_0.
#define ROW_HANDLE(index, sub, count, type, member, which, use, range, name) \
  OBJECT_HANDLE(index, sub, count, type, member##_##which, use, , range, name)

#define NODE OBJECT_HANDLE
#define NODE_ROW ROW_HANDLE
#define NODE_DOMAIN DOMAIN_HANDLE
#include "firmware/node/objects.def"

namespace probe {
#define PROBE OBJECT_HANDLE
#define PROBE_DOMAIN DOMAIN_HANDLE
#include "firmware/node/objects.def"
}  // namespace probe

namespace flank {
#define FLANK OBJECT_HANDLE
#include "firmware/node/objects.def"
}  // namespace flank

namespace stroke {
#define STROKE OBJECT_HANDLE
#define STROKE_ROW ROW_HANDLE
#define STROKE_DOMAIN DOMAIN_HANDLE
#include "firmware/node/objects.def"
}  // namespace stroke

namespace thermal {
#define THERMAL OBJECT_HANDLE
#include "firmware/node/objects.def"
}  // namespace thermal

#undef ROW_HANDLE
#undef DOMAIN_HANDLE

}  // namespace volcomp::node::object
