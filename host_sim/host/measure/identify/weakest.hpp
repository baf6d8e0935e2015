#pragma once
// The values of a machine that are known least for their kind, and what each of them cannot be told
// from.

#include <string>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/identify/solution.hpp"

namespace volcomp::host::identify {

struct WeakValue {
  Quantity quantity;
  double at = 0.0;     // of a function: where its uncertainty is largest
  double u = 0.0;      // mm or rad
  double times = 0.0;  // over the median of all lengths, or of all angles
  std::string with;    // the value or the unknown of an instrument that it is correlated most with
  double correlation = 0.0;
};

inline constexpr std::size_t kWeakest = 6;  // that reports name

// At most `count`, the weakest first.
[[nodiscard]] std::vector<WeakValue> weakest_values(const Equations& equations,
                                                    const Triangle& triangle,
                                                    const MachineFile& machine, std::size_t count);

// A name for each unknown, for people: "tip S1 Y", "flat: turn about X"; empty for those of the
// machine, which have no meaning by themselves.
[[nodiscard]] std::vector<std::string> unknown_names(const Unknowns& unknowns);

}  // namespace volcomp::host::identify
