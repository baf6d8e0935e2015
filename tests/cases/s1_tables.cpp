// Cases of docs/papers/xyfz.md: from runs to tables, interpolation, squareness closure, per-axis
// tables.

#include "comp/machine/xyfz.hpp"
#include "comp/metrology/tables/squareness.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/table_case.hpp"
#include "tests/cases/xyfz_case.hpp"
#include "tests/oracle/per_axis_anchored.hpp"

namespace volcomp::cases {
namespace {

json column_to_json(const TableColumn& column, std::size_t count) {
  json rows = json::array();
  for (std::size_t i = 0; i < count; ++i)
    rows.push_back(to_json(column[i]));
  return rows;
}

json table_build(const json& in) {
  const TableCase c(in);
  require(build_table(c.measured, *c.built));
  const BuiltTable& b = *c.built;
  json out = table_values(b.table);
  out["reversal_at_measured_point"] = column_to_json(b.reversal, b.targets);
  out["s_up"] = column_to_json(b.s_up, b.targets);
  out["s_down"] = column_to_json(b.s_down, b.targets);
  out["removed_slope"] = json::object();
  for (std::size_t k = 0; k < 3; ++k) {
    const char letter = static_cast<char>('X' + static_cast<char>(k));
    if (letter != c.measured.letter)
      out["removed_slope"][std::string(1, letter)] = b.removed_slope[k];
  }
  const Iso230Figures& f = b.positioning;
  out["iso230_2_positioning"] = {{"B", f.B},       {"M", f.M},         {"E", f.E}, {"R", f.R},
                                 {"R_up", f.R_up}, {"R_dn", f.R_down}, {"A", f.A}};
  return out;
}

json interpolation(const json& in) {
  const std::vector<double> y = numbers(in.at("f"));
  std::vector<double> x;
  for (std::size_t i = 0; i < y.size(); ++i)
    x.push_back(number(in["q0"]) + static_cast<double>(i) * number(in["h"]));
  json out;
  const std::array<std::pair<const char*, Interpolation>, 3> kinds{
      {{"linear", Interpolation::linear},
       {"pchip", Interpolation::pchip},
       {"catmull", Interpolation::catmull_rom}}};
  for (const auto& [name, kind] : kinds) {
    std::vector<double> slopes(y.size());
    knot_slopes(kind, x, y, slopes);
    for (const auto& [suffix, ends] :
         {std::pair{"_ends_hold", Ends::hold}, std::pair{"_ends_linear", Ends::extend_linearly}}) {
      json values = json::array();
      for (const json& q : in.at("q"))
        values.push_back(interpolate(kind, ends, x, y, slopes, number(q)));
      out[std::string(name) + suffix] = values;
    }
    if (kind != Interpolation::linear) out[std::string("slopes_") + name] = slopes;
  }
  return out;
}

KnotGrid grid_of(const ErrorTable& table) { return {table.q0, table.pitch, table.knots}; }

json per_axis_to_json(const PerAxisTables<64>& t, const std::array<KnotGrid, 3>& grid) {
  json out = {{"const", to_json(t.constant)},
              {"residual_max_abs", to_json(t.residual_max)},
              {"residual_rms", t.residual_rms}};
  const std::array<const char*, 3> names{"fX", "fY", "fZ"};
  for (std::size_t j = 0; j < 3; ++j) {
    out[names[j]] = json::array();
    for (std::size_t i = 0; i < grid[j].knots; ++i)
      out[names[j]].push_back(to_json(t.f[j][i]));
  }
  return out;
}

json per_axis_only(const json& in) {
  const auto c = xyfz_case(in);
  const auto error_at = [&](const Vec3& q) { return c->error(q); };
  const std::array<KnotGrid, 3> grid{grid_of(c->internal[0]), grid_of(c->internal[1]),
                                     grid_of(c->internal[2])};
  PerAxisTables<64> mean;
  PerAxisTables<64> anchored;
  per_axis_grid_mean(error_at, grid, mean);
  test::per_axis_anchored(error_at, grid, vector3(in.at("anchor")), anchored);
  return {{"grid_mean", per_axis_to_json(mean, grid)},
          {"anchored_mid", per_axis_to_json(anchored, grid)}};
}

json squareness_closure(const json& in) {
  const auto c = xyfz_case(in);  // without parameters
  const std::vector<double> x = numbers(in.at("X_positions"));
  const std::vector<double> y = numbers(in.at("Y_positions"));
  const std::vector<double> z = numbers(in.at("Z_positions"));
  const XyfzSquareness apparent = apparent_squareness([&](const Vec3& q) { return c->error(q); },
                                                      {vector3(in.at("fixed_point")), x, y, z});
  const XyfzSquareness closed =
      close_squareness(squareness_of(in.at("measured_a_xy_xz_yz")), apparent);
  return {{"apparent_with_zero_parameters", {apparent.a_xy, apparent.a_xz, apparent.a_yz}},
          {"parameters", {closed.a_xy, closed.a_xz, closed.a_yz}}};
}

}  // namespace

TableCase::TableCase(const json& in) {
  const auto read_runs = [](const json& runs, auto& values, auto& views) {
    for (const json& run : runs) {
      values.emplace_back();
      for (const json& target : run)
        values.back().push_back(six(target));
    }
    for (auto& run : values)
      views.emplace_back(run.data(), run.size());
  };
  positions = numbers(in.at("pos"));
  read_runs(in.at("runs_up"), up_values, up);
  read_runs(in.at("runs_down"), down_values, down);
  measured.letter = in.at("axis").get<std::string>().at(0);
  measured.axis = static_cast<Axis>(measured.letter - 'X');
  measured.positions = positions;
  measured.up = up;
  measured.down = down;
  if (in.contains("L0") && !in["L0"].is_null()) measured.sensed_at_zero = vector3(in["L0"]);
  if (in.contains("kappa") && !in["kappa"].is_null()) measured.kappa = in["kappa"].get<int>();
  measured.reference = in.at("ref_index").get<int>();
  measured.slope = in.at("slope") == "end" ? SlopeFit::end_points : SlopeFit::least_squares;
  measured.convention = Convention::relative;
}

json table_values(const ErrorTable& table) {
  json mean = json::array();
  for (std::size_t i = 0; i < table.knots; ++i)
    mean.push_back(to_json(table.at_knot(i, Travel::unknown)));
  return {{"fwd", column_to_json(table.forward, table.knots)},
          {"bwd", column_to_json(table.backward, table.knots)},
          {"mean", mean}};
}

void add_s1_tables(Handlers& handlers) {
  handlers["s1.table_build"] = table_build;
  handlers["s1.interpolation"] = interpolation;
  handlers["s1.per_axis_only"] = per_axis_only;
  handlers["s1.squareness_closure"] = squareness_closure;
}

}  // namespace volcomp::cases
