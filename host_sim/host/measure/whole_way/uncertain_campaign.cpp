#include "host_sim/host/measure/whole_way/uncertain_campaign.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kPerMillion = 1e-6;
constexpr double kPerThousand = 1e-3;
constexpr double kPerCent = 1e-2;

// Random numbers of a draw that are no readings. What is common to a set-up and to all of them
// counts downwards from kCommon (random_stream.hpp); a number once given is never given again.
enum class Number : std::uint32_t { scale, gain, roll = 6, slope, wave = 9, cosine = 21, lever };

RandomIndex of_set_up(std::size_t axis, Number number, std::uint32_t further = 0) {
  return {static_cast<std::uint32_t>(RandomStream::set_up), 0, static_cast<std::uint32_t>(axis),
          kCommon - static_cast<std::uint32_t>(number) - further};
}
RandomIndex of_instrument(Number number, std::uint32_t further = 0) {
  return of_set_up(kCommon, number, further);
}

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

struct UncertainCampaign::LinearAxis {
  std::size_t index = 0;
  char letter = '\0';
  std::size_t along = 0;  // channel
  std::array<std::size_t, 2> across{};
  std::vector<double> q;      // of every column, from the reference, mm
  std::vector<double> share;  // of the way from the first target to the last, 0…1
};

UncertainCampaign::UncertainCampaign(const MachineFile& machine, const std::vector<RunsFile>& runs,
                                     const CampaignStatement& stated)
    : nominal_{machine, {}} {
  require_complete(stated);
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
  for (const LinearAxis& axis : linear_axes())
    add_set_up(stated, axis);
  add_levers(stated);
  add_squareness(stated);
  note_missing(stated);
}

