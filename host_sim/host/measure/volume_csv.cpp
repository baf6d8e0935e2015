#include "host_sim/host/measure/volume_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "comp/core/units.hpp"
#include "host_sim/host/io/csv_units.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kFewest = 4;
constexpr std::size_t kMost = 100'000;
constexpr double kFarthest_mm = 1e6;
constexpr double kSamePlace_mm = 1e-3;
constexpr std::array<const char*, 6> kColumnNames{"X", "Y", "Z", "DX", "DY", "DZ"};

using Place = std::tuple<long, long, long>;  // micrometres

Place place_of(const VolumePoint& p) {
  const auto key = [&](Eigen::Index k) { return std::lround(p.at_mm(k) / kSamePlace_mm); };
  return {key(0), key(1), key(2)};
}

struct Header {
  std::vector<std::size_t> column;  // of each cell
  std::array<double, 6> factor{};
};

Header read_header(const CsvLines& lines, std::string_view line) {
  Header h;
  std::array<bool, 6> seen{};
  for (const std::string_view cell : lines.header_cells(line)) {
    std::string_view label;
    const double factor = length_unit(lines, cell, label);
    const auto* const found = std::find(kColumnNames.begin(), kColumnNames.end(), label);
    if (found == kColumnNames.end())
      lines.fail(fmt::format("unknown column {} (known: X Y Z DX DY DZ)", quoted(cell)));
    const auto column = static_cast<std::size_t>(found - kColumnNames.begin());
    if (seen.at(column)) lines.fail(fmt::format("column {} occurs twice", quoted(cell)));
    seen.at(column) = true;
    h.factor.at(column) = factor;
    h.column.push_back(column);
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen.at(i))
      lines.fail(fmt::format("the header lacks the column {} [{}] [{}]", kColumnNames.at(i),
                             i < 3 ? "mm" : "um", code(Reason::missing_field)));
  }
  return h;
}

VolumePoint read_point(const CsvLines& lines, const Header& header, std::string_view line) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != header.column.size())
    lines.fail(fmt::format("{} cells instead of {}", cells.size(), header.column.size()));
  VolumePoint p;
  p.line = lines.line();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t column = header.column[i];
    const std::string name = fmt::format("{}: ", kColumnNames.at(column));
    const double mm = lines.number(cells[i], name) * header.factor.at(column);
    if (!std::isfinite(mm) || std::abs(mm) > kFarthest_mm)
      lines.fail(fmt::format("{}{} must be finite and less than a kilometre [{}]", name,
                             quoted(cells[i]), code(Reason::not_finite)));
    (column < 3 ? p.at_mm : p.error_mm)(static_cast<Eigen::Index>(column % 3)) = mm;
  }
  return p;
}

void require_places_of(const VolumeFile& a, const VolumeFile& b) {
  std::map<Place, std::size_t> there;
  for (const VolumePoint& p : b.points)
    there.emplace(place_of(p), p.line);
  for (const VolumePoint& p : a.points) {
    if (there.count(place_of(p)) != 0) continue;
    throw UserError(
        fmt::format("{}: lacks the place {:g} {:g} {:g} mm of {}:{}; before and after must hold "
                    "the same points",
                    b.name, p.at_mm(0), p.at_mm(1), p.at_mm(2), a.name, p.line));
  }
}

}  // namespace

VolumeFile read_volume(std::istream& stream, const std::string& name) {
  CsvLines lines(stream, name);
  std::string line;
  if (!lines.next(line)) throw UserError(name + ": the file is empty");
  const Header header = read_header(lines, line);
  VolumeFile file{name, {}};
  std::map<Place, std::size_t> seen;
  while (lines.next(line)) {
    file.points.push_back(read_point(lines, header, line));
    const auto [it, fresh] = seen.emplace(place_of(file.points.back()), lines.line());
    if (!fresh) lines.fail(fmt::format("the same place as in line {}", it->second));
    if (file.points.size() > kMost) lines.fail(fmt::format("more than {} places", kMost));
  }
  if (file.points.size() < kFewest)
    throw UserError(fmt::format("{}: {} places, at least {} are needed [{}]", name,
                                file.points.size(), kFewest, code(Reason::too_few_points)));
  return file;
}

VolumeFile read_volume_file(const std::filesystem::path& path) {
  InputFile file(path);
  return read_volume(file.stream(), file.name());
}

std::string volume_csv(const VolumeFile& file) {
  std::string text = "X [mm],Y [mm],Z [mm],DX [um],DY [um],DZ [um]\n";
  for (const VolumePoint& p : file.points) {
    const Vec3 um = kUmPerMm * p.error_mm;
    text += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", p.at_mm(0), p.at_mm(1),
                        p.at_mm(2), um(0), um(1), um(2));
  }
  return text;
}

void require_same_places(const VolumeFile& before, const VolumeFile& after) {
  require_places_of(before, after);
  require_places_of(after, before);
}

VolumeFigures volume_figures(const std::vector<VolumePoint>& points) {
  VolumeFigures f;
  double squares = 0.0;
  for (const VolumePoint& p : points) {
    const double length = p.error_mm.norm();
    f.max_um = std::max(f.max_um, kUmPerMm * length);
    squares += length * length;
  }
  f.rms_um = kUmPerMm * std::sqrt(squares / static_cast<double>(points.size()));
  return f;
}

// error ≈ t + w × (p − c), least squares; lengths scaled so that the normal equations are well
// conditioned.
std::vector<VolumePoint> aligned(std::vector<VolumePoint> points) {
  Vec3 lo = points.front().at_mm;
  Vec3 hi = lo;
  for (const VolumePoint& p : points) {
    lo = lo.cwiseMin(p.at_mm);
    hi = hi.cwiseMax(p.at_mm);
  }
  const Vec3 centre = 0.5 * (lo + hi);
  const double scale = std::max(0.5 * (hi - lo).norm(), kSamePlace_mm);
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const auto row = [&](const Vec3& p) {
    Eigen::Matrix<double, 3, 6> A;
    A << Mat3::Identity(), -cross_matrix((p - centre) / scale);
    return A;
  };
  Matrix6 normal = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  for (const VolumePoint& p : points) {
    const auto A = row(p.at_mm);
    normal += A.transpose() * A;
    right += A.transpose() * p.error_mm;
  }
  const auto solver = normal.ldlt();
  if (!(solver.rcond() > 1e-9)) return points;
  const Vector6 rigid = solver.solve(right);
  for (VolumePoint& p : points)
    p.error_mm -= row(p.at_mm) * rigid;
  return points;
}

VolumeFigures aligned_volume_figures(std::vector<VolumePoint> points) {
  return volume_figures(aligned(std::move(points)));
}

std::vector<Vec3> aligned_errors(const std::vector<Vec3>& at_mm,
                                 const std::vector<Vec3>& error_mm) {
  if (at_mm.empty()) return {};
  std::vector<VolumePoint> points;
  for (std::size_t i = 0; i < at_mm.size(); ++i)
    points.push_back({at_mm[i], error_mm.at(i)});
  std::vector<Vec3> errors;
  for (const VolumePoint& p : aligned(std::move(points)))
    errors.push_back(p.error_mm);
  return errors;
}

std::vector<VolumePoint> aligned_by_place(const VolumeFile& file) {
  std::vector<VolumePoint> points = aligned(file.points);
  std::sort(points.begin(), points.end(),
            [](const VolumePoint& a, const VolumePoint& b) { return place_of(a) < place_of(b); });
  return points;
}

}  // namespace volcomp::host
