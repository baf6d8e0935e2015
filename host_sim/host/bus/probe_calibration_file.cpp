#include "host_sim/host/bus/probe_calibration_file.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// Where the value of an object goes, and how large it can be.
struct Target {
  std::string object;
  double* value_mm = nullptr;
  double least_nm = 0.0;
  bool given = false;
};

std::vector<Target> targets_in(NodeProbe& probe) {
  std::vector<Target> targets;
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    targets.push_back({fmt::format("2302h:{:02X}", k + 1), &probe.radius.coefficient.at(k),
                       k == 0 ? 0.0 : -kMaxBallRadius_nm});
  targets.push_back({"2304h:01", &probe.radius_uncertainty, 0.0});
  targets.push_back({"2304h:04", &probe.repeatability, 0.0});
  return targets;
}

void read_setting(const TomlSection& setting, std::vector<Target>& targets) {
  setting.allow_only({"object", "name", "value", "unit"});
  const std::string object = setting.text("object");
  const auto target = std::find_if(targets.begin(), targets.end(),
                                   [&](const Target& t) { return t.object == object; });
  if (target == targets.end())
    setting.complain("object", "must be one of 2302h:01 to 2302h:10, 2304h:01 and 2304h:04");
  if (target->given) setting.complain("object", "is set twice");
  if (setting.text("unit") != "nm") setting.complain("unit", "must be nm");
  const double nm = setting.number("value");
  if (nm < target->least_nm || nm > kMaxBallRadius_nm)
    setting.complain("value", fmt::format("must be from {:g} to {:g} nm [out_of_range]",
                                          target->least_nm, kMaxBallRadius_nm));
  *target->value_mm = nm / kNmPerMm;
  target->given = true;
}

}  // namespace

void read_probe_calibration(const std::string& text, const std::string& name, NodeProbe& probe) {
  probe = read_toml(text, name, [&](const TomlValue& top) {
    NodeProbe read = probe;
    std::vector<Target> targets = targets_in(read);
    const TomlSection file(top, name, "the file of settings");
    file.allow_only({"setting"});
    for (const TomlSection& setting : file.tables("setting"))
      read_setting(setting, targets);
    for (const Target& target : targets) {
      if (!target.given)
        throw UserError(fmt::format("{}: lacks the setting {} [{}]", name, target.object,
                                    code(Reason::missing_field)));
    }
    return read;
  });
}

void read_probe_calibration(const std::filesystem::path& path, NodeProbe& probe) {
  read_probe_calibration(text_of_file(path), path.string(), probe);
}

}  // namespace volcomp::host
