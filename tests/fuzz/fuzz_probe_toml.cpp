// Any bytes as the settings of a probe: values a node takes or a UserError, never anything else.

#include <cmath>

#include "host_sim/host/bus/probe_calibration_file.hpp"
#include "host_sim/host/io/user_error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    volcomp::host::NodeProbe probe;
    volcomp::host::read_probe_calibration(std::string(reinterpret_cast<const char*>(data), size),
                                          "probe.toml", probe);
    for (const double coefficient : probe.radius.coefficient)
      if (!std::isfinite(coefficient)) __builtin_trap();
    if (!(probe.radius_uncertainty >= 0.0 && probe.repeatability >= 0.0)) __builtin_trap();
  } catch (const volcomp::host::UserError&) {
    return 0;
  }
  return 0;
}
