#include "host_sim/experiments/l300g/measuring_centre.hpp"

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::l300g {
namespace {

constexpr auto kCentreStream = static_cast<std::uint32_t>(RandomStream::probe) + kNextInstrument;
constexpr auto kCentreSetUp = static_cast<std::uint32_t>(RandomStream::set_up) + kNextInstrument;

// One set-up a trace: its points scatter, and it is inclined as a whole.
class CentreReadings {
 public:
  CentreReadings(const CentreErrors& errors, std::uint64_t seed, std::uint32_t draw)
      : errors_(errors), seed_(seed), draw_(draw) {}

  void add_to(host::FlankTrace& trace, const EvaluationRange& range) {
    const double slope = errors_.slope_um * normal(seed_, {kCentreSetUp, draw_, set_up_, kCommon});
    for (std::size_t i = 0; i < trace.at.size(); ++i)
      trace.deviation[i] += point(i) + slope * (trace.at[i] - range.low) / (range.high - range.low);
    ++set_up_;
  }

  void add_to(host::PitchRound& round) {
    for (std::size_t i = 0; i < round.position.size(); ++i)
      round.position[i] += point(i);
    ++set_up_;
  }

 private:
  [[nodiscard]] double point(std::size_t i) const {
    return errors_.point_um *
           normal(seed_, {kCentreStream, draw_, set_up_, static_cast<std::uint32_t>(i)});
  }

  CentreErrors errors_;
  std::uint64_t seed_;
  std::uint32_t draw_;
  std::uint32_t set_up_ = 0;
};

}  // namespace

GearInspection gear_on_centre(const InvoluteGear& gear, const CentreErrors& errors,
                              std::uint64_t seed, std::uint32_t draw) {
  GearInspection found = true_gear(gear);
  CentreReadings readings(errors, seed, draw);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const EvaluationRange profile = host::profile_range(gear, host::kRollUsed1995);
    readings.add_to(found.profile[side], profile);
    host::filter_as_2013(found.profile[side], profile, "profile on the centre");
    host::grade_profile(gear, "profile on the centre", found.profile[side]);
    const EvaluationRange lead = host::lead_range(gear);
    readings.add_to(found.lead[side], lead);
    host::filter_as_2013(found.lead[side], lead, "lead on the centre");
    host::grade_lead(gear, "lead on the centre", found.lead[side]);
    readings.add_to(found.pitch[side]);
    host::grade_pitch(gear, "pitch on the centre", found.pitch[side]);
  }
  return found;
}

}  // namespace volcomp::l300g
