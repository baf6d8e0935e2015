// Any bytes as touches of a sphere or a ring: accepted or refused with a UserError, and what is
// accepted calibrates a probe or is refused; then every figure is finite.

#include <cmath>
#include <sstream>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/probe_settings.hpp"

using volcomp::host::ArtefactShape;
using volcomp::host::ProbeModel;
using volcomp::host::UserError;

namespace {

void calibrate(const volcomp::host::TouchFile& file, ArtefactShape shape, ProbeModel model) {
  try {
    const volcomp::host::ProbeArtefact artefact{shape, 25.0, {}, volcomp::Axis::z};
    const auto calibration = volcomp::host::calibrate_probe(file, artefact, model);
    for (const auto& setting : volcomp::host::probe_settings(calibration)) {
      if (!std::isfinite(setting.value)) __builtin_trap();
    }
    if (!(calibration.u_effective >= 0.0)) __builtin_trap();
  } catch (const UserError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  try {
    const auto file = volcomp::host::read_touches(stream, "touches.csv");
    for (const ArtefactShape shape : {ArtefactShape::sphere, ArtefactShape::ring}) {
      for (const ProbeModel model : {ProbeModel::lobing, ProbeModel::constant})
        calibrate(file, shape, model);
    }
  } catch (const UserError&) {
    return 0;
  }
  return 0;
}
