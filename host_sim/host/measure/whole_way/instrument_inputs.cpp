// What is stated of instruments and set-ups, as inputs of an uncertain campaign.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/whole_way/uncertain_campaign.hpp"

namespace volcomp::host {
namespace {

constexpr double kPerThousand = 1e-3;
constexpr double kPerCent = 1e-2;

// Random numbers of a draw that are no readings. What is common to a set-up and to all of them
// counts downwards from kCommon (random_stream.hpp); a number once given is never given again.
enum class Number : std::uint32_t {
  scale,
  gain,
  roll = 6,
  slope,
  wave = 9,
  cosine = 21,
  lever,
  location = 25
};

RandomIndex of_set_up(std::size_t axis, Number number, std::uint32_t further = 0) {
  return {static_cast<std::uint32_t>(RandomStream::set_up), 0, static_cast<std::uint32_t>(axis),
          kCommon - static_cast<std::uint32_t>(number) - further};
}
RandomIndex of_instrument(Number number, std::uint32_t further = 0) {
  return of_set_up(kCommon, number, further);
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

std::size_t UncertainCampaign::add_input(const UncertainInput& input, const RandomIndex& at) {
  inputs_.push_back(input);
  drawn_.push_back({inputs_.size() - 1, at, 0.0});
  return inputs_.size() - 1;
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

void UncertainCampaign::add_set_ups(const CampaignStatement& stated) {
  for (const LinearAxis& axis : linear_axes())
    add_set_up(stated, axis);
}

// What build_tables() puts back at the reference: with side = "moving" it turns with the axis.
void UncertainCampaign::add_locations(const CampaignStatement& s) {
  const auto add = [&](const std::optional<double>& stated, double unit, const char* group,
                       std::size_t axis, std::size_t component) {
    if (!stated) return;
    const double u = *stated * unit;
    const std::size_t input =
        add_input({group, u, 0.0, u},
                  of_set_up(axis, Number::location, static_cast<std::uint32_t>(component)));
    locations_.push_back({input, axis, static_cast<Eigen::Index>(component)});
  };
  for (std::size_t a = 0; a < nominal_.machine.axes.size(); ++a) {
    if (!nominal_.machine.axes[a].rotary) continue;
    const std::size_t about = 3 + index(nominal_.machine.chain.axis(a).axis);
    for (std::size_t c = 0; c < 3; ++c)
      add(s.location_um, 1.0 / kUmPerMm, "location of rotary axes", a, c);
    for (std::size_t c = 3; c < kChannels.size(); ++c) {
      if (c == about)
        add(s.zero_urad, kPerMillion, "zero of rotary axes", a, c);
      else
        add(s.location_urad, kPerMillion, "location of rotary axes", a, c);
    }
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
  squareness_ = inputs_.size();
  const double u = *s.squareness_urad * kPerMillion;
  for (std::uint32_t k = 0; k < 3; ++k)
    add_input({"squareness", u, 0.0, u},
              {static_cast<std::uint32_t>(RandomStream::ball_bar), 0, k, kCommon});
}

}  // namespace volcomp::host
