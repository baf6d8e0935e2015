#include "host_sim/host/machine/machine_bus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "firmware/node/wire_scale.hpp"

namespace volcomp::host {
namespace {

constexpr long kLastNode = 127;
constexpr long kMostUnits = 1L << 40;  // in one mm or turn

struct Ratio {
  long over = 1;
  long under = 1;
};

// A whole number, or two of them that are a fraction.
Ratio read_ratio(const TomlSection& s, const std::string& key) {
  const auto whole = [&](const TomlValue& v, long most) {
    if (!v.is_integer() || v.integer() < 1 || v.integer() > most)
      s.complain(key, fmt::format("'{}' must be a whole number above 0, or two of them [units, of "
                                  "so many]",
                                  key));
    return v.integer();
  };
  const TomlValue& v = s.need(key);
  if (!v.is_array()) return {whole(v, kMostUnits), 1};
  if (v.array().size() != 2)
    s.complain(key, fmt::format("'{}' must be a number or a list of 2 numbers", key));
  return {whole(v.array()[0], kMostUnits), whole(v.array()[1], node::kMostScale)};
}

// A turn of so many units needs no fraction (2036h).
bool take_units_per_turn(const Ratio& wire, DriveFile& drive) {
  if (wire.under != 1 || wire.over > UINT32_MAX) return false;
  drive.scale_numerator = drive.scale_denominator = 1;
  drive.units_per_turn = static_cast<std::uint32_t>(wire.over);
  return true;
}

// `inside`: run-time units in one mm or turn.
void read_scale(const TomlSection& s, const std::string& key, long inside, DriveFile& drive) {
  if (!s.has(key)) return;
  const Ratio wire = read_ratio(s, key);
  const long numerator = inside * wire.under;
  const long common = std::gcd(numerator, wire.over);
  const auto n = static_cast<std::uint64_t>(numerator / common);
  const auto d = static_cast<std::uint64_t>(wire.over / common);
  if (n > node::kMostScale || d > node::kMostScale) {
    if (inside == kUnitsPerTurn && take_units_per_turn(wire, drive)) return;
    s.complain(key, fmt::format("'{}' makes a unit of the drive {}/{} of {}: neither may be above "
                                "{}",
                                key, n, d, inside == kUnitsPerTurn ? "2^-40 turn" : "a nanometre",
                                node::kMostScale));
  }
  drive.scale_numerator = static_cast<std::uint32_t>(n);
  drive.scale_denominator = static_cast<std::uint32_t>(d);
}

void check_range(const TomlSection& s, const AxisFile& axis, const DriveFile& drive) {
  const double per_mm = kNmPerMm * drive.scale_denominator / drive.scale_numerator;
  const double most = std::max(std::abs(axis.lo), std::abs(axis.hi)) * per_mm;
  if (most <= 2147483647.0) return;
  s.complain("travel_mm", fmt::format("{:.0f} units of the drive at the end of the travel of axis "
                                      "{} do not fit into its 32 bits",
                                      most, axis.letter));
}

// 2^32 units of the drive are so many turns without rest. A turn has 2^40 run-time units.
bool counts_whole_turns(const DriveFile& drive) {
  constexpr std::uint64_t kWire = std::uint64_t{1} << 32U;
  if (drive.units_per_turn != 0) return kWire % drive.units_per_turn == 0;
  return drive.scale_numerator % (256 * std::uint64_t{drive.scale_denominator}) == 0;
}

// Where 2^32 units are no whole number of turns, a node that starts does not know how often the 32
// bits have wrapped. The travel must stay inside.
void check_turns(const TomlSection& s, const AxisFile& axis, const DriveFile& drive) {
  if (counts_whole_turns(drive)) return;
  const double per_turn = units_per_turn(drive);
  constexpr double kMost = 2147483647.0;  // INTEGER32
  const double most = std::max(std::abs(axis.lo), std::abs(axis.hi));
  const double fits = kMost / per_turn * 2.0 * kPi;
  if (most <= fits) return;
  s.complain("travel_rad",
             fmt::format("the travel of axis {} goes to {:.6g} rad, the 32 bits of its drive with "
                         "{:.0f} units per turn only to {:.6g} rad, and beyond them the turn is "
                         "lost",
                         axis.letter, most, per_turn, fits));
}

// Bits of 6041h, or "none" where no bit tells.
std::uint16_t read_referenced_mask(const TomlSection& s) {
  if (s.need("referenced_mask").is_text()) {
    static_cast<void>(s.choice("referenced_mask", {"none"}));
    return 0;
  }
  return static_cast<std::uint16_t>(s.integer_or("referenced_mask", 0, 1, UINT16_MAX));
}

void read_software_limits(const TomlSection& s, const AxisFile& axis, DriveFile& drive) {
  const auto limits = s.numbers<2>("software_limits_mm");
  if (!(limits[0] <= axis.lo && limits[1] >= axis.hi))
    s.complain("software_limits_mm", "'software_limits_mm' must be [low, high] around the travel");
  drive.software_limits_mm = limits;
}

struct WayWord {
  Way way;
  const char* word;
};
constexpr std::array kWays{WayWord{Way::offset, "offset"},
                           WayWord{Way::forwarded_target, "forwarded"},
                           WayWord{Way::controller_adds, "controller"}, WayWord{Way::none, "none"}};

Way read_way(const TomlSection& s) {
  std::vector<std::string> words;
  words.reserve(kWays.size());
  for (const WayWord& one : kWays)
    words.emplace_back(one.word);
  return kWays.at(s.choice("way", words)).way;
}

double read_cycle(const TomlSection& s) {
  const double hz = s.number("cycle_hz");
  if (!(hz >= kLeastCycle_hz && hz <= kMostCycle_hz))
    s.complain("cycle_hz", fmt::format("'cycle_hz' must be between {:g} and {:g}", kLeastCycle_hz,
                                       kMostCycle_hz));
  return hz;
}

}  // namespace

const char* word_of_way(Way way) {
  const auto* const found =
      std::find_if(kWays.begin(), kWays.end(), [way](const WayWord& w) { return w.way == way; });
  return found->word;
}

double units_per_turn(const DriveFile& drive) {
  if (drive.units_per_turn != 0) return drive.units_per_turn;
  return static_cast<double>(kUnitsPerTurn) * drive.scale_denominator / drive.scale_numerator;
}

const std::vector<std::string>& drive_fields() {
  static const std::vector<std::string> kFields{
      "node_id", "units_per_mm", "units_per_turn", "software_limits_mm", "reports_offset",
      "drive",   "way",          "referenced_mask"};
  return kFields;
}

DriveFile read_drive(const TomlSection& s, const AxisFile& axis, std::size_t number) {
  DriveFile drive;
  drive.node = static_cast<std::uint8_t>(
      s.integer_or("node_id", static_cast<long>(number) + 1, 1, kLastNode));
  if (s.has("reports_offset")) drive.reports_offset = s.truth_or("reports_offset", true);
  if (s.has("drive")) drive.model = s.text("drive");
  if (s.has("way")) drive.way = read_way(s);
  if (s.has("referenced_mask")) drive.referenced_mask = read_referenced_mask(s);
  if (axis.rotary) {
    for (const char* const key : {"units_per_mm", "software_limits_mm"}) {
      if (s.has(key)) s.complain(key, fmt::format("'{}' is for linear axes", key));
    }
    drive.scale_numerator = 512;  // 2^31 units per turn on the wire, 2^40 inside
    read_scale(s, "units_per_turn", static_cast<long>(kUnitsPerTurn), drive);
    check_turns(s, axis, drive);
    return drive;
  }
  if (s.has("units_per_turn")) s.complain("units_per_turn", "'units_per_turn' is for rotary axes");
  read_scale(s, "units_per_mm", static_cast<long>(kNmPerMm), drive);
  check_range(s, axis, drive);
  if (s.has("software_limits_mm")) read_software_limits(s, axis, drive);
  return drive;
}

void read_bus(const TomlSection& top, MachineFile& file) {
  if (top.has("bus")) {
    const TomlSection s = top.table("bus");
    s.allow_only({"node_id", "controller_id", "cycle_hz"});
    file.bus.stated = true;
    file.bus.node = static_cast<std::uint8_t>(s.integer_or("node_id", file.bus.node, 1, kLastNode));
    file.bus.controller =
        static_cast<std::uint8_t>(s.integer_or("controller_id", file.bus.controller, 1, kLastNode));
    if (s.has("cycle_hz")) file.bus.cycle_hz = read_cycle(s);
  }
  std::map<int, std::string> owner{{file.bus.node, "the compensation node"}};
  const auto claim = [&](int id, const std::string& who) {
    const auto [at, first] = owner.emplace(id, who);
    if (!first)
      top.complain(top.has("bus") ? "bus" : "axis",
                   fmt::format("{} and {} both have the node id {}", at->second, who, id));
  };
  claim(file.bus.controller, "the controller");
  for (const AxisFile& axis : file.axes)
    claim(axis.drive.node, fmt::format("axis {}", axis.letter));
}

}  // namespace volcomp::host
