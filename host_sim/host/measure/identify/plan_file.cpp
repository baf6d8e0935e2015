#include "host_sim/host/measure/identify/plan_file.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/bundled_files.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/measure/identify/plan_setup.hpp"
#include "host_sim/host/measure/identify/plan_values.hpp"

namespace volcomp::host::identify {
namespace {

class PlanReader {
 public:
  PlanReader(std::filesystem::path path, const PlanFiles& files)
      : path_(std::move(path)), files_(files) {}

  MeasurementPlan read() {
    plan_.path = shown_name(path_);
    return read_toml(text_of_file(path_), plan_.path, [this](const TomlValue& top) {
      read_top(TomlSection(top, plan_.path, "the file"));
      return std::move(plan_);
    });
  }

 private:
  void read_top(const TomlSection& top) {
    top.allow_only({"positions", "compensation", "temperature_C", "machine", "model", "stylus",
                    "artefact", "setup"});
    plan_.commanded = top.choice("positions", {"actual", "command"}) == 1;
    read_compensation(top);
    plan_.temperature_C = top.number("temperature_C");
    const TomlSection machine = top.table("machine");
    machine.allow_only({"file"});
    plan_.machine = read_machine_file(path_.parent_path() / machine.text("file"));
    read_machine();
    read_model(top.table("model"));
    for (const TomlSection& s : top.tables("stylus"))
      read_stylus(s);
    if (top.has("artefact"))
      for (const TomlSection& s : top.tables("artefact"))
        read_artefact(s);
    for (const TomlSection& s : top.tables("setup"))
      read_setup(plan_, {path_.parent_path(), files_}, s);
  }

