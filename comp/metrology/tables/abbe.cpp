#include "comp/metrology/tables/abbe.hpp"

namespace volcomp {

ErrorMotion at_lever(const ErrorMotion& at_head, const Vec3& lever) {
  ErrorMotion e = at_head;
  e.head<3>() += rotation(e).cross(lever);
  return e;
}

ErrorMotion at_head(const ErrorMotion& measured, const Vec3& lever) {
  return at_lever(measured, -lever);
}

}  // namespace volcomp
