#pragma once
// Runs the tables of a case of docs/papers/xyfz.md through the real tick: quantised, encoded,
// decoded, folded, activated.

#include <memory>

#include "comp/metrology/tables/quantise.hpp"
#include "comp/tick/instances.hpp"
#include "tests/cases/xyfz_case.hpp"

namespace volcomp::cases {

struct TickLimits {
  double limit_mm = 4.19;
  double rate_mm = 1000.0;
  std::array<double, 3> start_mm{};
};

// Mode "actual", ramp done at the first tick.
class TickCase {
 public:
  TickCase(const XyfzCase& c, const TickLimits& limits);
  TickOutput<5> run(const TickInput<5>& input);

 private:
  std::unique_ptr<LoadedCompensator> compensator_;
};

// The tables of a case as a machine image would hold them.
[[nodiscard]] std::unique_ptr<MachineTables> machine_tables(const XyfzCase& c);

}  // namespace volcomp::cases
