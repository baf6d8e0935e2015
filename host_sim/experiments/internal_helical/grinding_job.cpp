#include "host_sim/experiments/internal_helical/grinding_job.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/strokes/helix_instances.hpp"
#include "host_sim/experiments/internal_helical/constants.hpp"
#include "host_sim/host/bus/watched_strokes.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {
namespace {

bool equal(double a, double b) { return std::abs(a - b) < 1e-9; }

}  // namespace

host::GrindingFile grinding_job(const host::MachineFile& machine) {
  const auto refuse_it = [&machine](const std::string& why) {
    throw host::UserError(machine.path + ": " + why);
  };
  if (!machine.grinding) refuse_it("the machine has no [gear], [wheel] and [stroke]");
  host::GrindingFile job = *machine.grinding;
  if (job.gear.spur()) refuse_it("'helix_angle_deg' of [gear] is 0: only a helix couples Z and C");
  if (job.gear.teeth > static_cast<int>(kGearSlots))
    refuse_it(
        fmt::format("'teeth' of [gear] must be at most {}: the table of the slots has no "
                    "room for more",
                    kGearSlots));
  const double widest = host::kNodeSpacing_mm * static_cast<double>(kStrokeNodes - 1);
  if (job.width_mm > widest)
    refuse_it(
        fmt::format("'width_mm' of [gear] must be at most {:g}: the tables of the stroke "
                    "have no room for more",
                    widest));
  static_cast<void>(form_wheel(job));
  return job;
}

WheelSetup form_wheel(const host::GrindingFile& job) {
  WheelSetup setup;
  host::require(wheel_setup(job.gear, job.wheel_radius_mm, job.gear.helix_angle, setup), "wheel");
  return setup;
}

bool is_of_the_paper(const host::GrindingFile& job) {
  const InternalGear& g = job.gear;
  return g.teeth == 79 && equal(g.module, 2.0) && equal(g.pressure_angle, 20.0 * kRadPerDegree) &&
         equal(g.helix_angle, 15.0 * kRadPerDegree) && equal(job.width_mm, 45.0) &&
         equal(job.wheel_radius_mm, 40.0) && equal(job.feed_mm_per_s, 13.4);
}

}  // namespace volcomp::internal_helical
