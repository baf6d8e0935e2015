#pragma once
// The objects of the node by name, for who reads and writes them: object::late_cycles,
// object::probe::delay_ns.

#include "firmware/node/node_objects.hpp"

namespace volcomp::node::object {

namespace lines = canopen::object_lines;
using canopen::kErrorHistory;
using canopen::kHeartbeatConsumers;

#define HANDLE(index, sub, count, type, member, use, value, range, name) \
  inline constexpr lines::Handle<lines::type> member{index, sub, count, name};
// What a handler reads or writes, as bytes.
#define DOMAIN_HANDLE(index, sub, count, member, use, name) \
  inline constexpr lines::Handle<lines::u8> member{index, sub, count, name};

#define COMMON HANDLE
#include "firmware/canopen/communication.def"

#define NODE HANDLE
#define NODE_DOMAIN DOMAIN_HANDLE
#include "firmware/node/objects.def"

namespace probe {
#define PROBE HANDLE
#define PROBE_DOMAIN DOMAIN_HANDLE
#include "firmware/node/objects.def"
}  // namespace probe

namespace flank {
#define FLANK HANDLE
#include "firmware/node/objects.def"
}  // namespace flank

namespace stroke {
#define STROKE HANDLE
#define STROKE_DOMAIN DOMAIN_HANDLE
#include "firmware/node/objects.def"
}  // namespace stroke

namespace thermal {
#define THERMAL HANDLE
#include "firmware/node/objects.def"
}  // namespace thermal

#undef HANDLE
#undef DOMAIN_HANDLE

}  // namespace volcomp::node::object
