// Any bytes as a machine file: a valid chain or a UserError, never anything else.

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/machine_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto file = volcomp::host::parse_machine(
        std::string(reinterpret_cast<const char*>(data), size), "machine.toml");
    volcomp::MachineChain chain;
    if (!volcomp::MachineChain::build(file.chain.description(), chain).ok()) __builtin_trap();
    if (file.axes.size() != chain.axis_count()) __builtin_trap();
  } catch (const volcomp::host::UserError&) {
    return 0;
  }
  return 0;
}
