#pragma once
// A campaign as it may have been: machine file and runs, with everything that is uncertain about
// them as a list of independent numbers.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/whole_way/campaign_statement.hpp"
#include "host_sim/host/measure/whole_way/channel_noise.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host {

inline constexpr double kPerMillion = 1e-6;  // µrad, µm/m as stated

// One uncertain number. Its unit is that of what it acts on: mm, rad, mm/mm, parts of a gain.
struct UncertainInput {
  std::string group;       // what it belongs to: "readings of X", "scale"
  double deviation = 0.0;  // standard deviation of what is drawn
  double mean = 0.0;       // of what is drawn; 0 but for the cosine error
  double step = 0.0;       // of a central difference
};

// What build_tables() takes: one run for each direction, the means.
struct MeasuredCampaign {
  MachineFile machine;
  std::vector<RunsFile> runs;
};

class UncertainCampaign {
 public:
  // `runs`: one file per axis, which build_tables() accepts with this machine. Throws UserError as
  // require_fitting().
  UncertainCampaign(const MachineFile& machine, const std::vector<RunsFile>& runs,
                    const CampaignStatement& stated);

  [[nodiscard]] const std::vector<UncertainInput>& inputs() const { return inputs_; }
  // What is not stated and not known from runs, in words.
  [[nodiscard]] const std::vector<std::string>& drawn_as_zero() const { return drawn_as_zero_; }

  [[nodiscard]] const MeasuredCampaign& nominal() const { return nominal_; }
  // All inputs of one draw.
  [[nodiscard]] std::vector<double> draw(std::uint64_t seed, std::uint32_t number) const;
  // What the campaign would have found: the means with these inputs as errors added. `out` is a
  // copy of nominal(), set before or not.
  void set(const std::vector<double>& inputs, MeasuredCampaign& out) const;

 private:
  // Noise of the readings of a channel: as many inputs as columns, from `first` on.
  struct Channel {
    std::size_t axis = 0;
    std::size_t channel = 0;
    ChannelNoise noise;
    std::size_t first = 0;
  };
  // An input that adds itself times `per_unit` to the columns of a channel.
  struct Shift {
    std::size_t input = 0;
    std::size_t axis = 0;
    std::size_t channel = 0;
    std::vector<double> per_unit;
  };
  // How an input that is no reading is drawn.
  struct Drawn {
    std::size_t input = 0;
    RandomIndex at;
    double cosine = 0.0;  // limit of the angle, rad; 0: normal
  };
  // An input that adds itself to a component of the error of an axis at its reference.
  struct Location {
    std::size_t input = 0;
    std::size_t axis = 0;
    Eigen::Index component = 0;
  };
  // An axis that a linear instrument measures: what its columns are.
  struct LinearAxis;

  void add_readings();
  void add_instrument(const CampaignStatement& stated);
  void add_set_ups(const CampaignStatement& stated);
  void add_set_up(const CampaignStatement& stated, const LinearAxis& axis);
  void add_wave(double amplitude, const LinearAxis& axis, std::size_t channel);
  void add_locations(const CampaignStatement& stated);
  void add_levers(const CampaignStatement& stated);
  void add_squareness(const CampaignStatement& stated);
  void note_missing(const CampaignStatement& stated);
  std::size_t add_input(const UncertainInput& input, const RandomIndex& at);
  [[nodiscard]] std::vector<LinearAxis> linear_axes() const;
  [[nodiscard]] std::vector<double> means(std::size_t axis, std::size_t channel) const;
  void set_readings(const std::vector<double>& inputs, MeasuredCampaign& out) const;

  MeasuredCampaign nominal_;
  std::vector<UncertainInput> inputs_;
  std::vector<std::string> drawn_as_zero_;
  std::vector<Channel> channels_;
  std::vector<Shift> shifts_;
  std::vector<Drawn> drawn_;
  std::vector<Location> locations_;
  std::vector<std::pair<std::size_t, std::size_t>> levers_;  // first of three inputs, axis
  std::size_t squareness_ = SIZE_MAX;                        // first of three inputs
};

}  // namespace volcomp::host