  // What encoders say is where the axes stood, whatever was added to the targets. What was
  // commanded is that only as long as nothing was.
  void read_compensation(const TomlSection& top) {
    const std::string word = top.text("compensation");
    if (word == "off") return;
    constexpr std::size_t kDigits = 8;
    if (word.size() != kDigits ||
        word.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
      top.complain("compensation",
                   "'compensation' must be \"off\" or the CRC-32 of the image that was active, 8 "
                   "hexadecimal digits");
    if (plan_.commanded)
      top.complain("compensation",
                   "positions that were commanded do not hold what active tables added: measure "
                   "with compensation switched off and state \"off\", or record the encoders "
                   "and state positions = \"actual\"");
    plan_.active_image = word;
  }

  void read_machine() {
    Machine& machine = plan_.problem.machine;
    machine.chain = plan_.machine.chain;
    for (std::size_t a = 0; a < plan_.machine.axes.size(); ++a) {
      const AxisFile& axis = plan_.machine.axes[a];
      machine.travel.at(a) = {axis.lo, axis.hi, axis.reference, axis.full_turn()};
    }
  }

  static std::size_t channel_of(const TomlSection& s, const std::string& key,
                                const std::string& name) {
    const auto* const found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
    if (found == kChannelNames.end())
      s.complain(key, fmt::format("'{}': {} is none of EX EY EZ EA EB EC", key, name));
    return static_cast<std::size_t>(found - kChannelNames.begin());
  }

  // "{ X = ["EX", "EY"], … }" by axis.
  void read_channels(const TomlSection& model, const std::string& key,
                     const std::function<void(std::size_t axis, const Channels&)>& take) {
    const TomlValue& table = model.need(key);
    if (!table.is_table()) model.complain(key, fmt::format("'{}' must be a table", key));
    for (const auto& [name, list] : table.table()) {
      Channels channels;
      for (const std::string& word : words_of(model, key, list))
        channels.push_back(channel_of(model, key, word));
      std::sort(channels.begin(), channels.end());
      take(axis_named(plan_, model, key, name), channels);
    }
  }

  void read_model(const TomlSection& model) {
    model.allow_only({"segments", "channels", "reversal", "reversal_channels", "location",
                      "constant", "gauge", "curvature_um", "curvature_urad"});
    ErrorModel& m = plan_.problem.model;
    read_segments(model);
    if (model.has("channels"))
      read_channels(model, "channels",
                    [&](std::size_t a, const Channels& c) { m.functions.at(a).channels = c; });
    if (model.has("reversal") && model.choice("reversal", {"none", "constant"}) == 1)
      for (AxisFunctions& f : m.functions)
        f.reversal = f.channels;
    if (model.has("reversal_channels"))
      read_channels(model, "reversal_channels",
                    [&](std::size_t a, const Channels& c) { m.functions.at(a).reversal = c; });
    ask_for_locations(plan_.problem);
    for (const char* key : {"location", "constant"}) {
      auto& where = std::string(key) == "location" ? m.location : m.constant;
      if (!model.has(key)) continue;
      where = {};
      read_channels(model, key, [&](std::size_t a, const Channels& c) { where.at(a) = c; });
    }
    if (model.has("gauge")) read_gauge(model);
    if (model.has("curvature_um") != model.has("curvature_urad"))
      model.complain(model.has("curvature_um") ? "curvature_um" : "curvature_urad",
                     "curvature_um and curvature_urad belong together");
    if (model.has("curvature_um"))
      m.curvature = Curvature{kMmPerUm * positive(model, "curvature_um"),
                              kRadPerUrad * positive(model, "curvature_urad")};
  }

  void read_segments(const TomlSection& model) {
    constexpr long kMostSegments = 200;
    const TomlValue& table = model.need("segments");
    if (!table.is_table()) model.complain("segments", "'segments' must be a table, { X = 6, … }");
    const TomlSection segments = model.table("segments");
    for (const auto& entry : table.table()) {
      const std::size_t a = axis_named(plan_, model, "segments", entry.first);
      const long least = plan_.machine.axes[a].full_turn() ? 4 : 1;
      AxisFunctions& f = plan_.problem.model.functions.at(a);
      f.segments = static_cast<std::size_t>(segments.integer(entry.first, least, kMostSegments));
      f.channels = {0, 1, 2, 3, 4, 5};
    }
  }

  void read_gauge(const TomlSection& model) {
    const TomlValue& rows = model.need("gauge");
    if (!rows.is_array()) model.complain("gauge", R"('gauge' must be a list of ["Y", "EX"])");
    for (const TomlValue& row : rows.array()) {
      const std::vector<std::string> pair = words_of(model, "gauge", row);
      if (pair.size() != 2) model.complain("gauge", R"('gauge' must be a list of ["Y", "EX"])");
      plan_.problem.model.gauge.push_back(
          {axis_named(plan_, model, "gauge", pair[0]), channel_of(model, "gauge", pair[1])});
    }
  }

  void read_stylus(const TomlSection& s) {
    s.allow_only({"name", "offset_mm", "radius_mm", "reference", "u_mm", "radius_u_um"});
    Stylus stylus;
    stylus.name = name_of(s, "name");
    stylus.offset = vector_of(s, "offset_mm");
    stylus.radius = s.number_or("radius_mm", 0.0);
    if (stylus.radius < 0.0) s.complain("radius_mm", "'radius_mm' must not be negative");
    const bool reference = s.truth_or("reference", false);
    if (reference && s.has("u_mm"))
      s.complain("u_mm", "the tip of the reference stylus is the functional point: it has no u_mm");
    if (!reference) stylus.place = s.has("u_mm") ? positive(s, "u_mm") : kFree;
    if (s.has("radius_u_um")) stylus.radius_prior = prior_of(s, "radius_u_um", kMmPerUm);
    plan_.problem.styli.push_back(stylus);
  }

  void read_artefact(const TomlSection& s) {
    s.allow_only({"name", "spheres_mm", "radius_mm", "calibrated", "u_um", "scale_ppm", "lengths"});
    Artefact a;
    a.name = name_of(s, "name");
    read_spheres(s, a);
    read_radii(s, a);
    static_cast<void>(s.need("calibrated"));
    const bool calibrated = s.truth_or("calibrated", false);
    if (!calibrated) {
      a.place = kFree;
    } else if (const double u = s.number("u_um"); u > 0.0) {
      a.place = kMmPerUm * u;
    } else if (u < 0.0) {
      s.complain("u_um", "'u_um' must not be negative");
    }
    if (s.has("scale_ppm")) a.scale = prior_of(s, "scale_ppm", kPpm);
    if (s.has("lengths"))
      for (const TomlSection& l : s.tables("lengths"))
        a.lengths.push_back(length_of(l, a.spheres.size()));
    plan_.problem.artefacts.push_back(std::move(a));
  }

  static Length length_of(const TomlSection& l, std::size_t spheres) {
    l.allow_only({"a", "b", "mm", "u_um"});
    const long last = static_cast<long>(spheres) - 1;
    if (l.integer("a", 0, last) == l.integer("b", 0, last))
      l.complain("b", "'a' and 'b' of a length must be two spheres");
    return {static_cast<std::size_t>(l.integer("a", 0, last)),
            static_cast<std::size_t>(l.integer("b", 0, last)), positive(l, "mm"),
            kMmPerUm * positive(l, "u_um")};
  }

  static void read_spheres(const TomlSection& s, Artefact& a) {
    const char* const wrong = "'spheres_mm' must be a list of [x, y, z]";
    const TomlValue& list = s.need("spheres_mm");
    if (!list.is_array() || list.array().empty()) s.complain("spheres_mm", wrong);
    for (const TomlValue& place : list.array()) {
      if (!place.is_array() || place.array().size() != 3) s.complain("spheres_mm", wrong);
      Vec3 c;
      for (std::size_t k = 0; k < 3; ++k) {
        const TomlValue& v = place.array()[k];
        const double mm = v.is_number() ? v.number() : std::nan("");
        if (!std::isfinite(mm)) s.complain("spheres_mm", wrong);
        c(static_cast<Eigen::Index>(k)) = mm;
      }
      a.spheres.push_back(c);
    }
  }

  static void read_radii(const TomlSection& s, Artefact& a) {
    if (!s.has("radius_mm")) return;
    a.radius = s.need("radius_mm").is_array()
                   ? s.numbers("radius_mm", a.spheres.size())
                   : std::vector<double>(a.spheres.size(), s.number("radius_mm"));
    for (const double r : a.radius)
      if (!(r > 0.0)) s.complain("radius_mm", "'radius_mm' must be larger than 0");
  }

  std::filesystem::path path_;
  const PlanFiles& files_;
  MeasurementPlan plan_;
};

}  // namespace

bool MeasurementPlan::has_readings() const {
  return std::all_of(problem.setups.begin(), problem.setups.end(), [](const SetUp& s) {
    return s.kind == ObservationKind::touch || !s.y.empty();
  });
}

MeasurementPlan read_plan(const std::filesystem::path& path, const PlanFiles& files) {
  return PlanReader(path, files).read();
}

namespace {

constexpr BundledFiles kPlans{"plans", ".toml", "VOLCOMP_PLANS"};

}  // namespace

std::vector<std::string> bundled_plans() { return names_of(kPlans); }

std::filesystem::path bundled_plan(const std::string& name) { return path_of(kPlans, name); }

}  // namespace volcomp::host::identify
