// Cases of docs/papers/xyfz.md: diagonals, commands that compensate, the integer tick, the figures
// of the paper.

#include "comp/metrology/tables/compensated_command.hpp"
#include "comp/metrology/tables/diagonals.hpp"
#include "comp/tick/compensator.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/tick_case.hpp"
#include "tests/cases/xyfz_case.hpp"

namespace volcomp::cases {
namespace {

// The tables of a case with any interpolation between the knots, end values held; relative values.
class InterpolatedTable {
 public:
  InterpolatedTable(const ErrorTable& table, Interpolation kind) : kind_(kind) {
    for (std::size_t i = 0; i < table.knots; ++i)
      x_.push_back(table.knot(i));
    for (Eigen::Index c = 0; c < 6; ++c) {
      std::vector<double> y;
      for (std::size_t i = 0; i < table.knots; ++i)
        y.push_back(table.forward[i](c));
      std::vector<double> slopes(y.size());
      knot_slopes(kind, x_, y, slopes);
      y_.push_back(y);
      slopes_.push_back(slopes);
    }
  }

  [[nodiscard]] ErrorMotion at(double q) const {
    ErrorMotion e;
    for (std::size_t c = 0; c < 6; ++c) {
      e(static_cast<Eigen::Index>(c)) = interpolate(kind_, Ends::hold, x_, y_[c], slopes_[c], q);
    }
    return e;
  }

 private:
  Interpolation kind_;
  std::vector<double> x_;
  std::vector<std::vector<double>> y_;
  std::vector<std::vector<double>> slopes_;
};

template <class ErrorAt>
json diagonals_of_model(const ErrorAt& error_at, const DiagonalBox& box, std::size_t n) {
  json out = {{"body", json::object()}, {"face", json::object()}};
  double largest = 0.0;
  double widest = 0.0;
  const auto measure = [&](const Diagonal& diagonal, json& into) {
    std::vector<double> deviation(n);
    DiagonalFigures figures;
    require(diagonal_deviations(error_at, diagonal, deviation, figures));
    into[diagonal.name] = deviation;
    return figures;
  };
  for (const Diagonal& d : body_diagonals(box)) {
    const DiagonalFigures f = measure(d, out["body"]);
    largest = std::max(largest, f.max_abs);
    widest = std::max(widest, f.range);
  }
  for (const Diagonal& d : face_diagonals(box))
    measure(d, out["face"]);
  out["body_max_abs"] = largest;
  out["body_range_Ed"] = widest;
  return out;
}

json diagonals(const json& in) {
  const auto c = xyfz_case(in);
  const std::string name = in.at("interpolation");
  const Interpolation kind = name == "linear"  ? Interpolation::linear
                             : name == "pchip" ? Interpolation::pchip
                                               : Interpolation::catmull_rom;
  const std::array<InterpolatedTable, 3> tables{InterpolatedTable(c->relative[0], kind),
                                                InterpolatedTable(c->relative[1], kind),
                                                InterpolatedTable(c->relative[2], kind)};
  const MachineChain naive =
      chain_of(xyfz_naive(squareness_of(in.at("a_xy_xz_yz")), {0.0, 0.0, 0.0}));
  const auto error_of = [&](const MachineChain& chain, const DirectionErrors& directions,
                            const Vec3& q) -> Vec3 {
    const Pose pose = pose_of(q);
    const ErrorSet errors = internal_errors(
        chain, {tables[0].at(q.x()), tables[1].at(q.y()), tables[2].at(q.z())}, pose);
    const PointPair points = ideal_points(chain, pose, chain.tool_point());
    return first_order_error(chain, pose, errors, squareness_translation(chain, pose, directions),
                             points)
        .position_base;
  };
  const auto optimised_error = [&](const Vec3& q) {
    return error_of(c->model.chain, c->model.directions, q);
  };
  const auto naive_error = [&](const Vec3& q) { return error_of(naive, zero_directions(), q); };
  const DiagonalBox box{vector3(in.at("lo")), vector3(in.at("hi"))};
  const std::size_t n = in.at("n").get<std::size_t>();
  return {{"opt", diagonals_of_model(optimised_error, box, n)},
          {"naive", diagonals_of_model(naive_error, box, n)}};
}

// Clamp and rate in double. A dead zone keeps a value exactly at a bound from being reported.
struct ReferenceLimiter {
  static constexpr double kDeadZone = 1e-12;

