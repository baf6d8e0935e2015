#include "host_sim/host/bus/drive_check/drive_units.hpp"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "comp/core/units.hpp"

namespace volcomp::host {
namespace {

// 60A8h: prefix, a signed power of ten, in bits 31…24; unit in bits 23…16 (CiA 303-2).
constexpr std::uint8_t kMetre = 0x01;
constexpr std::uint8_t kDegree = 0x41;
constexpr std::uint8_t kIncrements = 0xB5;

constexpr std::uint64_t kMostScale = std::uint64_t{1} << 20U;  // of 2030h and 2031h

std::optional<std::pair<std::uint32_t, std::uint32_t>> fraction(std::uint64_t numerator,
                                                                std::uint64_t denominator) {
  const std::uint64_t common = std::gcd(numerator, denominator);
  if (common == 0 || numerator / common > kMostScale || denominator / common > kMostScale)
    return std::nullopt;
  return std::pair{static_cast<std::uint32_t>(numerator / common),
                   static_cast<std::uint32_t>(denominator / common)};
}

std::uint64_t power_of_ten(int exponent) {
  std::uint64_t power = 1;
  for (int i = 0; i < exponent; ++i)
    power *= 10;
  return power;
}

// A ratio of two sub-indices; 1 where the drive has no such object.
struct Ratio {
  std::uint64_t numerator = 1;
  std::uint64_t denominator = 1;
};

std::optional<Ratio> ratio(const ForeignDrive& drive, std::uint16_t index, std::string& told_by) {
  if (!drive.has(index, 1)) return Ratio{};
  const auto above = drive.number(index, 1);
  const auto below = drive.number(index, 2);
  if (!above || *above == 0 || *above > UINT32_MAX) return std::nullopt;
  if (below.value_or(1) == 0 || below.value_or(1) > UINT32_MAX) return std::nullopt;
  told_by += fmt::format("{}{:04X}h = {} : {}", told_by.empty() ? "" : ", ", index, *above,
                         below.value_or(1));
  return Ratio{*above, below.value_or(1)};
}

void count_metres(DriveUnits& units, int prefix) {
  const int power = prefix + 9;  // nm
  units.nm_per_unit = std::pow(10.0, power);
  if (std::abs(power) > 9) return;
  units.scale = power < 0 ? fraction(1, power_of_ten(-power)) : fraction(power_of_ten(power), 1);
}

void count_degrees(DriveUnits& units, int prefix) {
  if (prefix > 0 || prefix < -9) {
    units.unknown = "60A8h counts in a unit that is no part of a degree";
    return;
  }
  const std::uint64_t per_turn = 360 * power_of_ten(-prefix);
  units.per_turn = static_cast<double>(per_turn);
  units.whole_per_turn = per_turn;
  units.scale = fraction(static_cast<std::uint64_t>(kUnitsPerTurn), per_turn);
}

void count_increments(DriveUnits& units, const ForeignDrive& drive) {
  const auto encoder = ratio(drive, 0x608F, units.told_by);
  const auto gear = ratio(drive, 0x6091, units.told_by);
  if (!encoder || !gear || (!drive.has(0x608F, 1) && !drive.has(0x6091, 1))) {
    units.unknown = "the drive does not tell how many units a turn has: see its manual";
    return;
  }
  const std::uint64_t above = encoder->numerator * gear->numerator;
  const std::uint64_t below = encoder->denominator * gear->denominator;
  if (above == below) {
    units.unknown =
        "its factors cancel out: it counts increments of an encoder that they do not tell";
    return;
  }
  const std::uint64_t common = std::gcd(above, below);
  units.per_turn = static_cast<double>(above) / static_cast<double>(below);
  if (above % below == 0) units.whole_per_turn = above / below;
  constexpr auto kTurn = static_cast<std::uint64_t>(kUnitsPerTurn);
  // Beyond 2^20 a fraction has no scale, and beyond 2^23 the product with 2^40 would not fit.
  if (below / common <= kMostScale)
    units.scale = fraction(kTurn * (below / common), above / common);
}

}  // namespace

void DriveUnits::become_linear(double feed_mm) {
  if (!per_turn) return;
  nm_per_unit = feed_mm * kNmPerMm / *per_turn;
  const auto feed_nm = static_cast<std::uint64_t>(std::llround(feed_mm * kNmPerMm));
  scale = whole_per_turn ? fraction(feed_nm, *whole_per_turn) : std::nullopt;
}

bool DriveUnits::survives_wrap() const {
  const std::uint64_t n = whole_per_turn.value_or(0);
  return n > 0 && (n & (n - 1U)) == 0 && n <= (std::uint64_t{1} << 32U);
}

bool DriveUnits::fits_units_per_turn() const {
  const std::uint64_t n = whole_per_turn.value_or(0);
  return !nm_per_unit && n > 0 && n <= UINT32_MAX;
}

DriveUnits units_of(const ForeignDrive& drive) {
  DriveUnits units;
  const auto code = drive.number(0x60A8);
  if (code) units.told_by = fmt::format("60A8h = {:08X}h", *code);
  const auto unit =
      static_cast<std::uint8_t>(code.value_or(std::uint32_t{kIncrements} << 16U) >> 16U);
  const int prefix = static_cast<std::int8_t>(code.value_or(0) >> 24U);
  if (unit == kMetre) {
    count_metres(units, prefix);
  } else if (unit == kDegree) {
    count_degrees(units, prefix);
  } else if (unit == kIncrements || unit == 0) {
    count_increments(units, drive);
  } else {
    units.unknown = "60A8h has a unit that is neither metre nor degree nor increment";
  }
  return units;
}

std::string describe(const DriveUnits& units) {
  if (!units.unknown.empty()) return "not known";
  std::string text = units.per_turn ? fmt::format("{:.15g} per turn", *units.per_turn)
                                    : fmt::format("{:.9g} nm", *units.nm_per_unit);
  if (units.scale)
    text += fmt::format(", 2030h : 2031h = {} : {}", units.scale->first, units.scale->second);
  else if (units.fits_units_per_turn())
    text += fmt::format(", rotary: 2036h = {}", *units.whole_per_turn);
  return text;
}

std::string coarseness(const DriveUnits& units) {
  constexpr double kCoarse_nm = 100.0;
  constexpr double kCoarse_urad = 1.0;
  if (units.nm_per_unit)
    return *units.nm_per_unit > kCoarse_nm
               ? fmt::format("a unit is {:.3g} um: no correction is finer",
                             *units.nm_per_unit * 1e-3)
               : std::string();
  const double urad = units.per_turn ? 2e6 * kPi / *units.per_turn : 0.0;
  return urad > kCoarse_urad
             ? fmt::format(
                   "a unit is {:.3g} urad of a rotary axis: no correction is finer (--feed "
                   "MM for a linear one)",
                   urad)
             : std::string();
}

}  // namespace volcomp::host