std::size_t UncertainCampaign::add_input(const UncertainInput& input, const RandomIndex& at) {
  inputs_.push_back(input);
  drawn_.push_back({inputs_.size() - 1, at, 0.0});
  return inputs_.size() - 1;
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

std::vector<UncertainCampaign::LinearAxis> UncertainCampaign::linear_axes() const {
  std::vector<LinearAxis> list;
  for (std::size_t a = 0; a < nominal_.machine.axes.size(); ++a) {
    const AxisFile& file = nominal_.machine.axes[a];
    if (file.rotary) continue;
    LinearAxis axis;
    axis.index = a;
    axis.letter = file.letter;
    axis.along = static_cast<std::size_t>(nominal_.machine.chain.axis(a).axis);
    axis.across = {(axis.along == 0) ? std::size_t{1} : std::size_t{0},
                   (axis.along == 2) ? std::size_t{1} : std::size_t{2}};
    const RunsFile& runs = nominal_.runs[a];
    const double first = runs.positions.front();
    const double travel = runs.positions.back() - first;
    for (const std::vector<RunValues>* direction : {&runs.up, &runs.down}) {
      for (std::size_t t = 0; !direction->empty() && t < runs.positions.size(); ++t) {
        axis.q.push_back(runs.positions[t] - file.reference);
        axis.share.push_back((runs.positions[t] - first) / travel);
      }
    }
    list.push_back(std::move(axis));
  }
  return list;
}

std::vector<double> UncertainCampaign::means(std::size_t axis, std::size_t channel) const {
  std::vector<double> values;
  const RunsFile& runs = nominal_.runs[axis];
  for (const std::vector<RunValues>* direction : {&runs.up, &runs.down}) {
    if (direction->empty()) continue;
    for (const ErrorMotion& mean : direction->front())
      values.push_back(mean(static_cast<Eigen::Index>(channel)));
  }
  return values;
}

// One number a draw for all axes: they are measured with the same instrument. Gains by what an
// instrument has: two straightness channels, roll, and two angles across.
void UncertainCampaign::add_instrument(const CampaignStatement& s) {
  const std::vector<LinearAxis> axes = linear_axes();
  if (axes.empty()) {
    if (s.scale_um_per_m || s.straightness_gain_percent || s.angle_gain_percent || s.roll_urad)
      throw UserError("scale, gains and roll are of linear axes, and the machine has none");
    return;
  }
  const auto add_gain = [&](const char* group, double gain, std::uint32_t number,
                            const auto& channel_of) {
    const std::size_t input =
        add_input({group, gain, 0.0, gain}, of_instrument(Number::gain, number));
    for (const LinearAxis& axis : axes) {
      const std::size_t channel = channel_of(axis);
      shifts_.push_back({input, axis.index, channel, means(axis.index, channel)});
    }
  };
  if (s.scale_um_per_m) {
    const double u = *s.scale_um_per_m * kPerMillion;
    const std::size_t input = add_input({"scale", u, 0.0, u}, of_instrument(Number::scale));
    for (const LinearAxis& axis : axes)
      shifts_.push_back({input, axis.index, axis.along, axis.q});
  }
  if (s.straightness_gain_percent) {
    const double u = *s.straightness_gain_percent * kPerCent;
    for (std::uint32_t k = 0; k < 2; ++k)
      add_gain("gain of straightness", u, k, [k](const LinearAxis& a) { return a.across.at(k); });
  }
  if (s.angle_gain_percent) {
    const double u = *s.angle_gain_percent * kPerCent;
    add_gain("gain of angles", u, 2, [](const LinearAxis& a) { return a.along + 3; });
    for (std::uint32_t k = 0; k < 2; ++k)
      add_gain("gain of angles", u, 3 + k, [k](const LinearAxis& a) { return a.across.at(k) + 3; });
  }
  if (s.roll_urad) {
    const double u = *s.roll_urad * kPerMillion;
    const std::size_t input = add_input({"roll", u, 0.0, u}, of_instrument(Number::roll));
    for (const LinearAxis& axis : axes)
      shifts_.push_back({input, axis.index, axis.along + 3, axis.share});
  }
}

// A sine and a cosine with half the variance each: a wave of any phase.
void UncertainCampaign::add_wave(double amplitude, const LinearAxis& axis, std::size_t channel) {
  const double u = amplitude / std::sqrt(2.0);
  const char* const group = channel < 3 ? "wave of straightness" : "wave of angles";
  for (std::uint32_t part = 0; part < 2; ++part) {
    const auto number = 2 * static_cast<std::uint32_t>(channel) + part;
    const std::size_t input =
        add_input({group, u, 0.0, u}, of_set_up(axis.index, Number::wave, number));
    std::vector<double> wave;
    for (const double share : axis.share)
      wave.push_back(part == 0 ? std::sin(2.0 * kPi * share) : std::cos(2.0 * kPi * share));
    shifts_.push_back({input, axis.index, channel, std::move(wave)});
  }
}

void UncertainCampaign::add_set_up(const CampaignStatement& s, const LinearAxis& axis) {
  if (s.slope_urad) {
    const double u = *s.slope_urad * kPerMillion;
    for (std::uint32_t k = 0; k < 2; ++k) {
      const std::size_t input =
          add_input({"slope of the beam", u, 0.0, u}, of_set_up(axis.index, Number::slope, k));
      shifts_.push_back({input, axis.index, axis.across.at(k), axis.q});
    }
  }
  for (const std::size_t across : axis.across)
    if (s.straightness_wave_um) add_wave(*s.straightness_wave_um / kUmPerMm, axis, across);
  for (std::size_t c = 3; c < kChannels.size(); ++c)
    if (s.angle_wave_urad) add_wave(*s.angle_wave_urad * kPerMillion, axis, c);
  if (s.cosine_mrad) {
    // Too short by φ²/2 of the way, φ anywhere within the limits ± f: between 0 and f²/2.
    const double limit = *s.cosine_mrad * kPerThousand;
    const double deviation = limit * limit / std::sqrt(45.0);
    const std::size_t input = add_input({"cosine error", deviation, limit * limit / 6.0, deviation},
                                        of_set_up(axis.index, Number::cosine));
    drawn_.back().cosine = limit;
    std::vector<double> shorter = axis.q;
    for (double& q : shorter)
      q = -q;
    shifts_.push_back({input, axis.index, axis.along, std::move(shorter)});
  }
  if (s.growth_K) {
    const double u = *s.growth_K * *s.expansion_um_per_m_K * kPerMillion;
    const std::size_t input =
        add_input({"growth", u, 0.0, u}, {static_cast<std::uint32_t>(RandomStream::temperature), 0,
                                          static_cast<std::uint32_t>(axis.index), kCommon});
    shifts_.push_back({input, axis.index, axis.along, axis.q});
  }
}

void UncertainCampaign::add_levers(const CampaignStatement& s) {
  if (!s.lever_mm) return;
  constexpr double kLeastStep = 2.0;  // clear of the millimetre that is taken for metres
  for (std::size_t a = 0; a < nominal_.machine.axes.size(); ++a) {
    levers_.emplace_back(inputs_.size(), a);
    for (std::uint32_t k = 0; k < 3; ++k)
      add_input({"levers", *s.lever_mm, 0.0, std::max(*s.lever_mm, kLeastStep)},
                of_set_up(a, Number::lever, k));
  }
}

void UncertainCampaign::add_squareness(const CampaignStatement& s) {
  if (!s.squareness_urad) return;
  if (!nominal_.machine.squareness)
    throw UserError(fmt::format("squareness_urad: {} has no [squareness]", nominal_.machine.path));
  squareness_ = inputs_.size();
  const double u = *s.squareness_urad * kPerMillion;
  for (std::uint32_t k = 0; k < 3; ++k)
    add_input({"squareness", u, 0.0, u},
              {static_cast<std::uint32_t>(RandomStream::ball_bar), 0, k, kCommon});
}

void UncertainCampaign::note_missing(const CampaignStatement& stated) {
  for (const CampaignField& field : campaign_fields()) {
    const bool of_readings = field.member == &CampaignStatement::reading_um ||
                             field.member == &CampaignStatement::reading_urad;
    const bool of_growth = field.member == &CampaignStatement::expansion_um_per_m_K;
    const bool of_squareness = field.member == &CampaignStatement::squareness_urad;
    if (of_readings || of_growth || stated.*field.member) continue;
    if (of_squareness && !nominal_.machine.squareness) continue;
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
  if (squareness_ == SIZE_MAX) return;
  const XyfzSquareness& s = nominal_.machine.squareness->measured;
  out.machine.squareness->measured = {s.a_xy + inputs[squareness_],
                                      s.a_xz + inputs[squareness_ + 1],
                                      s.a_yz + inputs[squareness_ + 2]};
}

}  // namespace volcomp::host
