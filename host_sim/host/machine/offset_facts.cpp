#include "host_sim/host/machine/offset_facts.hpp"

#include <fmt/format.h>

#include "comp/tick/offset_units.hpp"
#include "host_sim/host/machine/axis_kinds.hpp"
#include "host_sim/host/machine/compensator_settings.hpp"

namespace volcomp::host {
namespace {

std::string axis_text(const OffsetFacts& f) {
  const char* const unit = f.rotary ? "rad" : "mm";
  const double fine = f.rotary ? 1e6 : kUmPerMm;
  std::string text = fmt::format("offset of {}: at most {:.4g} {}/s", f.axis, f.rate, unit);
  if (f.by_setup > 0.0)
    return text + fmt::format(", any acceleration; setup allows {:.4g} {}/s2\n", f.by_setup, unit);
  if (f.units == 0) return text + ", any acceleration\n";
  text +=
      fmt::format(" and {:.4g} {}/s2 ({} per period and period)", f.acceleration, unit, f.units);
  if (f.effective_rate < f.rate)
    text += fmt::format("; {:.4g} {}/s are used, so that it can stop", f.effective_rate, unit);
  text += fmt::format("; without lag up to {:.4g} {}\n", fine * f.free, f.rotary ? "urad" : "um");
  if (f.coarse())
    text += fmt::format(
        "warning: below {} per period and period the acceleration of {} is up to half "
        "tighter than stated\n",
        kFineAcceleration, f.axis);
  return text;
}

}  // namespace

bool OffsetFacts::coarse() const { return units > 0 && units < kFineAcceleration; }

OffsetFacts offset_facts(char axis, bool rotary, const OffsetLimits& limits, double period_s) {
  const OffsetBounds bounds(limits);
  const double unit = 1.0 / offset_units(rotary);
  OffsetFacts f;
  f.axis = axis;
  f.rotary = rotary;
  f.rate = limits.rate * unit / period_s;
  f.effective_rate = bounds.rate * unit / period_s;
  f.units = bounds.none() ? 0 : bounds.acceleration;
  f.acceleration = f.units * unit / (period_s * period_s);
  f.free = bounds.free * unit;
  return f;
}

std::vector<OffsetFacts> offset_facts(const MachineFile& machine) {
  if (machine.axes.size() > kMostAxes) return {};
  const CorrectionFile& correction = machine.correction;
  const AxisKinds kinds = axis_kinds(machine.chain);
  const auto settings = compensator_settings(correction, kinds);
  std::vector<OffsetFacts> facts;
  for (const std::size_t a : axes_with_offsets(machine.chain.description())) {
    facts.push_back(offset_facts(machine.axes[a].letter, kinds.rotary.at(a), settings.axis.at(a),
                                 1.0 / correction.tick_hz));
    const OffsetAcceleration& acceleration = correction.acceleration.at(a);
    if (!acceleration.stated) facts.back().by_setup = acceleration.value;
  }
  return facts;
}

std::string offset_text(const std::vector<OffsetFacts>& facts) {
  std::string text;
  for (const OffsetFacts& f : facts)
    text += axis_text(f);
  return text;
}

nlohmann::json offset_json(const std::vector<OffsetFacts>& facts) {
  nlohmann::json all = nlohmann::json::array();
  for (const OffsetFacts& f : facts)
    all.push_back({{"axis", std::string(1, f.axis)},
                   {"unit", f.rotary ? "rad" : "mm"},
                   {"rate_per_s", f.rate},
                   {"effective_rate_per_s", f.effective_rate},
                   {"acceleration_per_s2", f.acceleration},
                   {"acceleration_per_period2", f.units},
                   {"coarse", f.coarse()},
                   {"free", f.free}});
  return all;
}

}  // namespace volcomp::host
