// What each object of the node is for: those of CiA 301 here, its own in firmware/node/objects.def.

#include <array>

#include "host_sim/host/bus/explain/explanation.hpp"

namespace volcomp::host {
namespace {

struct Purpose {
  unsigned first;
  unsigned last;
  const char* text;
};

constexpr std::array kPurposes{
    Purpose{0x1000, 0x1000, "What the device is: no standard profile of CiA covers compensation."},
    Purpose{
        0x1001, 0x1001,
        "One bit per class of error that is active now. Bit 0 any, bit 4 communication, bit 7 one "
        "of this device."},
    Purpose{0x1003, 0x1003,
            "The latest eight emergency codes, newest first. Writing 0 to sub-index 0 clears it."},
    Purpose{0x1005, 0x1005,
            "Identifier of SYNC. Bit 30 makes the node its producer, where there is no controller "
            "that does."},
    Purpose{
        0x1006, 0x1006,
        "Period of SYNC in us. The node needs it for the deadline, for speeds and as producer."},
    Purpose{0x1007, 0x1007,
            "Synchronous frames later than this after SYNC do not belong to the cycle any more."},
    Purpose{0x1008, 0x100A, "Name and versions of the device, as text."},
    Purpose{
        0x1010, 0x1010,
        "Writing \"save\" (65766173h) to sub-index 1 stores parameters and active tables. Refused "
        "while OPERATIONAL. Reads 0 where there is no store."},
    Purpose{0x1011, 0x1011,
            "Writing \"load\" (64616F6Ch) to sub-index 1 forgets what is stored; defaults hold "
            "after the next reset. Reads 0 where there is no store."},
    Purpose{0x1012, 0x1012,
            "Identifier of TIME, which gives the node the date; bit 31: it listens. Needed for "
            "tables that expire."},
    Purpose{0x1014, 0x1015, "Identifier of emergency messages, and the shortest time between two."},
    Purpose{
        0x1016, 0x1016,
        "Nodes whose heartbeats are watched, and for how long they may be silent: the drives and "
        "the controller. Node << 16 | ms; not used with time 0, node 0 or a node above 127."},
    Purpose{0x1017, 0x1017, "Period of the node's own heartbeat in ms."},
    Purpose{0x1018, 0x1018, "Vendor, product, revision and serial number."},
    Purpose{
        0x1019, 0x1019,
        "Where the counter in SYNC begins again, in all devices alike; 0: SYNC has no counter."},
    Purpose{
        0x1020, 0x1020,
        "Date and time of the configuration, kept as written: a controller that finds its own here "
        "need not configure again."},
    Purpose{0x1029, 0x1029,
            "What the node does when the controller falls silent: 0 PRE-OPERATIONAL, 1 nothing, 2 "
            "STOPPED."},
    Purpose{0x1200, 0x1200, "Identifiers of the SDO server."},
    Purpose{0x1400, 0x15FF,
            "How a frame of a drive or of the controller is received: identifier (bit 31: off) and "
            "type. Fixed in OPERATIONAL, temperatures apart."},
    Purpose{0x1600, 0x17FF, "Where its bytes go: 2011h to 201Ah, 2700h."},
    Purpose{
        0x1800, 0x19FF,
        "How a frame is sent: offsets to the drives when the cycle is complete, state and points "
        "to the controller. Bit 30 of a valid identifier is 1: remote requests are not answered. "
        "Those of the offsets are fixed in OPERATIONAL."},
    Purpose{0x1A00, 0x1BFF, "What a sent frame contains, in this order."},
#define PURPOSE(first, last, text) Purpose{first, last, text},
#include "firmware/node/objects.def"
};

}  // namespace

const char* purpose(unsigned index) {
  for (const Purpose& p : kPurposes) {
    if (index >= p.first && index <= p.last) return p.text;
  }
  return nullptr;
}

}  // namespace volcomp::host
