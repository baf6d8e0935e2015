#include "host_sim/cli/probe_option.hpp"

#include <map>
#include <string>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/machine/probe_class_names.hpp"

namespace volcomp::cli {

CLI::Option* add_probe_class(CLI::App& scenario, std::optional<std::size_t>& probe) {
  std::map<std::string, std::size_t> classes;
  std::string words;
  for (std::size_t i = 0; i < host::kProbeClassNames.size(); ++i) {
    classes[host::kProbeClassNames[i]] = i;
    words += (words.empty() ? "" : ",") + std::string(host::kProbeClassNames[i]);
  }
  return scenario
      .add_option("--probe", probe,
                  "Class of the touch probe: none, no errors; rmp600, 2σ = 0.5 µm; lp2, 2σ = 1 µm; "
                  "with lobing, hysteresis and bending as classes have them (default: as the "
                  "machine file says, else lp2)")
      ->transform(CLI::Transformer(classes, CLI::ignore_case).description("{" + words + "}"));
}

std::size_t probe_class_of(const std::filesystem::path& machine) {
  constexpr std::size_t kOfThePapers = 2;
  const host::MachineFile file = host::read_machine_file(machine);
  return file.probe ? file.probe->probe_class.value_or(kOfThePapers) : kOfThePapers;
}

}  // namespace volcomp::cli
