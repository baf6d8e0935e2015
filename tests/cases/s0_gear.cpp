// Cases of docs/papers/l300g.md: involute flanks, deviations, tolerances and grades.

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_tolerance.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"

namespace volcomp::cases {
namespace {

constexpr std::array<const char*, kGearDeviations> kNames{"f_pt", "F_p",  "F_a",  "f_fa", "f_Ha",
                                                          "F_b",  "f_fb", "f_Hb", "F_r"};
constexpr double kUmPerMm = 1000.0;

json two_of(const Transverse& t) { return {t.y, t.z}; }

json involute_distance(const json& in) {
  const InvoluteGear gear = gear_of(in.at("gear"));
  const Flank flank = flank_of(in);
  FlankDistance d;
  require(distance_from_flank(gear, flank, {number(in.at("y")), number(in.at("z"))}, 0.0, d));
  return {{"distance", d.distance},
          {"deviation", deviation_of(gear, d.distance, number(in.at("r_c")))},
          {"roll_length_foot", d.roll_length},
          {"normal", two_of(d.normal)},
          {"foot", two_of(d.foot)},
          {"rb", gear.r_b},
          {"eta_b", gear.eta_b}};
}

// --- limits

GearSize size_of(const json& in, double width) {
  return {number(in.at("d")), number(in.at("m")), width};
}

json named(const std::array<double, kGearDeviations>& values) {
  json out;
  for (std::size_t i = 0; i < kGearDeviations; ++i)
    out[kNames[i]] = values[i];
  return out;
}

json tolerance(const json& in) {
  const GearSize size = size_of(in, number(in.at("b")));
  const int grade = in.at("grade").get<int>();
  json out;
  for (const auto& [standard, name] : {std::pair{GearStandard::iso1328_1995, "iso1995"},
                                       std::pair{GearStandard::iso1328_2013, "iso2013"}}) {
    require(check_size(standard, size));
    const GearLimits limits = gear_limits(standard, size, grade);
    out[std::string(name) + "_um"] = named(limits.rounded);
    out[std::string(name) + "_unrounded_um"] = named(limits.exact);
  }
  return out;
}

json grade_json(GearStandard standard, const GearSize& size, GearDeviation deviation,
                double value_mm) {
  const auto grade = grade_of(standard, size, deviation, kUmPerMm * value_mm);
  return grade ? json(*grade) : json(nullptr);
}

// --- traces

struct TraceKind {
  const char* abscissa;
  std::array<const char*, 3> names;
  std::array<GearDeviation, 3> deviations;
};
const TraceKind kProfile{
    "roll_length",
    {"F_alpha", "f_falpha", "f_Halpha"},
    {GearDeviation::profile, GearDeviation::profile_form, GearDeviation::profile_slope}};
const TraceKind kLead{"x",
                      {"F_beta", "f_fbeta", "f_Hbeta"},
                      {GearDeviation::lead, GearDeviation::lead_form, GearDeviation::lead_slope}};

json trace_eval(const TraceKind& kind, const json& in) {
  const std::vector<double> at = numbers(in.at(kind.abscissa));
  const std::vector<double> f = numbers(in.at("f"));
  TraceDeviations d;
  require(evaluate_trace(at, f, {number(in.at("eval_lo")), number(in.at("eval_hi"))}, d));
  const std::array<double, 3> values{d.total, d.form, d.slope};
  const std::array<const char*, 3> keys{"F", "f_f", "f_H"};
  const GearSize size = size_of(in, number(in.at("b")));
  json out{{"n_used", d.used}};
  for (std::size_t i = 0; i < 3; ++i) {
    out[kind.names[i]] = values[i];
    out["grades_1995"][keys[i]] =
        grade_json(GearStandard::iso1328_1995, size, kind.deviations[i], values[i]);
    out["grades_2013"][keys[i]] =
        grade_json(GearStandard::iso1328_2013, size, kind.deviations[i], values[i]);
  }
  return out;
}

json pitch_eval(const json& in) {
  const std::vector<double> position = numbers(in.at("position_dev"));
  PitchDeviations d;
  require(evaluate_pitch(position, d));
  const GearSize size = size_of(in, 30.0);  // pitch limits do not depend on the width
  const auto grade = [&](GearDeviation deviation, double value) {
    return grade_json(GearStandard::iso1328_1995, size, deviation, value);
  };
  return {{"f_pt", d.single},
          {"f_pt_signed", d.single_signed},
          {"F_p", d.total},
          {"grades_1995",
           {{"f_pt", grade(GearDeviation::single_pitch, d.single)},
            {"F_p", grade(GearDeviation::total_pitch, d.total)}}}};
}

// --- a whole trace

// Traces of the touches of a case, by the ideal chain or with the errors of the machine.
class Inspection {
 public:
  explicit Inspection(const json& in)
      : in_(in), machine_(in.at("machine")), gear_(gear_of(in.at("gear"))) {}

  void trace(const char* name, const ErrorSet& errors, json& out) const {
    const bool profile = in_.at("trace") == "profile";
    std::vector<double> at;
    std::vector<double> f;
    for (const json& encoders : in_.at("encoders_XYBA")) {
      const Vec3 centre = ball_centre(encoders, errors);
      FlankDistance d;
      require(distance_from_flank(gear_, flank_of(in_), {centre.y(), centre.z()}, 0.0, d));
      at.push_back(profile ? d.roll_length : centre.x());
      f.push_back(deviation_of(gear_, d.distance, number(in_.at("r_c"))));
    }
    TraceDeviations d;
    require(evaluate_trace(at, f, {number(in_.at("eval_lo")), number(in_.at("eval_hi"))}, d));
    const GearSize size = size_of(in_, number(in_.at("b")));
    const GearDeviation kind = profile ? GearDeviation::profile : GearDeviation::lead;
    out[std::string(name) + "_abscissa"] = at;
    out[std::string(name) + "_f"] = f;
    out[name] = {{"n_used", d.used},
                 {"F", d.total},
                 {"f_f", d.form},
                 {"f_H", d.slope},
                 {"grade_F_1995", grade_json(GearStandard::iso1328_1995, size, kind, d.total)}};
  }

 private:
  // In the frame of the gear.
  [[nodiscard]] Vec3 ball_centre(const json& encoders, const ErrorSet& errors) const {
    Pose q{};
    for (std::size_t a = 0; a < 4; ++a)
      q[a] = number(encoders.at(a));
    const PointPair points = ideal_points(machine_.chain, q, machine_.chain.tool_point());
    const VolumetricError e =
        exact_error(machine_.chain, q, errors, Vec3::Zero(), RotationModel::rxryrz, points);
    return points.work + e.position_work;
  }

  const json& in_;
  L300gCase machine_;
  InvoluteGear gear_;
};

json inspection(const json& in) {
  ErrorSet errors = zero_errors();
  std::size_t axis = 0;
  for (const char* letter : {"X", "Y", "B", "A"})
    errors[axis++] = six(in.at("error_constants").at(letter));
  const Inspection inspected(in);
  json out;
  inspected.trace("raw", zero_errors(), out);
  inspected.trace("comp", errors, out);
  return out;
}

}  // namespace

void add_s0_gear(Handlers& handlers) {
  handlers["s0.involute_distance"] = involute_distance;
  handlers["s0.tolerance"] = tolerance;
  handlers["s0.profile_eval"] = [](const json& in) { return trace_eval(kProfile, in); };
  handlers["s0.lead_eval"] = [](const json& in) { return trace_eval(kLead, in); };
  handlers["s0.pitch_eval"] = pitch_eval;
  handlers["s0.inspection"] = inspection;
}

}  // namespace volcomp::cases
