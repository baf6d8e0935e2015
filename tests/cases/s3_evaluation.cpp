// Cases of docs/papers/internal-helical.md: pitch and profile of internal gears, grades.

#include <algorithm>

#include "comp/metrology/gears/gear_grade.hpp"
#include "comp/metrology/gears/internal_gear_deviations.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"

namespace volcomp::cases {
namespace {

json helical_pitch(const json& in) {
  const std::vector<double> position = numbers(in.at("dev_um"));
  std::vector<double> single(position.size());
  PitchDeviations pitch;
  double sector = 0.0;
  require(evaluate_pitch(position, pitch));
  require(single_pitches(position, single));
  require(cumulative_pitch(position, in.at("k").get<std::size_t>(), sector));
  return {{"fpt", single}, {"fp", pitch.single}, {"Fp", pitch.total}, {"Fpk", sector}};
}

json profile_eval(const json& in) {
  const std::vector<double> roll = numbers(in.at("roll_mm"));
  const std::vector<double> f = numbers(in.at("dev_um"));
  TraceDeviations d;
  const bool internal = in.at("internal").get<bool>();
  const auto [low, high] = std::minmax_element(roll.begin(), roll.end());
  require(internal ? evaluate_internal_profile(roll, f, d)
                   : evaluate_trace(roll, f, {*low, *high}, d));
  return {{"Fa", d.total}, {"fHa", d.slope}, {"ffa", d.form}};
}

GearDeviation deviation_named(const std::string& name) {
  if (name == "fp") return GearDeviation::single_pitch;
  if (name == "Fp") return GearDeviation::total_pitch;
  return name == "Fa" ? GearDeviation::profile : GearDeviation::lead;
}

json grade(const json& in) {
  const auto standard =
      in.at("std") == "1995" ? GearStandard::iso1328_1995 : GearStandard::iso1328_2013;
  const GearSize size{number(in.at("d")), number(in.at("m")), number(in.at("b"))};
  const GearDeviation deviation = deviation_named(in.at("kind"));
  GearGrade g;
  require(
      grade_gear(standard, LimitRounding::rounded, size, deviation, number(in.at("value_um")), g));
  json limits = json::array();
  for (int q = first_grade(standard); q <= last_grade(standard); ++q)
    limits.push_back(gear_limits(standard, size, q).rounded[static_cast<std::size_t>(deviation)]);
  return {{"grade", g.grade ? json(*g.grade) : json(nullptr)},
          {"limits_um", limits},
          {"first_grade", first_grade(standard)}};
}

}  // namespace

void add_s3_evaluation(Handlers& handlers) {
  handlers["s3.pitch_eval"] = helical_pitch;
  handlers["s3.profile_eval"] = profile_eval;
  handlers["s3.grade"] = grade;
}

}  // namespace volcomp::cases
