#include "host_sim/host/measure/whole_way/campaign_statement.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

namespace {

const char* in_words(StatedOf what) {
  switch (what) {
    case StatedOf::linear_axes:
      return "linear axis";
    case StatedOf::rotary_axes:
      return "rotary axis";
    case StatedOf::squareness:
      return "[squareness]";
    case StatedOf::any_axis:
      break;
  }
  return "axis";
}

}  // namespace

const std::array<CampaignField, kCampaignFields>& campaign_fields() {
  using S = CampaignStatement;
  static constexpr std::array<CampaignField, kCampaignFields> kFields{{
      {"reading_um", &S::reading_um, StatedOf::any_axis, "reading, lengths",
       "One reading of a length, µm, where runs do not tell (1 σ)"},
      {"reading_urad", &S::reading_urad, StatedOf::any_axis, "reading, angles",
       "One reading of an angle, µrad, where runs do not tell (1 σ)"},
      {"scale_um_per_m", &S::scale_um_per_m, StatedOf::linear_axes, "scale",
       "Scale of the instrument, µm/m, common to all linear axes (1 σ)"},
      {"straightness_gain_percent", &S::straightness_gain_percent, StatedOf::linear_axes,
       "gain of straightness",
       "Gain of each straightness channel, percent, common to all linear axes (1 σ)"},
      {"angle_gain_percent", &S::angle_gain_percent, StatedOf::linear_axes, "gain of angles",
       "Gain of each angle channel, percent, common to all linear axes (1 σ)"},
      {"roll_urad", &S::roll_urad, StatedOf::linear_axes, "roll",
       "Roll of the instrument over the travel, µrad, common to all linear axes (1 σ)"},
      {"slope_urad", &S::slope_urad, StatedOf::linear_axes, "slope of the beam",
       "Slope of the beam in each straightness of an axis, µrad (1 σ)"},
      {"straightness_wave_um", &S::straightness_wave_um, StatedOf::linear_axes,
       "wave of straightness",
       "Amplitude of one wave over the travel in each straightness of an axis, µm (1 σ)"},
      {"angle_wave_urad", &S::angle_wave_urad, StatedOf::linear_axes, "wave of angles",
       "Amplitude of one wave over the travel in each angle of an axis, µrad (1 σ)"},
      {"cosine_mrad", &S::cosine_mrad, StatedOf::linear_axes, "cosine error",
       "Limits (±) of the angle between beam and travel, mrad"},
      {"growth_K", &S::growth_K, StatedOf::linear_axes, "growth",
       "Change of the temperature of an axis until it is measured, K (1 σ); with "
       "--expansion-um-per-m-K"},
      {"expansion_um_per_m_K", &S::expansion_um_per_m_K, StatedOf::linear_axes, "expansion",
       "Thermal expansion of the axes, µm/(m K); with --growth-K"},
      {"location_um", &S::location_um, StatedOf::rotary_axes, "location of rotary axes, lengths",
       "Each length of the error of a rotary axis at its reference, µm (1 σ)"},
      {"location_urad", &S::location_urad, StatedOf::rotary_axes, "location of rotary axes, tilts",
       "Each tilt of a rotary axis at its reference, µrad (1 σ)"},
      {"zero_urad", &S::zero_urad, StatedOf::rotary_axes, "zero of rotary axes",
       "Angle of a rotary axis about itself at its reference, µrad (1 σ)"},
      {"lever_mm", &S::lever_mm, StatedOf::any_axis, "levers",
       "Each component of each sensed point of the machine file, mm (1 σ)"},
      {"squareness_urad", &S::squareness_urad, StatedOf::squareness, "squareness",
       "Each squareness of the machine file, µrad (1 σ)"},
  }};
  return kFields;
}

CampaignStatement CampaignStatement::overridden_by(const CampaignStatement& other) const {
  CampaignStatement both = *this;
  for (const CampaignField& f : campaign_fields()) {
    if (other.*f.member) both.*f.member = other.*f.member;
  }
  return both;
}

CampaignStatement parse_campaign(const std::string& text, const std::string& name) {
  return read_toml(text, name, [&name](const TomlValue& top) {
    const TomlSection all(top, name, "the file");
    all.allow_only({"campaign"});
    const TomlSection section = all.table("campaign");
    std::vector<std::string> keys;
    keys.reserve(kCampaignFields);
    for (const CampaignField& f : campaign_fields())
      keys.emplace_back(f.key);
    section.allow_only(keys);
    CampaignStatement s;
    for (const CampaignField& f : campaign_fields()) {
      if (!section.has(f.key)) continue;
      const double value = section.number(f.key);
      if (value < 0.0) section.complain(f.key, fmt::format("'{}' must not be negative", f.key));
      s.*f.member = value;
    }
    return s;
  });
}

CampaignStatement read_campaign_file(const std::filesystem::path& path) {
  return parse_campaign(text_of_file(path), shown_name(path));
}

bool applies(const CampaignField& field, const MachineFile& machine) {
  const auto has_axis = [&](bool rotary) {
    return std::any_of(machine.axes.begin(), machine.axes.end(),
                       [rotary](const AxisFile& axis) { return axis.rotary == rotary; });
  };
  switch (field.of) {
    case StatedOf::linear_axes:
      return has_axis(false);
    case StatedOf::rotary_axes:
      return has_axis(true);
    case StatedOf::squareness:
      return machine.squareness.has_value();
    case StatedOf::any_axis:
      break;
  }
  return true;
}

void require_fitting(const CampaignStatement& s, const MachineFile& machine) {
  for (const CampaignField& f : campaign_fields()) {
    if ((s.*f.member) && !applies(f, machine))
      throw UserError(fmt::format("{}: {} has no {}", f.key, machine.path, in_words(f.of)));
  }
  if (s.growth_K.has_value() == s.expansion_um_per_m_K.has_value()) return;
  const bool grows = s.growth_K.has_value();
  throw UserError(fmt::format("campaign: {} needs {}, too",
                              grows ? "growth_K" : "expansion_um_per_m_K",
                              grows ? "expansion_um_per_m_K" : "growth_K"));
}

}  // namespace volcomp::host
