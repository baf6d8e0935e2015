#include "host_sim/sim/instruments/laser6d.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::sim {
namespace {

constexpr double kResolution = 1e-6;  // 1 nm; angles: 1 nrad
constexpr std::uint32_t kChannels = 6;

// Numbers of what a set-up has: counted down from kCommon.
enum class Number : std::uint32_t {
  scale,
  straightness,
  angle = 3,
  roll = 6,
  wave,
  beam = 13,
  arm,
  phase = 17
};

double rounded(double value, double step) { return std::round(value / step) * step; }

RandomIndex index_of(const CampaignDraw& draw, std::uint32_t set_up, Number first,
                     std::uint32_t further) {
  return {static_cast<std::uint32_t>(RandomStream::set_up), draw.draw, set_up,
          kCommon - static_cast<std::uint32_t>(first) - further};
}

// Of one instrument, or of one set-up.
class Drawn {
 public:
  Drawn(const CampaignDraw& draw, std::uint32_t set_up) : draw_(draw), set_up_(set_up) {}

  [[nodiscard]] double normal(double sigma, Number first, std::uint32_t further = 0) const {
    return sigma * volcomp::normal(draw_.seed, index_of(draw_, set_up_, first, further));
  }
  [[nodiscard]] Uniforms uniform(Number first, std::uint32_t further = 0) const {
    return uniforms(draw_.seed, index_of(draw_, set_up_, first, further));
  }

 private:
  const CampaignDraw& draw_;
  std::uint32_t set_up_;
};

void draw_instrument(const NoiseClasses& classes, const Drawn& common, LaserSetup& s) {
  s.scale = common.normal(classes.scale, Number::scale);
  for (std::uint32_t k = 0; k < 2; ++k)
    s.straightness_gain.at(k) = common.normal(classes.straightness_gain, Number::straightness, k);
  for (std::uint32_t k = 0; k < 3; ++k)
    s.angle_gain.at(k) = common.normal(classes.angle_gain, Number::angle, k);
  s.roll = common.normal(classes.roll_rad, Number::roll);
}

void draw_set_up(const NoiseClasses& classes, const Drawn& own, LaserSetup& s) {
  for (std::uint32_t c = 0; c < kChannels; ++c) {
    const double size = c < 3 ? classes.straightness_wave_mm : classes.angle_wave_rad;
    s.wave.at(c) = own.normal(size, Number::wave, c);
    s.wave_phase.at(c) = 2.0 * kPi * own.uniform(Number::phase, c).u;
  }
  const double beam = classes.beam_rad * (2.0 * own.uniform(Number::beam).u - 1.0);
  s.shorter = 0.5 * beam * beam;
  for (std::uint32_t k = 0; k < 3; ++k)
    s.arm_error(static_cast<Eigen::Index>(k)) = own.normal(classes.arm_mm, Number::arm, k);
}

}  // namespace

LaserSetup mount_laser(const NoiseClasses& classes, const CampaignDraw& draw,
                       std::uint32_t set_up) {
  LaserSetup s;
  draw_instrument(classes, Drawn(draw, kCommon), s);
  draw_set_up(classes, Drawn(draw, set_up), s);
  s.warmer_K = classes.laser.growth_K *
               normal(draw.seed, {static_cast<std::uint32_t>(RandomStream::temperature), draw.draw,
                                  set_up, kCommon});
  return s;
}

Laser6D::Laser6D(const NoiseClasses& classes, const CampaignDraw& draw, std::uint32_t set_up,
                 const LaserPlace& place)
    : classes_(classes),
      draw_(draw),
      set_up_(set_up),
      place_(place),
      setup_(mount_laser(classes, draw, set_up)) {
  // A level sees no rotation about the vertical.
  if (classes.laser.roll_by_level && place.axis != Axis::z)
    level_.emplace(LevelClass{}, draw, set_up, classes.laser.dwell_s);
}

double Laser6D::scatter(const Stop& stop, Eigen::Index channel) const {
  const double sigma = channel < 3 ? classes_.repeatability_mm : classes_.repeatability_rad;
  return sigma *
         normal(draw_.seed, {static_cast<std::uint32_t>(RandomStream::laser), draw_.draw, set_up_,
                             kChannels * stop.number + static_cast<std::uint32_t>(channel)});
}

ErrorMotion Laser6D::shown(const ErrorMotion& truth, const Stop& stop) const {
  const double u = (stop.q - place_.lo) / (place_.hi - place_.lo);
  const auto along = static_cast<Eigen::Index>(place_.axis);
  ErrorMotion r = truth;
  std::size_t straightness = 0;
  for (Eigen::Index c = 0; c < 6; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const bool by_level = level_ && c == along + 3;
    if (c == along) r(c) += stop.q * (setup_.scale - setup_.shorter);
    if (c < 3 && c != along) r(c) *= 1.0 + setup_.straightness_gain.at(straightness++);
    if (c >= 3 && !by_level) r(c) *= 1.0 + setup_.angle_gain.at(i - 3);
    const double wave = setup_.wave.at(i) * std::sin(2.0 * kPi * u + setup_.wave_phase.at(i));
    if (c != along && !by_level) r(c) += wave;
    if (c == along + 3 && !by_level) r(c) += setup_.roll * u;
    r(c) += scatter(stop, c);
  }
  return r;
}

std::array<std::vector<double>, 3> Laser6D::drifts(std::size_t readings) const {
  std::vector<double> time(readings);
  for (std::size_t k = 0; k < readings; ++k)
    time[k] = classes_.laser.dwell_s * static_cast<double>(k);
  std::array<std::vector<double>, 3> all;
  for (std::uint32_t channel = 0; channel < 3; ++channel) {
    std::vector<double> z(readings);
    for (std::size_t k = 0; k < readings; ++k)
      z[k] = normal(draw_.seed, {static_cast<std::uint32_t>(RandomStream::drift), draw_.draw,
                                 set_up_, 3 * static_cast<std::uint32_t>(k) + channel});
    all.at(channel) = drift_of(classes_.laser).at(time, z);
  }
  return all;
}

host::RunsFile Laser6D::read_runs(char letter, const std::vector<double>& positions,
                                  std::size_t runs, const Truth& truth) const {
  const auto drift = drifts(2 * runs * positions.size());
  const auto roll = static_cast<Eigen::Index>(place_.axis) + 3;
  return bidirectional_runs(letter, positions, runs, [&](const Stop& stop) {
    const ErrorMotion seen = truth(stop.q, stop.approach);
    ErrorMotion r = shown(seen, stop);
    for (Eigen::Index c = 0; c < 3; ++c)
      r(c) += drift.at(static_cast<std::size_t>(c)).at(stop.number);
    if (level_) {
      const double before = truth(stop.q_before, stop.approach_before)(roll);
      r(roll) = level_->read(seen(roll), before, stop.number) + scatter(stop, roll);
    }
    for (Eigen::Index c = 0; c < 6; ++c)
      r(c) = rounded(r(c), c < 3 ? kResolution : kResolution * 1e-3);
    return r;
  });
}

}  // namespace volcomp::sim
