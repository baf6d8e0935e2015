#include "host_sim/experiments/any_machine/figures.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "host_sim/host/machine/chain_string.hpp"

namespace volcomp::any_machine {
namespace {

using nlohmann::json;

constexpr double kUrad = 1e6;

struct Allowed {
  double share;  // of what it was
  double um;
};
constexpr Allowed kWithoutNoise{0.1, 1.0};
constexpr Allowed kWithNoise{0.5, 5.0};

struct Compared {
  std::string name;
  double before_um = 0.0;
  double after_um = 0.0;

  [[nodiscard]] bool good(const Allowed& allowed) const {
    return after_um <= std::max(allowed.um, allowed.share * before_um);
  }
};

std::vector<Compared> compared(const MachineResult& r) {
  std::vector<Compared> rows;
  for (std::size_t i = 0; i < r.before.line.size(); ++i)
    rows.push_back({"diagonal " + r.before.line[i].name, r.before.line[i].max_abs_um,
                    r.after.line[i].max_abs_um});
  if (!r.before.place.empty())
    rows.push_back({"volume", r.before.volume.max_um, r.after.volume.max_um});
  if (!r.before.sphere.empty())
    rows.push_back({"sphere", r.before.sphere_um().max_um, r.after.sphere_um().max_um});
  if (r.machine.chain.description().orienting_count != 0)
    rows.push_back({"tool direction", r.steerable_um(r.before), r.steerable_um(r.after)});
  return rows;
}

json volume_json(const host::VolumeFigures& f) {
  return {{"max_um", f.max_um}, {"rms_um", f.rms_um}};
}

json orientation_json(const MachineResult& r, const MachineState& s) {
  return {{"max_urad", kUrad * s.tilt_max_rad()},
          {"rms_urad", kUrad * s.tilt_rms_rad()},
          {"effect_um", r.effect_um(s)},
          {"within_reach_urad", kUrad * s.steerable_max_rad()},
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
  return figures;
}

std::string machine_summary(const MachineResult& r) {
  std::string text = fmt::format("{}, {}, seed {}, {}; {} correct{}\n", r.machine.name,
                                 host::chain_text(r.machine.chain), r.options.seed,
                                 r.options.noise ? "realistic instruments" : "no noise",
                                 correcting_letters(r.machine),
                                 r.machine.chain.description().correcting_count == 1 ? "s" : "");
  text += fmt::format("{:16} {:>10} {:>10}\n", "largest [µm]", "before", "after");
  for (const Compared& row : compared(r))
    text += fmt::format("{:16} {:10.2f} {:10.2f}\n", row.name, row.before_um, row.after_um);
  if (r.before.sphere.empty()) {
    text += "no sphere test: no rotary axis that three other axes can follow\n";
  } else {
    const Vec3& b = r.sphere.ball;
    text += fmt::format("ball at {:.1f} {:.1f} {:.1f} mm on the table, {} positions", b.x(), b.y(),
                        b.z(), r.sphere.poses.size());
    text += r.sphere.left_out > 0 ? fmt::format(", {} out of reach\n", r.sphere.left_out) : "\n";
  }
  text += fmt::format(
      "orientation of the tool: {:.1f} µrad before, {:.1f} after; for a tool {:g} mm longer {:.2f} "
      "um before, {:.2f} after\n",
      kUrad * r.before.tilt_max_rad(), kUrad * r.after.tilt_max_rad(), r.options.tool_length_mm,
      r.effect_um(r.before), r.effect_um(r.after));
  if (const std::string orienting = orienting_letters(r.machine); !orienting.empty())
    text += fmt::format(
        "where {} have their grip on it: {:.1f} µrad before, {:.1f} after (tool direction above: "
        "at {:g} mm)\n",
        orienting, kUrad * r.before.steerable_max_rad(), kUrad * r.after.steerable_max_rad(),
        r.options.tool_length_mm);
  const host::Verdict verdict = machine_verdict(r);
  return text + fmt::format("{} {}\n", verdict.ok ? "PASS" : "FAIL", verdict.text);
}

host::Verdict machine_verdict(const MachineResult& r) {
  const std::vector<Compared> rows = compared(r);
  if (rows.empty()) return {false, "Nothing could be measured."};
  const Allowed& allowed = r.options.noise ? kWithNoise : kWithoutNoise;
  const auto bad = std::find_if_not(rows.begin(), rows.end(),
                                    [&](const Compared& c) { return c.good(allowed); });
  if (bad != rows.end())
    return {
        false,
        fmt::format("{}: {:.2f} µm before, {:.2f} after; more than {:g} µm and more than "
                    "{:g} % are left.",
                    bad->name, bad->before_um, bad->after_um, allowed.um, 100.0 * allowed.share)};
  const auto most = [&](double Compared::*value) {
    double worst = 0.0;
    for (const Compared& row : rows)
      worst = std::max(worst, row.*value);
    return worst;
  };
  return {true, fmt::format("At most {:.2f} µm before, {:.2f} after.", most(&Compared::before_um),
                            most(&Compared::after_um))};
}

}  // namespace volcomp::any_machine
