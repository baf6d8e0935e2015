#pragma once
// What is known of the instruments of a campaign beyond the scatter of its runs. Nothing has a
// default: what is not stated is drawn as 0 and named.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Standard uncertainties (1 σ) but for the limits of the cosine error. Empty: not stated.
struct CampaignStatement {
  // Of one reading, for channels whose runs do not tell how far they scatter.
  std::optional<double> reading_um;
  std::optional<double> reading_urad;
  // Common to all linear axes, once a campaign.
  std::optional<double> scale_um_per_m;
  std::optional<double> straightness_gain_percent;
  std::optional<double> angle_gain_percent;
  std::optional<double> roll_urad;  // over the travel
  // Of each axis, whose measurement is a set-up of its own.
  std::optional<double> slope_urad;            // of the beam, in each straightness
  std::optional<double> straightness_wave_um;  // amplitude of one wave over the travel
  std::optional<double> angle_wave_urad;
  std::optional<double> cosine_mrad;  // ± limits of the angle between beam and travel
  std::optional<double> growth_K;     // of the axis since the campaign began
  std::optional<double> expansion_um_per_m_K;
  // Of each rotary axis: its error where the runs count as zero, `error_at_reference`.
  std::optional<double> location_um;      // each of the three lengths
  std::optional<double> location_urad;    // each of the two tilts
  std::optional<double> zero_urad;        // the angle about the axis itself
  std::optional<double> lever_mm;         // each component of each sensed point
  std::optional<double> squareness_urad;  // each of the three of [squareness]

  // Values of `other` where it has them, else those of this.
  [[nodiscard]] CampaignStatement overridden_by(const CampaignStatement& other) const;
};

// What a machine needs to have for a statement to be about it.
enum class StatedOf : std::uint8_t { any_axis, linear_axes, rotary_axes, squareness };

// A key of the file, which is an option of the command with - for _, and its meaning in words.
struct CampaignField {
  const char* key;
  std::optional<double> CampaignStatement::*member;
  StatedOf of;
  const char* name;  // short
  const char* meaning;
};
inline constexpr std::size_t kCampaignFields = 17;
[[nodiscard]] const std::array<CampaignField, kCampaignFields>& campaign_fields();

// The table [campaign] of a TOML file. Throws UserError: unknown key, number that is negative or
// not finite.
[[nodiscard]] CampaignStatement parse_campaign(const std::string& text, const std::string& name);
[[nodiscard]] CampaignStatement read_campaign_file(const std::filesystem::path& path);

// Whether the machine has what the field is about.
[[nodiscard]] bool applies(const CampaignField& field, const MachineFile& machine);

// Throws UserError for growth_K without expansion_um_per_m_K, or the other way round, and for a
// field that does not apply to the machine.
void require_fitting(const CampaignStatement& statement, const MachineFile& machine);

}  // namespace volcomp::host
