#include "host_sim/host/measure/whole_way/uncertain_campaign.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

const RunsFile& runs_with_letter(const std::vector<RunsFile>& runs, char letter) {
  const auto found = std::find_if(runs.begin(), runs.end(),
                                  [letter](const RunsFile& file) { return file.letter == letter; });
  if (found == runs.end()) throw UserError(fmt::format("no runs given for axis {}", letter));
  return *found;
}

RunValues mean_run(const std::vector<RunValues>& runs) {
  RunValues mean(runs.front().size(), ErrorMotion(ErrorMotion::Zero()));
  for (std::size_t t = 0; t < mean.size(); ++t) {
    for (const RunValues& run : runs)
      mean[t] += run[t];
    mean[t] /= static_cast<double>(runs.size());
  }
  return mean;
}

RunsFile means_of(const RunsFile& runs) {
  RunsFile means;
  means.name = runs.name;
  means.letter = runs.letter;
  means.positions = runs.positions;
  if (!runs.up.empty()) means.up = {mean_run(runs.up)};
  if (!runs.down.empty()) means.down = {mean_run(runs.down)};
  return means;
}

// A draw of a lever that is 0 may come so near to 0 that check_runs() takes it for one in metres;
// at 1 mm the angles of a machine are hundredths of a micrometre.
Vec3 clear_of_metres(const Vec3& lever) {
  constexpr double kLeast = 1.0;
  Eigen::Index largest = 0;
  const double longest = lever.cwiseAbs().maxCoeff(&largest);
  if (longest >= kLeast || !(longest > 0.0)) return lever;
  Vec3 moved = lever;
  moved(largest) = std::copysign(kLeast, lever(largest));
  return moved;
}

}  // namespace

UncertainCampaign::UncertainCampaign(const MachineFile& machine, const std::vector<RunsFile>& runs,
                                     const CampaignStatement& stated)
    : nominal_{machine, {}} {
  require_fitting(stated, machine);
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const RunsFile& file = runs_with_letter(runs, machine.axes[a].letter);
    nominal_.runs.push_back(means_of(file));
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
      const std::optional<double> sigma =
          c < 3 ? (stated.reading_um ? std::optional(*stated.reading_um / kUmPerMm) : std::nullopt)
                : (stated.reading_urad ? std::optional(*stated.reading_urad * kPerMillion)
                                       : std::nullopt);
      channels_.push_back({a, c, ChannelNoise(file, c, sigma), 0});
    }
  }
  add_readings();
  add_instrument(stated);
  add_set_ups(stated);
  add_locations(stated);
  add_levers(stated);
  add_squareness(stated);
  note_missing(stated);
}

void UncertainCampaign::add_readings() {
  for (std::size_t a = 0; a < nominal_.runs.size(); ++a) {
    const char letter = nominal_.runs[a].letter;
    std::vector<std::string> unknown;
    for (Channel& channel : channels_) {
      if (channel.axis != a) continue;
      channel.first = inputs_.size();
      if (channel.noise.from() == ChannelNoise::From::nothing) {
        unknown.push_back(fmt::format("{}{}", kChannels.at(channel.channel), letter));
        continue;
      }
      for (std::size_t j = 0; j < channel.noise.columns(); ++j) {
        const double deviation = channel.noise.deviation(j);
        inputs_.push_back({fmt::format("readings of {}", letter), deviation, 0.0, deviation});
      }
    }
    if (unknown.empty()) continue;
    drawn_as_zero_.push_back(
        fmt::format("readings of {} (reading_um, reading_urad): its runs do not tell how far they "
                    "scatter",
                    fmt::join(unknown, ", ")));
  }
}

void UncertainCampaign::note_missing(const CampaignStatement& stated) {
  for (const CampaignField& field : campaign_fields()) {
    const bool of_readings = field.member == &CampaignStatement::reading_um ||
                             field.member == &CampaignStatement::reading_urad;
    const bool of_growth = field.member == &CampaignStatement::expansion_um_per_m_K;
    if (of_readings || of_growth || stated.*field.member) continue;
    if (!applies(field, nominal_.machine)) continue;
    drawn_as_zero_.push_back(fmt::format("{} ({})", field.name, field.key));
  }
}

std::vector<double> UncertainCampaign::draw(std::uint64_t seed, std::uint32_t number) const {
  std::vector<double> values(inputs_.size());
  std::vector<double> noise;
  for (const Channel& channel : channels_) {
    if (channel.noise.from() == ChannelNoise::From::nothing) continue;
    const auto set_up =
        static_cast<std::uint32_t>(kChannels.size() * channel.axis + channel.channel);
    channel.noise.draw(seed, number, set_up, noise);
    std::copy(noise.begin(), noise.end(),
              values.begin() + static_cast<std::ptrdiff_t>(channel.first));
  }
  for (const Drawn& one : drawn_) {
    RandomIndex at = one.at;
    at.draw = number;
    if (one.cosine > 0.0) {
      const double angle = one.cosine * (2.0 * uniforms(seed, at).u - 1.0);
      values[one.input] = 0.5 * angle * angle;
    } else {
      values[one.input] = inputs_[one.input].deviation * normal(seed, at);
    }
  }
  return values;
}

void UncertainCampaign::set_readings(const std::vector<double>& inputs,
                                     MeasuredCampaign& out) const {
  for (std::size_t a = 0; a < out.runs.size(); ++a) {
    out.runs[a].up = nominal_.runs[a].up;
    out.runs[a].down = nominal_.runs[a].down;
  }
  const auto add = [&](std::size_t axis, std::size_t channel, std::size_t column, double value) {
    RunsFile& runs = out.runs[axis];
    const std::size_t up = runs.up.empty() ? 0 : runs.positions.size();
    ErrorMotion& reading = column < up ? runs.up.front()[column] : runs.down.front()[column - up];
    reading(static_cast<Eigen::Index>(channel)) += value;
  };
  for (const Channel& channel : channels_) {
    if (channel.noise.from() == ChannelNoise::From::nothing) continue;
    for (std::size_t j = 0; j < channel.noise.columns(); ++j)
      add(channel.axis, channel.channel, j, inputs[channel.first + j]);
  }
  for (const Shift& shift : shifts_) {
    for (std::size_t j = 0; j < shift.per_unit.size(); ++j)
      add(shift.axis, shift.channel, j, inputs[shift.input] * shift.per_unit[j]);
  }
}

void UncertainCampaign::set(const std::vector<double>& inputs, MeasuredCampaign& out) const {
  set_readings(inputs, out);
  for (const auto& [first, axis] : levers_) {
    const Vec3 error(inputs[first], inputs[first + 1], inputs[first + 2]);
    out.machine.axes[axis].sensed.at_zero =
        clear_of_metres(nominal_.machine.axes[axis].sensed.at_zero + error);
  }
  for (const Location& l : locations_)
    out.machine.axes[l.axis].at_reference(l.component) =
        nominal_.machine.axes[l.axis].at_reference(l.component) + inputs[l.input];
  if (squareness_ == SIZE_MAX) return;
  const XyfzSquareness& s = nominal_.machine.squareness->measured;
  out.machine.squareness->measured = {s.a_xy + inputs[squareness_],
                                      s.a_xz + inputs[squareness_ + 1],
                                      s.a_yz + inputs[squareness_ + 2]};
}

}  // namespace volcomp::host
