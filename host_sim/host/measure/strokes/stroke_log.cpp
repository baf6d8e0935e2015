#include "host_sim/host/measure/strokes/stroke_log.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

void set_period(StrokeLog& log) {
  constexpr double kLeast_s = 10e-6;
  constexpr double kMost_s = 0.1;
  std::vector<double> steps;
  steps.reserve(log.samples.size());
  for (std::size_t i = 1; i < log.samples.size(); ++i)
    steps.push_back(log.samples[i].time_s - log.samples[i - 1].time_s);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  log.period_s = *middle;
  if (log.period_s < kLeast_s || log.period_s > kMost_s) {
    throw UserError(fmt::format(
        "{}: the cycles are {:g} s apart, not 10 us to 0.1 s: is the unit of the time right?",
        log.name, log.period_s));
  }
}

const GrindingFile& grinding_of(const MachineFile& machine) {
  if (!machine.grinding)
    throw UserError(machine.path + ": has no [gear] and [stroke], which learning is about");
  return *machine.grinding;
}

}  // namespace volcomp::host
