#include "host_sim/host/bus/drive_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/machine/machine_bus.hpp"

namespace volcomp::host {
namespace {

using canopen::PdoKind;

// A linear axis has a screw of 10 mm. Every unit divides 2^32 turns or none is lost, and fits into
// 2030h:2031h.
struct UsualUnits {
  const char* name = "";
  DriveScale linear;
  DriveScale rotary;
};
constexpr DriveScale kNanometres{1, 1};
constexpr DriveScale kTenNanometres{10, 1};
constexpr DriveScale kScrewOf20Bits{78125, 8192};  // 10^7 nm / 2^20
constexpr DriveScale kTurnOf22Bits{1U << 18U, 1};  // 2^40 / 2^22
constexpr DriveScale kTurnOf28Bits{1U << 12U, 1};  // 20 bits before a gear of 256
constexpr std::array kUsualUnits{
    UsualUnits{"elmo_gold", kNanometres, kTurnOf28Bits},
    UsualUnits{"nanotec_cl4e", kTenNanometres, kTurnOf22Bits},
};
// Counts of an encoder.
constexpr UsualUnits kCounts{"", kScrewOf20Bits, kTurnOf28Bits};

std::int32_t rescaled(std::int32_t units, const DriveScale& from, const DriveScale& to) {
  const double factor =
      static_cast<double>(from.numerator) / from.denominator * to.denominator / to.numerator;
  return static_cast<std::int32_t>(
      std::clamp(std::round(units * factor), -2147483648.0, 2147483647.0));
}

}  // namespace

bool DriveModel::may_map(PdoKind kind, canopen::ObjectId object) const {
  const EdsFileObject* const found = eds_.find(object);
  return found != nullptr && (kind == PdoKind::receive ? found->to_rpdo : found->to_tpdo);
}

bool DriveModel::reports_offset() const { return may_map(PdoKind::transmit, cia402::offset.id()); }

bool DriveModel::counts_sync() const { return has(canopen::object::sync_counter_overflow.id()); }

bool DriveModel::latches() const {
  return has(cia402::function.id()) && may_map(PdoKind::transmit, cia402::status.id()) &&
         may_map(PdoKind::transmit, cia402::positive_1_position.id());
}

bool DriveModel::times_latches() const {
  return latches() && may_map(PdoKind::transmit, cia402::positive_1_time_ns.id());
}

bool DriveModel::counts_edges() const {
  return latches() && may_map(PdoKind::transmit, cia402::positive_1_edge_count.id());
}

std::string DriveModel::obstacle(Way way) const {
  const auto unmapped = [this](canopen::ObjectId object, PdoKind kind) {
    return fmt::format("{:04X}h {}", object.index,
                       has(object)
                           ? fmt::format("cannot be mapped into {} PDO",
                                         kind == PdoKind::receive ? "a receive" : "a transmit")
                           : "is missing");
  };
  const auto need = [&](canopen::ObjectId object, PdoKind kind) {
    return may_map(kind, object) ? std::string() : unmapped(object, kind);
  };
  std::string what = need(cia402::controlword.id(), PdoKind::receive);
  if (what.empty()) what = need(cia402::target.id(), PdoKind::receive);
  if (what.empty()) what = need(cia402::actual.id(), PdoKind::transmit);
  if (what.empty()) what = need(cia402::statusword.id(), PdoKind::transmit);
  if (what.empty() && way == Way::offset) what = need(cia402::offset.id(), PdoKind::receive);
  if (what.empty() && way == Way::forwarded_target)
    what = need(cia402::mode_display.id(), PdoKind::transmit);
  return what;
}

Way DriveModel::fitting_way() const {
  return obstacle(Way::offset).empty() ? Way::offset : Way::forwarded_target;
}

DriveScale DriveModel::usual_scale(bool rotary) const {
  const auto* const found = std::find_if(kUsualUnits.begin(), kUsualUnits.end(),
                                         [this](const UsualUnits& u) { return u.name == name_; });
  const UsualUnits& units = found == kUsualUnits.end() ? kCounts : *found;
  return rotary ? units.rotary : units.linear;
}

std::shared_ptr<const DriveModel> find_drive_model(const std::string& name_or_path,
                                                   const std::filesystem::path& folder) {
  const std::filesystem::path beside = folder / name_or_path;
  std::error_code ignored;
  const bool is_beside = !folder.empty() && name_or_path.find('.') != std::string::npos &&
                         std::filesystem::exists(beside, ignored);
  return std::make_shared<const DriveModel>(
      name_or_path, find_drive_eds(is_beside ? beside.string() : name_or_path));
}

void put_model(BusAxis& axis, std::shared_ptr<const DriveModel> model) {
  if (const std::string what = model->obstacle(axis.way); !what.empty())
    throw UserError(fmt::format("axis {}: the drive {} cannot be corrected by way \"{}\": {}",
                                axis.letter, model->name(), word_of_way(axis.way), what));
  axis.reports_offset = axis.way == Way::offset && model->reports_offset();
  axis.model = std::move(model);
}

void change_scale(BusAxis& axis, const DriveScale& scale) {
  const DriveScale before{axis.scale_numerator, axis.scale_denominator};
  axis.lowest = rescaled(axis.lowest, before, scale);
  axis.highest = rescaled(axis.highest, before, scale);
  axis.scale_numerator = scale.numerator;
  axis.scale_denominator = scale.denominator;
  axis.units_per_turn = 0;
}

BusSettings with_models(BusSettings settings, const std::vector<std::string>& names) {
  if (names.size() != 1 && names.size() != settings.axes.size())
    throw UserError(
        fmt::format("{} drives are named for {} axes; name one for all, or one for each",
                    names.size(), settings.axes.size()));
  for (std::size_t a = 0; a < settings.axes.size(); ++a) {
    BusAxis& axis = settings.axes[a];
    auto model = find_drive_model(names.size() == 1 ? names.front() : names[a]);
    if (axis.way == Way::offset) axis.way = model->fitting_way();
    put_model(axis, std::move(model));
    change_scale(axis, axis.model->usual_scale(axis.rotary));
  }
  require_latches(settings);
  return settings;
}

void require_latches(const BusSettings& settings) {
  if (!settings.probes) return;
  for (const BusAxis& axis : settings.axes) {
    if (axis.model == nullptr || axis.model->latches()) continue;
    throw UserError(
        fmt::format("axis {}: the machine has a touch probe, and the drive {} no input for it: "
                    "60B8h, 60B9h or 60BAh is missing",
                    axis.letter, axis.model->name()));
  }
}

}  // namespace volcomp::host
