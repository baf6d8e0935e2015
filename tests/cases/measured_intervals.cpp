// Cases of intervals: spread of runs, profiles of the null hypothesis, figures with their
// intervals.

#include <iterator>

#include "host_sim/host/measure/intervals/circle_interval.hpp"
#include "host_sim/host/measure/intervals/positioning_interval.hpp"
#include "host_sim/host/measure/intervals/volume_interval.hpp"
#include "tests/cases/handlers.hpp"

namespace volcomp::cases {
namespace {

using host::NormValues;
using host::PeakValues;
using host::SpanValues;

std::uint64_t seed_of(const json& in) { return std::stoull(in.at("seed").get<std::string>()); }

std::vector<double> list(const host::Columns& v) { return {std::begin(v), std::end(v)}; }

host::RunReadings readings_of(const json& in) {
  host::RunReadings r;
  r.position = numbers(in.at("positions"));
  for (std::size_t run = 0; run < in.at("up").size(); ++run) {
    std::vector<double> columns = numbers(in["up"][run]);
    for (const json& value : in.at("down").at(run))
      columns.push_back(number(value));
    r.run.emplace_back(columns.data(), columns.size());
  }
  return r;
}

json spread(const json& in) {
  const host::RunSpread s = host::run_spread(readings_of(in));
  return {{"nu", s.freedom},
          {"pooled", s.pooled},
          {"total", s.total},
          {"run", s.run},
          {"coefficients", {s.coefficients[0], s.coefficients[1], s.coefficients[2]}},
          {"v", list(s.v)},
          {"v_total", list(s.v_total())}};
}

json rows(const NormValues& values) {
  json out = json::array();
  for (std::size_t p = 0; p < values.places(); ++p) {
    json row = json::array();
    for (std::size_t i = 0; i < values.components; ++i)
      row.push_back(values.y[values.components * p + i]);
    out.push_back(row);
  }
  return out;
}

json profile(const json& in) {
  const auto type = in.at("type").get<std::string>();
  const double theta = number(in.at("theta"));
  std::vector<double> u = numbers(in.at("u"));
  for (double& value : u)
    value *= number(in.at("kappa"));
  const std::vector<double> noise = numbers(in.at("u"));
  if (type == "span") {
    const SpanValues data{numbers(in.at("t")), numbers(in.at("b"))};
    const SpanValues low = host::nearest_with(data, theta, u);
    const SpanValues high = host::lonely_with(data, theta, noise);
    return {{"T", data.figure()},
            {"low_t", low.upper},
            {"low_b", low.lower},
            {"high_t", high.upper},
            {"high_b", high.lower}};
  }
  if (type == "peak") {
    const PeakValues data{numbers(in.at("y"))};
    return {{"T", data.figure()},
            {"low", host::nearest_with(data, theta, u).y},
            {"high", host::lonely_with(data, theta, noise).y}};
  }
  NormValues data{in.at("y").at(0).size(), {}};
  for (const json& place : in["y"])
    for (const json& value : place)
      data.y.push_back(number(value));
  return {{"T", data.figure()},
          {"low", rows(host::nearest_with(data, theta, u))},
          {"high", rows(host::lonely_with(data, theta, noise))}};
}

json figure(const host::FigureInterval& i, double unit = 1.0) {
  return {{"estimate", i.estimate / unit},
          {"value", i.corrected / unit},
          {"low", i.low / unit},
          {"high", i.high / unit},
          {"upper95_um", i.upper95 / unit}};
}

json figures(const host::PositioningIntervals& i) {
  return {{"E", figure(i.E)},
          {"M", figure(i.M)},
          {"B", figure(i.B)},
          {"A", figure(i.A)},
          {"R", figure(i.R)}};
}

json interval(const json& in) {
  const host::StatedErrors stated{number(in.at("scale_um_per_mm")), number(in.at("eve_um"))};
  return figures(host::positioning_intervals(readings_of(in), stated, seed_of(in),
                                             in.at("draws").get<std::size_t>()));
}

json interval_statistical(const json& in) {
  return figures(host::positioning_intervals(readings_of(in), {}, 1,
                                             in.at("draws_at_least").get<std::size_t>()));
}

std::vector<double> vectors(const json& places) {
  std::vector<double> out;
  for (const json& place : places)
    for (const json& value : place)
      out.push_back(number(value));
  return out;
}

json interval_volume(const json& in) {
  host::VolumeErrors volume;
  volume.error = vectors(in.at("errors_um"));
  volume.u = number(in.at("u_um"));
  if (in.contains("scale_um_per_mm")) {
    volume.position = vectors(in.at("positions_mm"));
    volume.scale = number(in["scale_um_per_mm"]);
  }
  return figure(host::volume_interval(volume, seed_of(in), in.at("draws").get<std::size_t>()));
}

json interval_circle(const json& in) {
  host::CircleRuns runs;
  runs.radius = number(in.at("radius_mm"));
  runs.theta = numbers(in.at("theta_deg"));
  for (double& theta : runs.theta)
    theta *= kDegree;
  const auto in_mm = [](const json& run) {
    std::vector<double> out = numbers(run);
    for (double& value : out)
      value *= kUm;
    return out;
  };
  for (const json& run : in.at("ccw_um"))
    runs.ccw.push_back(in_mm(run));
  for (const json& run : in.at("cw_um"))
    runs.cw.push_back(in_mm(run));
  if (!in.at("sigma_um").is_null()) runs.sigma = number(in["sigma_um"]) * kUm;
  const host::CircleIntervals i =
      host::circle_intervals(runs, seed_of(in), in.at("draws").get<std::size_t>());
  return {{"G_ccw", figure(i.ccw, kUm)}, {"G_cw", figure(i.cw, kUm)}, {"G_b", figure(i.both, kUm)}};
}

}  // namespace

void add_measured_intervals(Handlers& handlers) {
  handlers["me.spread"] = spread;
  handlers["me.profile"] = profile;
  handlers["me.interval"] = interval;
  handlers["me.interval_volume"] = interval_volume;
  handlers["me.interval_circle"] = interval_circle;
  handlers["me.interval_statistical"] = interval_statistical;
}

}  // namespace volcomp::cases
