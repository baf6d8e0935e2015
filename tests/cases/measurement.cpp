// Cases of measurements: random streams, circular tests.

#include <cmath>

#include "comp/metrology/circles/circle_decomposition.hpp"
#include "comp/metrology/circles/circle_figures.hpp"
#include "comp/metrology/circles/straightness_leak.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "tests/cases/handlers.hpp"

namespace volcomp::cases {
namespace {

json stream(const json& in) {
  const std::uint64_t seed = std::stoull(in.at("seed").get<std::string>());
  const RandomIndex at{in.at("stream").get<std::uint32_t>(), in.at("draw").get<std::uint32_t>(),
                       in.at("setup").get<std::uint32_t>(), in.at("reading").get<std::uint32_t>()};
  const Uniforms r = uniforms(seed, at);
  return {
      {"words", random_words(seed, at)}, {"uniforms", {r.u, r.v}}, {"normals", normals(seed, at)}};
}

// A test as a case has it, and the memory behind it.
class CircleCase {
 public:
  explicit CircleCase(const json& in) : radius_(number(in.at("radius_mm"))) {
    for (const char* direction : {"ccw", "cw"}) {
      if (!in.at("theta_deg").contains(direction)) continue;
      Readings& r = direction == std::string("ccw") ? ccw_ : cw_;
      for (const json& theta : in["theta_deg"][direction])
        r.theta.push_back(number(theta) * kDegree);
      for (const json& radial : in.at("radial_um").at(direction))
        r.radial.push_back(number(radial) * kUm);
    }
  }

  [[nodiscard]] CircleTest ccw() const { return {radius_, trace(ccw_), {}}; }
  [[nodiscard]] CircleTest cw() const { return {radius_, {}, trace(cw_)}; }
  [[nodiscard]] CircleTest all() const { return {radius_, trace(ccw_), trace(cw_)}; }

 private:
  struct Readings {
    std::vector<double> theta, radial;
  };
  static CircleTrace trace(const Readings& r) { return {r.theta, r.radial}; }

  double radius_;
  Readings ccw_, cw_;
};

json in_um(const std::array<double, 2>& mm) { return {mm[0] / kUm, mm[1] / kUm}; }

json figures_of(const CircleTest& test) {
  CircleFigures f;
  require(circle_figures(test, f));
  json out = {{"centre_um", in_um(f.centre)},
              {"F_max_centred_um", f.centred_max / kUm},
              {"F_min_centred_um", f.centred_min / kUm}};
  if (test.both()) {
    out["G_b_um"] = f.circular / kUm;
    out["D_um"] = f.radius_deviation / kUm;
  } else {
    out["G_um"] = f.circular / kUm;
    out["radius_deviation_um"] = f.radius_deviation / kUm;
    out["F_max_um"] = f.radial_max / kUm;
    out["F_min_um"] = f.radial_min / kUm;
  }
  return out;
}

json circle(const json& in) {
  const CircleCase c(in);
  json out;
  if (!c.all().ccw.theta.empty()) out["ccw"] = figures_of(c.ccw());
  if (!c.all().cw.theta.empty()) out["cw"] = figures_of(c.cw());
  if (c.all().both()) out["both"] = figures_of(c.all());
  return out;
}

Axis axis_of(char letter) { return static_cast<Axis>(letter - 'X'); }

CircleSettings settings_of(const json& in) {
  const auto plane = in.at("plane").get<std::string>();
  CircleSettings s;
  s.first = axis_of(plane.at(0));
  s.second = axis_of(plane.at(1));
  s.feed = number(in.at("feed_mm_min")) / 60.0;
  const json& cyclic = in.at("cyclic_mm");
  for (std::size_t i = 0; !cyclic.is_null() && i < 2; ++i)
    s.cyclic_wavelength[i] = cyclic[i].is_null() ? 0.0 : number(cyclic[i]);
  return s;
}

const char* squareness_name(const CircleSettings& s) {
  if (s.first != Axis::z && s.second != Axis::z) return "EC0Y";
  return s.first != Axis::x && s.second != Axis::x ? "EA0Z" : "EB0Z";
}

json parameters(const CircleParameters& p, bool both) {
  json out = {{"radius_um", p.radius / kUm},
              {"centre_um", in_um(p.centre)},
              {"scale_mismatch_um_per_m", p.scale_mismatch * 1e6},
              {"squareness_urad", p.squareness * 1e6}};
  if (!both) return out;
  out["servo_mismatch_ms"] = p.servo_mismatch * 1e3;
  out["reversal_um"] = in_um(p.reversal);
  out["lateral_um"] = in_um(p.lateral);
  return out;
}

json spikes(const CircleTrace& trace, const std::vector<double>& residual) {
  json out = json::array();
  for (const CircleSpike& spike : circle_spikes(trace.theta, {residual.data(), residual.size()}))
    out.push_back(spike.known ? json(spike.height / kUm) : json());
  return out;
}

json decompose(const json& in) {
  const CircleCase c(in);
  const CircleTest test = c.all();
  const CircleSettings settings = settings_of(in);
  std::vector<double> ccw(test.ccw.theta.size());
  std::vector<double> cw(test.cw.theta.size());
  CircleDecomposition d;
  require(decompose_circle(test, settings, {ccw, cw}, d));
  json out = parameters(d.value, test.both());
  out["u"] = parameters(d.u, test.both());
  out["squareness_name"] = squareness_name(settings);
  out["rms_um"] = d.rms / kUm;
  out["cyclic_um"] = json::array();
  for (std::size_t i = 0; !in["cyclic_mm"].is_null() && i < 2; ++i) {
    const bool known = settings.cyclic_wavelength[i] > 0.0;
    out["cyclic_um"].push_back(known ? json(d.cyclic[i] / kUm) : json());
  }
  if (in.at("spikes").get<bool>()) {
    if (!ccw.empty()) out["spikes_um"]["ccw"] = spikes(test.ccw, ccw);
    if (!cw.empty()) out["spikes_um"]["cw"] = spikes(test.cw, cw);
  }
  return out;
}

json circle_line(const json& in) {
  const StraightnessCurve e{number(in.at("c2")), number(in.at("c3")), number(in.at("c4"))};
  const double circle = slope_by_circle(e, number(in.at("centre_mm")), number(in.at("radius_mm")));
  const double line =
      slope_by_line(e, number(in.at("line_middle_mm")), number(in.at("line_half_mm")));
  return {{"circle_rad", circle}, {"line_rad", line}, {"difference_rad", circle - line}};
}

}  // namespace

void add_measurement(Handlers& handlers) {
  handlers["me.stream"] = stream;
  handlers["me.circle"] = circle;
  handlers["me.decompose"] = decompose;
  handlers["me.circle_line"] = circle_line;
}

}  // namespace volcomp::cases