  double clamp(double wanted, bool& hit) const { return between(-limit, limit, wanted, hit); }
  double slew(double wanted, double previous, bool& hit) const {
    return between(previous - rate, previous + rate, wanted, hit);
  }
  static double between(double lo, double hi, double wanted, bool& hit) {
    hit = wanted > hi + kDeadZone || wanted < lo - kDeadZone;
    return std::min(hi, std::max(lo, wanted));
  }

  double limit;
  double rate;
};

json stream(const XyfzCase& c, const json& in) {
  const ReferenceLimiter limiter{number(in.at("limit")), number(in.at("rate_per_cycle"))};
  json out = {{"q_c", json::array()}, {"clamped", json::array()}, {"rate_limited", json::array()}};
  Vec3 correction = Vec3::Zero();
  for (const json& p : in.at("path")) {
    const Vec3 target = vector3(p);
    const Vec3 want = -c.error(target + correction);
    bool clamped = false;
    bool limited = false;
    for (Eigen::Index k = 0; k < 3; ++k) {
      bool hit = false;
      const double inside = limiter.clamp(want(k), hit);
      clamped = clamped || hit;
      correction(k) = limiter.slew(inside, correction(k), hit);
      limited = limited || hit;
    }
    out["q_c"].push_back(to_json(Vec3(target + correction)));
    out["clamped"].push_back(clamped);
    out["rate_limited"].push_back(limited);
  }
  return out;
}

json compensation(const json& in) {
  const auto c = xyfz_case(in);
  const auto error_at = [&](const Vec3& q) { return c->error(q); };
  json out;
  for (const json& t : in.at("targets")) {
    const Vec3 p = vector3(t);
    const Vec3 first = compensated_command(error_at, p, 1);
    const Vec3 second = compensated_command(error_at, p, 2);
    const Vec3 converged = compensated_command(error_at, p, 50);
    out["E_at_target"].push_back(to_json(error_at(p)));
    out["q_first"].push_back(to_json(first));
    out["residual_first"].push_back(to_json(Vec3(first + error_at(first) - p)));
    out["q_one_iteration"].push_back(to_json(second));
    out["residual_one_iteration"].push_back(to_json(Vec3(second + error_at(second) - p)));
    out["q_converged"].push_back(to_json(converged));
  }
  out["stream"] = stream(*c, in.at("stream"));
  return out;
}

json split_int64_float32(const json& in) {
  const auto c = xyfz_case(in);
  TickCase tick(*c, {});
  json rows = json::array();
  for (const json& q : in.at("q_nm")) {
    TickInput<5> input;
    for (std::size_t a = 0; a < 3; ++a)
      input.axis[a] = {q.at(a).get<std::int64_t>(), true, true};
    const TickOutput<5> out = tick.run(input);
    rows.push_back({-out.offset[0], -out.offset[1], -out.offset[2]});
  }
  return {{"E_nm", rows}};
}

json paper_numbers(const json& in) {
  constexpr double kRadPerArcsec = 3.14159265358979323846 / 180.0 / 3600.0;
  const double raw = number(in.at("raw_um"));
  json squareness = json::array();
  for (const json& a : in.at("squareness_arcsec"))
    squareness.push_back(number(a) * kRadPerArcsec);
  return {{"rate_naive_percent", improvement_percent(raw, number(in.at("naive_um")))},
          {"rate_opt_percent", improvement_percent(raw, number(in.at("optimised_um")))},
          {"points_gained", improvement_percent(raw, number(in.at("optimised_um"))) -
                                improvement_percent(raw, number(in.at("naive_um")))},
          {"squareness_rad", squareness},
          {"diagonal_mm", vector3(in.at("strokes")).norm()}};
}

}  // namespace

void add_s1_compensation(Handlers& handlers) {
  handlers["s1.diagonals"] = diagonals;
  handlers["s1.compensation"] = compensation;
  handlers["s1.split_int64_float32"] = split_int64_float32;
  handlers["s1.paper_numbers"] = paper_numbers;
}

}  // namespace volcomp::cases
