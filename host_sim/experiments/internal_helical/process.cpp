#include "host_sim/experiments/internal_helical/process.hpp"

#include "host_sim/experiments/internal_helical/grinding_job.hpp"

namespace volcomp::internal_helical {
namespace {

constexpr int kDwell_ticks = 200;  // longer than every lag

}  // namespace

double slot_place(const InternalGear& gear, std::uint16_t slot) {
  return -2.0 * kPi * slot / gear.teeth;
}

GrindingProcess::GrindingProcess(const host::GrindingFile& job, const GrindingTruth& truth,
                                 std::uint64_t seed)
    : teeth_(job.gear.teeth),
      plan_(job, form_wheel(job).centre_distance),
      plant_(job.gear, truth, plan_.standing(), seed) {}

void GrindingProcess::rest(const Sync& sync) const {
  for (int tick = 0; tick < kDwell_ticks; ++tick)
    sync(plan_.standing());
}

std::vector<StrokeTrace> GrindingProcess::round(const Sync& sync) {
  rest(sync);
  std::vector<StrokeTrace> traces;
  traces.reserve(static_cast<std::size_t>(teeth_));
  for (int k = 0; k < teeth_; ++k)
    traces.push_back(pass(sync));
  return traces;
}

StrokeTrace GrindingProcess::pass(const Sync& sync) {
  plan_.begin_pass();
  StrokeTrace trace;
  trace.slot = plan_.index(0).slot;
  trace.direction = plan_.index(0).stroke;
  plant_.begin_pass(trace.slot);
  for (int tick = 0; tick < plan_.index_ticks(); ++tick)
    sync(plan_.index(tick));
  trace.at.reserve(static_cast<std::size_t>(plan_.stroke_ticks()));
  for (int tick = 0; tick < plan_.stroke_ticks(); ++tick) {
    const StrokeStep step = plan_.stroke(tick);
    trace.at.push_back(plant_.errors(step));
    sync(step);
  }
  plan_.end_pass();
  return trace;
}

}  // namespace volcomp::internal_helical
