#include "host_sim/sim/campaign/located_runs.hpp"

#include "host_sim/sim/campaign/any_axes.hpp"

namespace volcomp::sim {
namespace {

// As the file means it, at the head of the axis.
ErrorMotion seen_at(const host::MachineFile& file, std::size_t a, double q,
                    const AverageLine& line) {
  return in_file_terms(error_of(line, file.chain.axis(a), q), file, a, q);
}

void add_to_runs(const host::MachineFile& file, std::size_t a, const AverageLine& line,
                 host::RunsFile& runs) {
  const host::AxisFile& axis = file.axes[a];
  for (std::size_t t = 0; t < runs.positions.size(); ++t) {
    const double q = runs.positions[t];
    const Vec3 lever = axis.sensed.lever(file.chain.axis(a).axis, q);
    const ErrorMotion seen = at_lever(seen_at(file, a, q, line), lever);
    for (auto* list : {&runs.up, &runs.down})
      for (host::RunValues& run : *list)
        run[t] += seen;
  }
}

AverageLine line_of_runs(const host::MachineFile& file, std::size_t a, const host::RunsFile& runs) {
  const Joint& joint = file.chain.axis(a);
  const auto count = static_cast<double>(runs.up.size() + runs.down.size());
  std::vector<ErrorMotion> mean;
  for (std::size_t t = 0; t < runs.positions.size(); ++t) {
    ErrorMotion sum = ErrorMotion::Zero();
    for (const auto* list : {&runs.up, &runs.down})
      for (const host::RunValues& run : *list)
        sum += run[t];
    const double q = runs.positions[t];
    const Vec3 lever = file.axes[a].sensed.lever(joint.axis, q);
    mean.push_back(to_internal(at_head(sum / count, lever), joint, q, file.convention, file.side));
  }
  return average_line(file.axes[a], joint, mean);
}

}  // namespace

void forget_places(Campaign& campaign) {
  for (std::size_t a = 0; a < campaign.runs.size(); ++a) {
    if (!campaign.machine.axes[a].rotary) continue;
    const AverageLine line = line_of_runs(campaign.machine, a, campaign.runs[a]);
    add_to_runs(campaign.machine, a, {-line.fixed, -line.moving}, campaign.runs[a]);
  }
}

void put_in_place(const std::array<AverageLine, kMaxAxes>& place, Campaign& campaign) {
  host::MachineFile& file = campaign.machine;
  for (std::size_t a = 0; a < campaign.runs.size(); ++a) {
    if (!file.axes[a].rotary) continue;
    add_to_runs(file, a, place.at(a), campaign.runs[a]);
    host::AxisFile& axis = file.axes[a];
    axis.at_reference += seen_at(file, a, axis.reference, place.at(a));
  }
}

}  // namespace volcomp::sim
