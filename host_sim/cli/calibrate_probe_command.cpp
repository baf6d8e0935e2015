// volcomp calibrate-probe

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/probe_settings.hpp"

namespace volcomp::cli {
namespace {

struct CalibrateArguments {
  std::string points;
  std::optional<double> sphere_mm;
  std::optional<double> ring_mm;
  std::string ring_axis = "Z";
  std::optional<double> artefact_um;
  bool constant = false;
  std::string out;
  std::string json_file;
};

host::ProbeArtefact artefact_of(const CalibrateArguments& a) {
  host::ProbeArtefact artefact;
  artefact.shape = a.ring_mm ? host::ArtefactShape::ring : host::ArtefactShape::sphere;
  artefact.diameter_mm = a.ring_mm ? *a.ring_mm : *a.sphere_mm;
  artefact.expanded_um = a.artefact_um;
  artefact.ring_axis = static_cast<Axis>(a.ring_axis[0] - 'X');
  return artefact;
}

int calibrate(const CalibrateArguments& a) {
  if (!a.sphere_mm && !a.ring_mm)
    throw host::UserError("what was touched? give --sphere or --ring with its diameter");
  Results results({a.out, a.json_file}, {a.points});
  const host::ProbeArtefact artefact = artefact_of(a);
  const host::ProbeCalibration calibration =
      host::calibrate_probe(host::read_touch_file(a.points), artefact,
                            a.constant ? host::ProbeModel::constant : host::ProbeModel::lobing);
  results.add(a.out, host::settings_toml(host::probe_settings(calibration),
                                         "Probe of a node, from " +
                                             host::calibration_title(calibration, artefact)));
  results.add(a.json_file, json_text(host::calibration_json(calibration, artefact)));
  results.write();
  fmt::print(results.text(), "{}", host::calibration_text(calibration, artefact));
  return 0;
}

}  // namespace

void add_calibrate_probe_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "calibrate-probe",
      "Effective radius and lobing map of a touch probe from touches of a sphere or a ring");
  auto a = std::make_shared<CalibrateArguments>();
  command
      ->add_option("POINTS", a->points,
                   "Centres of the ball in each touch (CSV): X [mm],Y [mm],Z [mm], and the normal "
                   "out of the part NX,NY,NZ or the approach AX,AY,AZ, tool frame")
      ->required();
  const CLI::Validator diameter = number_between(0.1, 1000.0);
  CLI::Option* sphere =
      command->add_option("--sphere", a->sphere_mm, "Diameter of the sphere, mm")->check(diameter);
  CLI::Option* ring =
      command
          ->add_option("--ring", a->ring_mm, "Inner diameter of the ring, mm, instead of a sphere")
          ->check(diameter)
          ->excludes(sphere);
  command->add_option("--ring-axis", a->ring_axis, "Axis of the ring in the coordinates")
      ->check(CLI::IsMember({"X", "Y", "Z"}))
      ->needs(ring)
      ->capture_default_str();
  command
      ->add_option("--artefact-um", a->artefact_um,
                   "Expanded uncertainty (k = 2) of the diameter, µm, from its certificate "
                   "(default: left out)")
      ->check(number_between(0.0, 1000.0));
  command->add_flag("--constant", a->constant, "One radius for all directions, no lobing map");
  command->add_option("--out", a->out,
                      "Write the settings of the node to this file (TOML; -: standard output)");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->callback([a, &code] { code = calibrate(*a); });
}

}  // namespace volcomp::cli
