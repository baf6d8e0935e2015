#include "host_sim/host/measure/probe_settings.hpp"

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "firmware/node/object_handles.hpp"
#include "host_sim/host/io/rounded.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/report_parts.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr std::size_t kOfRadius = 0;
constexpr std::size_t kOfRepeatability = 3;
constexpr double kExpanded = 2.0;  // k

NodeSetting setting_of(const canopen::object_lines::Handle<double>& object, double mm,
                       const std::string& which = "") {
  return {object.index, object.sub, object.name + which, kNmPerMm * mm, "nm"};
}

std::string object_text(const NodeSetting& s) {
  return fmt::format("{:04X}h:{:02X}", s.index, s.sub);
}

const char* shape_name(ArtefactShape shape) {
  return shape == ArtefactShape::sphere ? "sphere" : "ring";
}

std::string unknown_terms(const ProbeCalibration& c) {
  std::vector<std::size_t> unknown;
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    if ((c.known >> k & 1U) == 0) unknown.push_back(k + 1);
  return unknown.empty() ? "" : fmt::format("{}", fmt::join(unknown, " "));
}

std::string uncertainty_method(const ProbeCalibration& c, const ProbeArtefact& artefact) {
  return fmt::format(
      "uncertainty: k = 2, from the residuals, {} touches less {} parameters; {}", c.touches,
      c.parameters,
      artefact.expanded_um
          ? fmt::format("diameter of the artefact ± {:g} µm (k = 2)", *artefact.expanded_um)
          : "left out: that of the diameter of the artefact");
}

json settings_table(const ProbeCalibration& c) {
  json rows = json::array();
  for (const NodeSetting& s : probe_settings(c))
    rows.push_back({object_text(s), s.value, s.unit, s.name});
  return table_section("",
                       {plain_column("object", "object"), column("value", "", 3, "value"),
                        plain_column("unit", "unit"), plain_column("name", "name")},
                       rows);
}

}  // namespace

std::vector<NodeSetting> probe_settings(const ProbeCalibration& calibration) {
  std::vector<NodeSetting> settings;
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    settings.push_back(
        setting_of(node::object::probe::lobing[k], calibration.radius.coefficient[k]));
  settings.push_back(setting_of(node::object::probe::uncertainty[kOfRadius], calibration.u_map,
                                ": effective radius"));
  settings.push_back(setting_of(node::object::probe::uncertainty[kOfRepeatability],
                                calibration.repeatability, ": repeatability"));
  return settings;
}

std::string settings_toml(const std::vector<NodeSetting>& settings, const std::string& about) {
  std::string text = fmt::format("# {}\n", about);
  for (const NodeSetting& s : settings)
    text += fmt::format(
        "\n[[setting]]\nobject = \"{}\"\nname = \"{}\"\nvalue = {:.4f}\nunit = \"{}\"\n",
        object_text(s), s.name, rounded(s.value, 4), s.unit);
  return text;
}

std::string calibration_title(const ProbeCalibration& calibration, const ProbeArtefact& artefact) {
  return fmt::format("{} touches of a {} of {:g} mm diameter", calibration.touches,
                     shape_name(artefact.shape), artefact.diameter_mm);
}

std::string calibration_text(const ProbeCalibration& c, const ProbeArtefact& artefact) {
  std::vector<std::pair<std::string, std::string>> lines{
      {"effective radius", fmt::format("{:.6f} mm ± {:.3f} µm", c.radius.coefficient[0],
                                       kExpanded * kUmPerMm * c.u_effective)}};
  if (c.most_radius > c.least_radius)
    lines.emplace_back(
        "by direction",
        fmt::format("{:.6f} … {:.6f} mm where touched, lobing {:.3f} µm, ± {:.3f} µm",
                    c.least_radius, c.most_radius, kUmPerMm * (c.most_radius - c.least_radius),
                    kExpanded * kUmPerMm * c.u_map));
  lines.emplace_back("repeatability", fmt::format("{:.3f} µm, standard deviation of a touch",
                                                  kUmPerMm * c.repeatability));
  lines.emplace_back("largest residual",
                     fmt::format("{:.3f} µm, line {}", kUmPerMm * c.largest, c.worst_line));
  lines.emplace_back("artefact", fmt::format("at {:.4f} {:.4f} {:.4f} mm", rounded(c.centre(0), 4),
                                             rounded(c.centre(1), 4), rounded(c.centre(2), 4)));
  std::vector<std::string> remarks{uncertainty_method(c, artefact)};
  if (const std::string unknown = unknown_terms(c); !unknown.empty())
    remarks.push_back("coefficients that stay 0: " + unknown);
  return text_of_sections({text_section("", {calibration_title(c, artefact)}),
                           list_section("", lines), text_section("", remarks), settings_table(c)});
}

json calibration_json(const ProbeCalibration& c, const ProbeArtefact& artefact) {
  json known = json::array();
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    known.push_back((c.known >> k & 1U) != 0);
  return {{"artefact", shape_name(artefact.shape)},
          {"diameter_mm", artefact.diameter_mm},
          {"diameter_U_um", artefact.expanded_um ? json(*artefact.expanded_um) : json()},
          {"touches", c.touches},
          {"parameters", c.parameters},
          {"effective_radius_mm", c.radius.coefficient[0]},
          {"effective_radius_U_um", kExpanded * kUmPerMm * c.u_effective},
          {"lobing_mm", c.radius.coefficient},
          {"lobing_known", known},
          {"lobing_range_um", kUmPerMm * (c.most_radius - c.least_radius)},
          {"lobing_U_um", kExpanded * kUmPerMm * c.u_map},
          {"repeatability_um", kUmPerMm * c.repeatability},
          {"largest_residual_um", kUmPerMm * c.largest},
          {"largest_residual_line", c.worst_line},
          {"centre_mm", {c.centre(0), c.centre(1), c.centre(2)}},
          {"coverage_factor", kExpanded},
          {"settings", figures_of_table(settings_table(c))}};
}

}  // namespace volcomp::host
