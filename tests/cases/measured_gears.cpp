// Cases of measured gears: the filter of a trace, several teeth, pitch, run-out.

#include <cmath>

#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/pitch.hpp"
#include "comp/metrology/gears/run_out.hpp"
#include "comp/metrology/gears/trace_filter.hpp"
#include "tests/cases/handlers.hpp"

namespace volcomp::cases {
namespace {

std::vector<double> filtered(const std::vector<double>& x, const std::vector<double>& f,
                             double cutoff, FilterOrder order = FilterOrder::line) {
  std::vector<double> out(f.size());
  require(filter_trace(x, f, cutoff, order, out));
  return out;
}

json filter(const json& in) {
  const auto order = in.at("order").get<int>() == 0 ? FilterOrder::mean : FilterOrder::line;
  return {{"filtered_um",
           filtered(numbers(in.at("x")), numbers(in.at("f_um")), number(in.at("cutoff")), order)}};
}

json cutoff(const json& in) { return {{"cutoff", trace_cutoff(number(in.at("length")))}}; }

json parameters(const TraceDeviations& d) {
  return {{"F", d.total}, {"f_f", d.form}, {"f_H", d.slope}};
}

// Teeth measured along the same places.
class Teeth {
 public:
  explicit Teeth(const json& in)
      : x_(numbers(in.at("x"))), range_{number(in.at("eval_lo")), number(in.at("eval_hi"))} {
    for (const json& trace : in.at("traces_um"))
      trace_.push_back(numbers(trace));
  }
  [[nodiscard]] double cutoff() const { return trace_cutoff(range_.high - range_.low); }
  [[nodiscard]] json out() const {
    json out = {{"cutoff", cutoff()}, {"plain", json::array()}, {"filtered", json::array()}};
    TraceDeviations mean;
    TraceDeviations worst;
    std::vector<double> mean_trace(x_.size());
    const auto n = static_cast<double>(trace_.size());
    for (const std::vector<double>& trace : trace_) {
      const TraceDeviations plain = evaluated(trace);
      const TraceDeviations d = evaluated(filtered(x_, trace, cutoff()));
      out["plain"].push_back(with_count(plain));
      out["filtered"].push_back(with_count(d));
      mean.total += d.total / n;
      mean.form += d.form / n;
      mean.slope += d.slope / n;
      worst.total = std::max(worst.total, d.total);
      worst.form = std::max(worst.form, d.form);
      worst.slope = std::max(worst.slope, std::abs(d.slope));
      for (std::size_t i = 0; i < trace.size(); ++i)
        mean_trace[i] += trace[i] / n;
    }
    out["mean_of_teeth"] = parameters(mean);
    out["worst_of_teeth"] = parameters(worst);
    out["mean_trace"] = parameters(evaluated(filtered(x_, mean_trace, cutoff())));
    return out;
  }

 private:
  [[nodiscard]] TraceDeviations evaluated(const std::vector<double>& trace) const {
    TraceDeviations d;
    require(evaluate_trace(x_, trace, range_, d));
    return d;
  }
  static json with_count(const TraceDeviations& d) {
    json out = parameters(d);
    out["n"] = d.used;
    return out;
  }

  std::vector<double> x_;
  EvaluationRange range_;
  std::vector<std::vector<double>> trace_;
};

json pitch(const json& in) {
  const std::vector<double> position = numbers(in.at("position_um"));
  PitchDeviations round;
  require(evaluate_pitch(position, round));
  double cumulative = 0.0;
  require(cumulative_pitch(position, in.at("k").get<std::size_t>(), cumulative));
  return {{"F_pk_um", cumulative}, {"F_p_um", round.total}};
}

json runout(const json& in) {
  BallInSpace ball;
  ball.teeth = in.at("z").get<int>();
  ball.module = number(in.at("m"));
  ball.pressure_angle = number(in.at("alpha"));
  ball.helix_angle = number(in.at("beta"));
  ball.shift = number(in.at("x_shift"));
  ball.diameter = number(in.at("ball"));
  const std::vector<double> left = numbers(in.at("left_um"));
  const std::vector<double> right = numbers(in.at("right_um"));
  std::vector<double> radial(left.size());
  RunOut r;
  require(run_out(ball, left, right, radial, r));
  BallSeat seat;
  require(ball_seat(ball, seat));
  return {{"alpha_K", seat.pressure_angle},
          {"centre_radius", seat.radius},
          {"rho_um", radial},
          {"F_r_um", r.total},
          {"eccentricity_um", r.eccentricity}};
}

}  // namespace

void add_measured_gears(Handlers& handlers) {
  handlers["me.filter"] = filter;
  handlers["me.cutoff"] = cutoff;
  handlers["me.gear_trace"] = [](const json& in) { return Teeth(in).out(); };
  handlers["me.f_pk"] = pitch;
  handlers["me.runout"] = runout;
}

}  // namespace volcomp::cases
