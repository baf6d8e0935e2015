#pragma once
// Implementation of the volcomp_compensator of volcomp.h.

#include "comp/probe/probe_corrector.hpp"
#include "comp/tables/tables_view.hpp"
#include "comp/tick/instances.hpp"
#include "comp/tick/temperature_input.hpp"
#include "firmware/embed/c/volcomp.h"

struct volcomp_compensator {
  volcomp::OrientingCompensator compensator;
  volcomp::OrientingCompensator::Input in{};
  volcomp::OrientingCompensator::Output out{};
  volcomp::ProbeCorrector probe;
  // View of the image given last. Its description of the machine stays valid; the values of its
  // tables lie in bytes that the caller has taken back.
  volcomp::TablesView tables{};
  volcomp_machine machine{};  // of the image accepted last
  volcomp::TemperatureInputs temperature{};
  std::int64_t unix_s = 0;
  std::uint32_t active_crc = 0;  // of the image activated last
  bool grows = false;            // `tables` are those staged last
  std::uint32_t rejections = 0;
  volcomp_status last_rejection{VOLCOMP_OK, '\0', nullptr, -1, -1};
  bool staged = false;     // and not yet activated
  bool activated = false;  // at least once: the machine is decided
};

namespace volcomp::c_interface {

static_assert(sizeof(volcomp_compensator) <= VOLCOMP_BYTES);
static_assert(alignof(volcomp_compensator) <= alignof(volcomp_memory));
static_assert(OrientingCompensator::kAxes == VOLCOMP_AXES && kDefaultKnots == VOLCOMP_KNOTS);

inline volcomp_status fine() { return {VOLCOMP_OK, '\0', nullptr, -1, -1}; }

inline volcomp_status refused(volcomp_reason reason, const char* field, int index = -1) {
  return {reason, '\0', field, index, -1};
}

inline volcomp_reason code_of(Reason reason) { return static_cast<volcomp_reason>(reason); }

inline volcomp_status from(const Status& status) {
  const Where& where = status.where;
  return {static_cast<int>(status.reason), where.axis, where.field, where.index, where.channel};
}

}  // namespace volcomp::c_interface
