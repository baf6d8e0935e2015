#include "host_sim/host/measure/identify/plan_setup.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "comp/machine/error_motion.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/plan_readings.hpp"
#include "host_sim/host/measure/identify/plan_values.hpp"

namespace volcomp::host::identify {
namespace {

class SetUpReader {
 public:
  SetUpReader(MeasurementPlan& plan, const TomlSection& s)
      : plan_(plan), problem_(plan.problem), s_(s) {}

  void read(const SetUpFiles& files) {
    setup_.name = name_of(s_, "name");
    setup_.kind =
        static_cast<ObservationKind>(s_.choice("kind", {kKindNames.begin(), kKindNames.end()}));
    for (const char* key : {"scale_ppm", "growth_ppm"})
      if (s_.has(key) && setup_.kind == Kind::runs)
        s_.complain(key, fmt::format("'{}' is not for runs: state it with u_um", key));
    if (s_.has("scale_ppm")) setup_.scale = prior_of(s_, "scale_ppm", kPpm);
    if (s_.has("growth_ppm")) setup_.growth = prior_of(s_, "growth_ppm", kPpm);
    read_fields();
    read_readings(plan_, files, s_, setup_);
    problem_.setups.push_back(std::move(setup_));
  }

 private:
  using Kind = ObservationKind;

  void allow(std::vector<std::string> own) {
    const std::vector<std::string> all{"name",      "kind",       "file",
                                       "scale_ppm", "growth_ppm", "machine_um"};
    own.insert(own.end(), all.begin(), all.end());
    s_.allow_only(own);
  }

  void read_fields() {
    switch (setup_.kind) {
      case Kind::tracer:
        allow({"u_um", "station_mm", "station_u_um", "frame", "tips", "places"});
        setup_.station = vector_of(s_, "station_mm");
        if (s_.has("station_u_um")) setup_.station_prior = kMmPerUm * positive(s_, "station_u_um");
        setup_.in_bed = s_.has("frame") && s_.choice("frame", {"work", "bed"}) == 1;
        break;
      case Kind::bar:
        read_bar();
        break;
      case Kind::diagonal:
        allow({"u_um", "along", "tips"});
        setup_.along = beam_direction();
        break;
      case Kind::step:
        allow({"u_um", "along", "beam_mm", "mirror", "tips"});
        setup_.along = beam_direction();
        setup_.beam = vector_of(s_, "beam_mm");
        setup_.mirror = s_.has("mirror") ? unit_of(s_, "mirror") : *setup_.along;
        break;
      case Kind::rtest:
        allow({"u_um", "ball_mm", "turns_deg", "tips"});
        break;
      case Kind::runs:
        allow({"u_um", "u_urad", "machine_urad", "axis", "slopes"});
        read_axis();
        break;
      case Kind::centre:
      case Kind::touch:
        allow({"probe_um", "artefact", "tips", "more_tips", "more_tips_every", "turns_deg",
               "pose_deg_mm"});
        setup_.artefact = index_named(problem_.artefacts, s_.text("artefact"), s_, "artefact");
        read_pose();
        break;
    }
  }

  // "PPP", signs of X Y Z along a body diagonal of the travels, or a vector in the work frame.
  Vec3 beam_direction() const {
    const TomlValue& v = s_.need("along");
    if (!v.is_text()) return unit_of(s_, "along");
    const std::string& word = v.text();
    Vec3 u;
    for (std::size_t k = 0; k < 3; ++k) {
      const char sign = word.size() == 3 ? word[k] : '?';
      if (sign != 'P' && sign != 'N')
        s_.complain("along", "'along' must be three of P and N for X Y Z, or [x, y, z]");
      const AxisFile& axis = plan_.machine.axes[plan_.machine.axis_index("XYZ"[k])];
      u(static_cast<Eigen::Index>(k)) = (sign == 'P' ? 1.0 : -1.0) * (axis.hi - axis.lo);
    }
    return u.normalized();
  }

  void read_bar() {
    allow({"u_um", "socket_mm", "length_mm", "length_u_um", "plane", "tips"});
    setup_.station = vector_of(s_, "socket_mm");
    setup_.length = positive(s_, "length_mm");
    setup_.length_prior = s_.has("length_u_um") ? kMmPerUm * positive(s_, "length_u_um") : kFree;
    const TomlValue& plane = s_.need("plane");
    if (!plane.is_text()) {
      setup_.normal = unit_of(s_, "plane");
      return;
    }
    const std::array<const char*, 3> names{"YZ", "ZX", "XY"};
    const auto* const found = std::find(names.begin(), names.end(), plane.text());
    if (found == names.end())
      s_.complain("plane", R"('plane' must be "XY", "YZ", "ZX" or the normal [x, y, z])");
    setup_.normal = Vec3::Unit(found - names.begin());
  }

  void read_pose() {
    if (!s_.has("pose_deg_mm")) return;
    const auto p = s_.numbers<6>("pose_deg_mm");
    setup_.pose =
        Placement{exponential(kRadPerDegree * Vec3(p[0], p[1], p[2])), {p[3], p[4], p[5]}};
  }

  void read_axis() {
    setup_.axis = axis_named(plan_, s_, "axis", s_.text("axis"));
    const AxisFile& axis = plan_.machine.axes[setup_.axis];
    setup_.channels = {0, 1, 2, 3, 4, 5};
    setup_.lever = axis.sensed.at_zero;
    setup_.kappa = axis.sensed.kappa;
    setup_.slopes = s_.truth_or("slopes", true);
  }

  MeasurementPlan& plan_;
  Problem& problem_;
  const TomlSection& s_;
  SetUp setup_;
};

}  // namespace

void read_setup(MeasurementPlan& plan, const SetUpFiles& files, const TomlSection& s) {
  SetUpReader(plan, s).read(files);
}

}  // namespace volcomp::host::identify
