#include "comp/metrology/tables/diagonals.hpp"

namespace volcomp {
namespace {

Diagonal diagonal(const DiagonalBox& box, const char* name, const std::array<int, 3>& sign) {
  Diagonal d{name, box.lo, box.hi};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (sign[k] < 0) std::swap(d.start(i), d.end(i));
    if (sign[k] == 0) d.start(i) = d.end(i) = 0.5 * (box.lo(i) + box.hi(i));
  }
  return d;
}

}  // namespace

std::array<Diagonal, 4> body_diagonals(const DiagonalBox& box) {
  return {diagonal(box, "PPP", {1, 1, 1}), diagonal(box, "NPP", {-1, 1, 1}),
          diagonal(box, "PNP", {1, -1, 1}), diagonal(box, "PPN", {1, 1, -1})};
}

std::array<Diagonal, 6> face_diagonals(const DiagonalBox& box) {
  return {diagonal(box, "XY+", {1, 1, 0}), diagonal(box, "XY-", {1, -1, 0}),
          diagonal(box, "XZ+", {1, 0, 1}), diagonal(box, "XZ-", {1, 0, -1}),
          diagonal(box, "YZ+", {0, 1, 1}), diagonal(box, "YZ-", {0, 1, -1})};
}

DiagonalFigures diagonal_figures(Span<const double> deviations) {
  DiagonalFigures f;
  double lo = deviations[0];
  double hi = deviations[0];
  for (const double e : deviations) {
    f.max_abs = std::max(f.max_abs, std::abs(e));
    lo = std::min(lo, e);
    hi = std::max(hi, e);
  }
  f.range = hi - lo;
  return f;
}

}  // namespace volcomp
