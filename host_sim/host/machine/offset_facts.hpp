#pragma once
// What limits an offset, as a person reads it: per second, and what follows from it.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/tick/offset_bounds.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

struct OffsetFacts {
  char axis = '\0';
  bool rotary = false;
  // mm or rad, and seconds.
  double rate = 0.0;            // as stated
  double effective_rate = 0.0;  // from which stopping takes at most half the limit
  double acceleration = 0.0;    // as used, rounded down to units; 0: any
  double free = 0.0;            // targets up to ± this are followed without lag
  std::int32_t units = 0;       // of acceleration per period and period
  double by_setup = 0.0;        // acceleration that only `setup` switches on; 0: none

  // So few units that rounding makes it up to half tighter than stated.
  [[nodiscard]] bool coarse() const;
};

[[nodiscard]] OffsetFacts offset_facts(char axis, bool rotary, const OffsetLimits& limits,
                                       double period_s);
// Of these in the integrated form; none of a machine with too many axes for it. Throws UserError as
// compensator_settings().
[[nodiscard]] std::vector<OffsetFacts> offset_facts(const MachineFile& machine);

// A line for each axis, and for programs.
[[nodiscard]] std::string offset_text(const std::vector<OffsetFacts>& facts);
[[nodiscard]] nlohmann::json offset_json(const std::vector<OffsetFacts>& facts);

}  // namespace volcomp::host
