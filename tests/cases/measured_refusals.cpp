// Cases of measurements that are refused: circular tests, traces to filter, runs to take intervals
// of, pitch and run-out.

#include <algorithm>

#include "comp/metrology/gears/pitch.hpp"
#include "comp/metrology/gears/run_out.hpp"
#include "comp/metrology/gears/trace_filter.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_circles.hpp"
#include "host_sim/host/measure/intervals/run_check.hpp"
#include "tests/cases/handlers.hpp"

namespace volcomp::cases {
namespace {

// The cases name the columns of their own input.
const char* name_in_cases(const std::string& field) {
  if (field == "theta") return "theta_deg";
  if (field == "radial") return "radial_um";
  if (field == "at") return "x";
  if (field == "deviation") return "f";
  if (field == "diameter") return "ball";
  return nullptr;
}

void require_renamed(Status status) {
  if (status.where.field != nullptr) {
    if (const char* name = name_in_cases(status.where.field)) status.where.field = name;
  }
  require(status);
}

void require_fields(const json& in, std::initializer_list<const char*> fields) {
  for (const char* field : fields) {
    if (in.contains(field)) continue;
    Where where;
    where.field = field;
    require(refuse(Reason::missing_field, where));
  }
}

std::optional<double> optional_number(const json& in, const char* key) {
  if (!in.contains(key) || in[key].is_null()) return std::nullopt;
  return number(in[key]);
}

json refused_ball_bar(const json& in) {
  host::BallBarTest test;
  if (in.contains("plane")) test.plane = in["plane"].get<std::string>();
  test.radius = optional_number(in, "radius_mm");
  test.feed = optional_number(in, "feed_mm_min");
  for (std::size_t d = 0; d < test.circle.size(); ++d) {
    const char* direction = host::kCircleDirections.at(d);
    if (!in.contains("theta_deg") || !in["theta_deg"].contains(direction)) continue;
    host::BallBarCircle circle;
    for (const json& theta : in["theta_deg"][direction])
      circle.theta.push_back(number(theta) * kDegree);
    if (in.contains("radial_um")) {
      for (const json& radial : in["radial_um"].at(direction))
        circle.radial.push_back(number(radial) * kUm);
    }
    test.circle.at(d).push_back(circle);
  }
  Status status = host::check(test);
  static std::string plane;  // the cases name the one that is not known; the refusal points at it
  if (status.reason == Reason::unknown_plane) {
    plane = *test.plane;
    status.where.field = plane.c_str();
  }
  require_renamed(status);
  return json::object();
}

json refused_filter(const json& in) {
  require_fields(in, {"x", "f", "cutoff"});
  const std::vector<double> f = numbers(in["f"]);
  std::vector<double> out(f.size());
  const std::vector<double> x = numbers(in["x"]);
  require_renamed(filter_trace(x, f, number(in["cutoff"]), FilterOrder::line, out));
  return json::object();
}

std::vector<std::vector<double>> runs_of(const json& in, const char* key) {
  std::vector<std::vector<double>> runs;
  if (!in.contains(key)) return runs;
  for (const json& run : in[key])
    runs.push_back(numbers(run));
  return runs;
}

json refused_runs(const json& in) {
  const std::vector<double> positions =
      in.contains("positions") ? numbers(in["positions"]) : std::vector<double>{};
  require_renamed(host::check_runs(positions, runs_of(in, "up"), runs_of(in, "down")));
  return json::object();
}

json refused_pitch(const json& in) {
  require_fields(in, {"left", "right"});
  BallInSpace ball;
  ball.teeth = in.at("z").get<int>();
  ball.module = number(in.at("m"));
  ball.pressure_angle = number(in.at("alpha"));
  ball.diameter = number(in.at("ball"));
  const std::vector<double> left = numbers(in["left"]);
  const std::vector<double> right = numbers(in["right"]);
  require_renamed(check_spaces(ball.teeth, left, right));
  double cumulative = 0.0;
  const int k = in.at("k").get<int>();
  require_renamed(cumulative_pitch(left, static_cast<std::size_t>(std::max(k, 0)), cumulative));
  std::vector<double> radial(left.size());
  RunOut r;
  require_renamed(run_out(ball, left, right, radial, r));
  return json::object();
}

json refused(const json& in) {
  const auto api = in.at("api").get<std::string>();
  const json& input = in.at("input");
  if (api == "ballbar") return refused_ball_bar(input);
  if (api == "filter") return refused_filter(input);
  if (api == "runs") return refused_runs(input);
  return refused_pitch(input);
}

}  // namespace

void add_measured_refusals(Handlers& handlers) { handlers["me.refuse"] = refused; }

}  // namespace volcomp::cases
