#pragma once
// SDO abort codes (CiA 301, table 22), and what each means in words.

#include <cstdint>

namespace volcomp::canopen {

enum class AbortCode : std::uint32_t {
  none = 0,
#define ABORT_CODE(number, name, sentence) name = (number),
#include "firmware/canopen/codes.def"
};

// One plain sentence; also for codes another device made up.
[[nodiscard]] const char* sentence(AbortCode code);

}  // namespace volcomp::canopen
