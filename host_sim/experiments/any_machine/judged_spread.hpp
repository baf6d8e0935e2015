#pragma once
// The figures of many machines side by side: median and range before and after compensation.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/report/before_after.hpp"
#include "host_sim/host/report/range_of_draws.hpp"

namespace volcomp::any_machine {

// What the verdict of one machine is about.
struct JudgedMachine {
  std::vector<host::BeforeAfter> figures;
  bool good = false;
};

// A machine in a part of a run, and read back. Throws UserError.
[[nodiscard]] nlohmann::json judged_json(const JudgedMachine& machine);
[[nodiscard]] JudgedMachine judged_of(const nlohmann::json& draw);
// Throws UserError where a machine has other figures than the first.
void require_same_figures(const std::vector<JudgedMachine>& drawn);

// Of one figure of all machines.
[[nodiscard]] host::RangeOfDraws range_over(const std::vector<JudgedMachine>& drawn,
                                            std::size_t figure, double host::BeforeAfter::*value);
// Every machine has the same figures, of which there is one at least.
[[nodiscard]] nlohmann::json spread_table(const std::vector<JudgedMachine>& drawn,
                                          const std::string& note);
[[nodiscard]] nlohmann::json what_is_left(const std::vector<JudgedMachine>& drawn);

}  // namespace volcomp::any_machine
