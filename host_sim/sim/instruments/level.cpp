#include "host_sim/sim/instruments/level.hpp"

#include <cmath>

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::sim {
namespace {

constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::level);

}  // namespace

Level::Level(const LevelClass& level, const CampaignDraw& draw, std::uint32_t set_up,
             double dwell_s)
    : level_(level),
      draw_(draw),
      set_up_(set_up),
      gain_(1.0 + level.gain * normal(draw.seed, {kStream, draw.draw, kCommon, kCommon})),
      zero_(level.zero * normal(draw.seed, {kStream, draw.draw, set_up, kCommon})),
      left_(std::exp(-dwell_s / level.settling_s)) {}

double Level::read(double tilt, double before, std::uint32_t reading) const {
  const double shown = tilt + left_ * (before - tilt);
  return zero_ + gain_ * shown +
         level_.reading * normal(draw_.seed, {kStream, draw_.draw, set_up_, reading});
}

}  // namespace volcomp::sim
