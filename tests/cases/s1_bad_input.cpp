// Cases of docs/papers/xyfz.md: input that must be refused, or accepted with a warning or a flag.

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/plausibility.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "comp/tables/image.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/table_case.hpp"
#include "tests/cases/tick_case.hpp"

namespace volcomp::cases {
namespace {

// The three warnings the case format knows; the library has more.
json warnings_of(const BuiltTable& b) {
  json list = json::array();
  for (std::size_t i = 0; i < b.warning_count; ++i) {
    const Warning w = b.warning[i];
    if (w != Warning::steep_slope && w != Warning::knot_jump) list.push_back(code(w));
  }
  return list;
}

json build_table_api(const json& in) {
  TableCase c(in);
  c.measured.convention.reset();
  if (in.contains("convention") && in["convention"].is_string()) {
    c.measured.convention = in["convention"] == "body" ? Convention::body : Convention::relative;
  }
  c.measured.uniform_tolerance = number(in.at("uniform_tol"));
  c.measured.allow_resampling = in.at("resample").get<bool>();
  require(build_table(c.measured, *c.built));
  const BuiltTable& b = *c.built;
  json out = table_values(b.table);
  out["warnings"] = warnings_of(b);
  out["outliers"] = json::array();
  for (std::size_t i = 0; i < b.outlier_count && i < kMaxOutliers; ++i) {
    const Outlier& o = b.outlier[i];
    out["outliers"].push_back(
        {{"direction", o.direction}, {"run", o.run}, {"target", o.target}, {"channel", o.channel}});
  }
  out["reversal_known"] = b.reversal_known;
  out["pos"] = json::array();
  for (std::size_t i = 0; i < b.table.knots; ++i)
    out["pos"].push_back(b.table.knot(i));
  return out;
}

// A machine with one linear axis, so that a table can be loaded alone.
MachineDescription single_axis(char letter) {
  MachineDescription d;
  d.body_count = 2;
  d.body[1].lower = 1;
  d.body[1].joint.kind = JointKind::prismatic;
  d.body[1].joint.letter = letter;
  d.body[1].joint.axis = static_cast<Axis>(letter - 'X');
  d.work_body = 1;
  d.tool_body = 2;
  return d;
}

json load_table_api(const json& in) {
  const char letter = in.at("axis").get<std::string>().at(0);
  const std::size_t capacity = in.at("capacity").get<std::size_t>();
  const auto tables = std::make_unique<MachineTables>();
  tables->machine = single_axis(letter);
  tables->directions = zero_directions();
  const auto table = std::make_unique<ErrorTable>(table_of(in));
  require(quantise(*table, tables->machine.body[1].joint, capacity, tables->axis[0]));

  std::vector<std::uint8_t> image(image_size(*tables));
  std::size_t written = 0;
  require(encode_image(*tables, image, written));
  if (in.contains("flip_bit")) {
    const json& flip = in["flip_bit"];
    const auto bit = flip.at("bit").get<std::size_t>();
    const std::size_t at = image_value_offset(*tables, 0, 0, flip.at("knot").get<std::size_t>(),
                                              flip.at("channel").get<std::size_t>());
    image.at(at + bit / 8) ^= static_cast<std::uint8_t>(1U << (bit % 8));
  }
  const auto loaded = std::make_unique<MachineTables>();
  require(decode_image(image, capacity, *loaded));
  return json::object();
}

json configure_api(const json& in) {
  require(check_squareness("a_xy_xz_yz", array3(in.at("a_xy_xz_yz"))));
  require(check_offset("b12", array3(in.at("b12"))));
  require(check_offset("b03", array3(in.at("b03"))));
  require(check_offset("pt", array3(in.at("pt"))));
  require(check_positive("limit", number(in.at("limit"))));
  require(check_positive("rate_per_cycle", number(in.at("rate_per_cycle"))));
  return json::object();
}

json flags_of(std::uint16_t status) {
  json flags = json::array();
  if ((status & kNotHomed) != 0) flags.push_back("NOT_HOMED");
  if ((status & kStale) != 0) flags.push_back("STALE");
  if ((status & kOutOfRange) != 0) flags.push_back("OUT_OF_RANGE");
  if ((status & kClamped) != 0) flags.push_back("CLAMPED");
  if ((status & kRateLimited) != 0) flags.push_back("RATE");
  return flags;
}

json tick_api(const json& in) {
  const auto c = xyfz_case(in);
  TickCase tick(*c,
                {number(in.at("limit")), number(in.at("rate_per_cycle")), array3(in.at("c_prev"))});
  json out = {{"correction", json::array()}, {"flags", json::array()}};
  for (const json& q : in.at("q")) {
    TickInput<5> input;
    for (std::size_t a = 0; a < 3; ++a) {
      const double mm = number(q.at(a));
      const bool valid = std::isfinite(mm);
      input.axis[a] = {valid ? to_nm(mm) : 0, valid, in.at("homed").at(a).get<bool>()};
    }
    const TickOutput<5> result = tick.run(input);
    json correction = json::array();
    json flags = json::array();
    for (std::size_t a = 0; a < 3; ++a) {
      correction.push_back(static_cast<double>(result.offset[a]) / kNmPerMm);
      flags.push_back(flags_of(result.status[a]));
    }
    out["correction"].push_back(correction);
    out["flags"].push_back(flags);
  }
  return out;
}

json bad_input(const json& in) {
  const std::string api = in.at("api");
  if (api == "build_table") return build_table_api(in);
  if (api == "load_table") return load_table_api(in);
  if (api == "configure") return configure_api(in);
  if (api == "tick") return tick_api(in);
  throw std::runtime_error("unknown api " + api);
}

}  // namespace

void add_s1_bad_input(Handlers& handlers) { handlers["s1.bad_input"] = bad_input; }

}  // namespace volcomp::cases
