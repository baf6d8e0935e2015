#pragma once
// SDO abort codes (CiA 301, table 22), and what each means in words.

#include <cstdint>

namespace volcomp::canopen {

enum class AbortCode : std::uint32_t {
  none = 0,
  toggle_bit = 0x0503'0000,
  timeout = 0x0504'0000,
  unknown_command = 0x0504'0001,
  block_size = 0x0504'0002,
  block_sequence = 0x0504'0003,
  block_crc = 0x0504'0004,
  out_of_memory = 0x0504'0005,
  unsupported_access = 0x0601'0000,
  write_only = 0x0601'0001,
  read_only = 0x0601'0002,
  no_object = 0x0602'0000,
  not_mappable = 0x0604'0041,
  mapping_too_long = 0x0604'0042,
  incompatible_parameter = 0x0604'0043,
  hardware = 0x0606'0000,
  wrong_length = 0x0607'0010,
  too_long = 0x0607'0012,
  too_short = 0x0607'0013,
  no_subindex = 0x0609'0011,
  invalid_value = 0x0609'0030,
  value_too_high = 0x0609'0031,
  value_too_low = 0x0609'0032,
  general = 0x0800'0000,
  cannot_store = 0x0800'0020,
  local_control = 0x0800'0021,
  device_state = 0x0800'0022,
  no_data = 0x0800'0024,
};

// One plain sentence; also for codes another device made up.
[[nodiscard]] const char* sentence(AbortCode code);

}  // namespace volcomp::canopen
