#pragma once
// The two halves of the list of reasons.

#include <vector>

#include "host_sim/host/bus/explain/explanation.hpp"

namespace volcomp::host {

struct ReasonRow {
  Reason reason;
  const char* why;
  const char* remedy;
};

[[nodiscard]] const std::vector<ReasonRow>& loading_reasons();
[[nodiscard]] const std::vector<ReasonRow>& measuring_reasons();

}  // namespace volcomp::host
