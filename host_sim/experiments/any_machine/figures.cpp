#include "host_sim/experiments/any_machine/figures.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::any_machine {
namespace {

using nlohmann::json;

struct Allowed {
  double share;  // of what it was
  double um;
};
constexpr Allowed kWithoutNoise{0.1, 1.0};
constexpr Allowed kWithNoise{0.5, 5.0};

bool good(const host::BeforeAfter& line, const Allowed& allowed) {
  return line.after <= std::max(allowed.um, allowed.share * line.before);
}

json volume_json(const host::VolumeFigures& f) {
  return {{"max_um", f.max_um}, {"rms_um", f.rms_um}};
}

json orientation_json(const MachineResult& r, const MachineState& s) {
  return {{"max_urad", host::kUradPerRad * s.tilt_max_rad()},
          {"rms_urad", host::kUradPerRad * s.tilt_rms_rad()},
          {"effect_um", r.effect_um(s)},
          {"within_reach_urad", host::kUradPerRad * s.steerable_max_rad()},
          {"within_reach_um", r.steerable_um(s)}};
}

json lines_json(const MachineResult& r) {
  json lines = json::object();
  for (std::size_t i = 0; i < r.before.line.size(); ++i)
    lines[r.before.line[i].name] = {{"before_um", r.before.line[i].max_abs_um},
                                    {"after_um", r.after.line[i].max_abs_um},
                                    {"reversal_before_um", r.before.line[i].reversal_um},
                                    {"reversal_after_um", r.after.line[i].reversal_um}};
  return lines;
}

std::string letters_of(const host::MachineFile& machine, const std::vector<std::size_t>& axes) {
  std::string letters;
  for (const std::size_t a : axes)
    letters += machine.axes[a].letter;
  return fmt::format("{}", fmt::join(letters, " "));
}

json sphere_json(const MachineResult& r) {
  const Vec3& ball = r.sphere.ball;
  return {{"ball_mm", {ball.x(), ball.y(), ball.z()}},
          {"positions", r.sphere.poses.size()},
          {"left_out", r.sphere.left_out},
          {"before", volume_json(r.before.sphere_um())},
          {"after", volume_json(r.after.sphere_um())}};
}

// By name, each in µm or µrad; body values (docs/conventions.md).
json locations_json(const sim::RotaryLocations& locations) {
  json found = json::object();
  for (const sim::LocationValue& v : locations.found) {
    const double unit = v.angular ? host::kUradPerRad : kUmPerMm;
    const std::string suffix = v.angular ? "urad" : "um";
    found[v.name] = {{suffix, unit * v.found}, {"u_" + suffix, unit * v.u}};
  }
  return {{"found", found}, {"misfit", locations.misfit}, {"not_measured", locations.assumed}};
}

}  // namespace

std::string correcting_letters(const host::MachineFile& machine) {
  const MachineDescription& d = machine.chain.description();
  return letters_of(machine, {d.correcting.begin(), d.correcting.begin() + d.correcting_count});
}

std::string orienting_letters(const host::MachineFile& machine) {
  return letters_of(machine, host::orienting_axes(machine.chain));
}

json machine_figures(const MachineResult& r) {
  json figures{{"machine", r.machine.name},
               {"chain", host::chain_text(r.machine.chain)},
               {"seed", r.options.seed},
               {"noise", r.options.noise},
               {"correcting_axes", correcting_letters(r.machine)},
               {"orienting_axes", orienting_letters(r.machine)},
               {"least_authority", r.authority.value},
               {"diagonals", lines_json(r)},
               {"volume",
                {{"places", r.before.place.size()},
                 {"before", volume_json(r.before.volume)},
                 {"after", volume_json(r.after.volume)}}},
               {"orientation",
                {{"tool_length_mm", r.options.tool_length_mm},
                 {"before", orientation_json(r, r.before)},
                 {"after", orientation_json(r, r.after)}}},
               {"warnings", r.warnings},
               {"ok", machine_verdict(r).ok}};
  if (!r.before.sphere.empty()) figures["sphere"] = sphere_json(r);
  if (!r.locations.found.empty()) figures["locations"] = locations_json(r.locations);
  return figures;
}

std::vector<host::BeforeAfter> judged_figures(const MachineResult& r) {
  std::vector<host::BeforeAfter> lines;
  for (std::size_t i = 0; i < r.before.line.size(); ++i)
    lines.push_back({"diagonal " + r.before.line[i].name, r.before.line[i].max_abs_um,
                     r.after.line[i].max_abs_um});
  if (!r.before.place.empty())
    lines.push_back({"volume", r.before.volume.max_um, r.after.volume.max_um});
  if (!r.before.sphere.empty())
    lines.push_back({"sphere", r.before.sphere_um().max_um, r.after.sphere_um().max_um});
  if (r.machine.chain.description().orienting_count != 0)
    lines.push_back({"tool direction", r.steerable_um(r.before), r.steerable_um(r.after)});
  return lines;
}

host::Verdict machine_verdict(const MachineResult& r) {
  const std::vector<host::BeforeAfter> rows = judged_figures(r);
  if (rows.empty()) return {false, "Nothing could be measured."};
  const Allowed& allowed = r.options.noise ? kWithNoise : kWithoutNoise;
  const auto bad = std::find_if_not(
      rows.begin(), rows.end(), [&](const host::BeforeAfter& line) { return good(line, allowed); });
  if (bad != rows.end())
    return {false,
            fmt::format("{}: {:.2f} µm before, {:.2f} after; more than {:g} µm and more than "
                        "{:g} % are left.",
                        bad->figure, bad->before, bad->after, allowed.um, 100.0 * allowed.share)};
  const auto most = [&](double host::BeforeAfter::*value) {
    double worst = 0.0;
    for (const host::BeforeAfter& row : rows)
      worst = std::max(worst, row.*value);
    return worst;
  };
  return {true, fmt::format("At most {:.2f} µm before, {:.2f} after.",
                            most(&host::BeforeAfter::before), most(&host::BeforeAfter::after))};
}

}  // namespace volcomp::any_machine
