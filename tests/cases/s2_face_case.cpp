#include "tests/cases/s2_face_case.hpp"

#include "comp/core/units.hpp"
#include "comp/probe/face_relief.hpp"

namespace volcomp::cases {

FaceGear face_gear_of(const json& in) {
  FaceGear gear;
  gear.shaper_teeth = in.at("Ns").get<int>();
  gear.teeth = in.at("N2").get<int>();
  gear.module = number(in.at("m"));
  gear.pressure_angle = number(in.at("alpha_deg")) * kPi / 180.0;
  gear.shaper_addendum = number(in.at("ca"));
  gear.addendum = number(in.at("ha"));
  if (const json& relief = in.at("relief"); !relief.is_null())
    gear.relief = {number(relief.at("amp")), number(relief.at("z0")), number(relief.at("length"))};
  require(derive(gear));
  return gear;
}

FaceFlank face_flank_of(const FaceGear& gear, const json& in) {
  FaceFlank flank;
  require(choose_flank(gear, in.at("side").get<int>(), in.value("slot", 0), flank));
  return flank;
}

FaceFoot face_foot_of(const FaceGear& gear, const FaceFlank& flank, const json& in) {
  const Vec3 q = vector3(in.at("Q"));
  return in.at("relieved").get<bool>() ? distance_from_relieved_face(gear, flank, q)
                                       : distance_from_face(gear, flank, q);
}

const char* face_name(Reason reason) {
  switch (reason) {
    case Reason::ok:
      return "OK";
    case Reason::not_finite:
      return "NAN";
    case Reason::inside_gear_base:
      return "INNER";
    case Reason::no_regular_flank:
      return "NOCONV";
    case Reason::below_involute:
      return "BELOW_BASE";
    case Reason::undercut:
      return "UNDERCUT";
    case Reason::in_fillet:
      return "SHAPER_TIP";
    case Reason::above_tip:
      return "ABOVE_TIP";
    case Reason::bad_point:
      return "BAD_POINT";
    case Reason::two_flanks:
      return "TWO_FLANKS";
    case Reason::opposite_flank:
      return "WRONG_FLANK";
    case Reason::ball_in_metal:
      return "INSIDE";
    case Reason::nothing_touched:
      return "NO_CONTACT";
    default:
      return "?";
  }
}

}  // namespace volcomp::cases
