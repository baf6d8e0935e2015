#pragma once
// The predefined connection set (CiA 301, section 7.3.5).

#include <cstdint>

namespace volcomp::canopen {

inline constexpr std::uint8_t kMaxNodeId = 127;

enum CobId : std::uint16_t {
  kNmt = 0x000,
  kSync = 0x080,
  kEmergency = 0x080,  // + node id
  kTime = 0x100,
  kTpdo1 = 0x180,  // TPDO k of a node: + 100h (k − 1) + node id
  kTpdo2 = 0x280,
  kTpdo3 = 0x380,
  kTpdo4 = 0x480,
  kRpdo1 = 0x200,        // RPDO k of a node: + 100h (k − 1) + node id
  kSdoResponse = 0x580,  // server → client
  kSdoRequest = 0x600,   // client → server
  kHeartbeat = 0x700,
};

// PDOs must keep off the identifiers with a fixed meaning (CiA 301, table 40). SYNC and EMCY share
// 081h…0FFh.
constexpr bool restricted(std::uint16_t id) {
  return id <= 0x180 || (id >= 0x581 && id <= 0x5FF) || (id >= 0x601 && id <= 0x67F) ||
         (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

}  // namespace volcomp::canopen
