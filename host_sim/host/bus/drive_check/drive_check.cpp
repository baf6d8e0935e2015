#include "host_sim/host/bus/drive_check/drive_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "firmware/canopen/cob_id.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/bus/drive_check/drive_units.hpp"
#include "host_sim/host/bus/drive_check/mapping_facts.hpp"

namespace volcomp::host {
namespace {

using canopen::PdoKind;

constexpr std::uint16_t kOffset = 0x60B0;
constexpr std::uint32_t kCyclicPosition = 1U << 7U;  // 6502h
constexpr std::uint32_t kInterpolatedPosition = 1U << 6U;

const char* yes_or_no(bool yes) { return yes ? "yes" : "no"; }

class Checker {
 public:
  Checker(const ForeignDrive& drive, const DriveCheckOptions& options)
      : drive_(drive), options_(options) {
    check_.node = drive.node;
  }

  DriveCheck check() {
    check_.name = name();
    device();
    if (!drive_.is_cia402()) return std::move(check_);
    mode();
    offset();
    pdos();
    way();
    probe();
    following_error();
    sync();
    watch();
    limits();
    units();
    return std::move(check_);
  }

 private:
  void fact(const char* key, const char* title, std::string value, std::string objects) {
    check_.facts.push_back({key, title, std::move(value), std::move(objects)});
  }
  void miss(std::string sentence) { check_.missing.push_back(std::move(sentence)); }
  void warn(std::string sentence) { check_.warnings.push_back(std::move(sentence)); }

  // "6502h = 000003EDh", "1019h absent".
  [[nodiscard]] std::string shown(std::uint16_t index, std::uint8_t sub = 0) const {
    const std::string id =
        sub == 0 ? fmt::format("{:04X}h", index) : fmt::format("{:04X}h:{:02X}", index, sub);
    if (!drive_.has(index, sub)) return id + " absent";
    const ForeignValue& value = drive_.objects.at({index, sub});
    if (!value.number) return id + " is there";
    return fmt::format("{} = {:0{}X}h", id, *value.number, 2 * value.bytes);
  }

  [[nodiscard]] std::string name() const {
    std::string name = drive_.text(0x1008);
    if (name.empty() && drive_.rules) name = drive_.rules->product();
    if (name.empty()) name = "drive without a name";
    const std::string firmware = drive_.text(0x100A);
    return firmware.empty() ? name : fmt::format("{}, firmware {}", name, firmware);
  }

  void device() {
    const bool drive = drive_.is_cia402();
    fact("device", "CiA 402 drive", yes_or_no(drive), shown(0x1000));
    if (!drive) miss("no CiA 402 drive: the low half of 1000h is not 402");
    if (drive_.number(0x1018, 1))
      fact("identity", "vendor, product, revision",
           fmt::format("{:X}h, {:X}h, {:X}h", *drive_.number(0x1018, 1),
                       drive_.number(0x1018, 2).value_or(0), drive_.number(0x1018, 3).value_or(0)),
           "1018h");
  }

  void mode() {
    const auto modes = drive_.number(0x6502);
    csp_ = modes ? std::optional((*modes & kCyclicPosition) != 0) : std::nullopt;
    const char* const value = !csp_                                   ? "not known"
                              : *csp_                                 ? "yes"
                              : (*modes & kInterpolatedPosition) != 0 ? "no, only interpolated"
                                                                      : "no";
    fact("csp", "cyclic synchronous position", value, shown(0x6502));
    if (csp_ == false) miss("it runs no cyclic synchronous position (6502h bit 7): no way fits");
    if (!csp_) warn("6502h tells no modes: only trying 6060h = 8 tells whether it runs csp");
  }

  // An index is no promise: 60B0h of some old firmware starts the drive.
  [[nodiscard]] bool offset_is_integer32() const {
    if (!drive_.has(kOffset)) return false;
    const std::size_t bytes = drive_.objects.at({kOffset, 0}).bytes;
    return bytes == 0 || bytes == 4;
  }

  void offset() {
    const bool there = offset_is_integer32();
    to_drive_ = there ? drive_.may_map(PdoKind::receive, kOffset) : false;
    from_drive_ = there ? drive_.may_map(PdoKind::transmit, kOffset) : false;
    std::string value = "absent";
    if (drive_.has(kOffset) && !there) {
      value = "not four bytes long: not the offset of CiA 402";
    } else if (there) {
      value = !to_drive_   ? "there; whether a PDO takes it, only trying tells"
              : *to_drive_ ? (from_drive_ == true    ? "by PDO, reported in a TPDO"
                              : from_drive_ == false ? "by PDO; not in a TPDO"
                                                     : "by PDO")
                           : "by SDO only";
    }
    fact("offset", "position offset", value, shown(kOffset) + trial_text(drive_));
    if (drive_.moved) judge_move(*drive_.moved);
    if (!drive_.tried) return;
    for (const std::string& note : drive_.tried->notes)
      warn(note);
  }

  void judge_move(MovedDemand moved) {
    fact("offset_meaning", "60B0h by SDO",
         moved == MovedDemand::as_named    ? "moves the demand value by as much"
         : moved == MovedDemand::otherwise ? "moves the demand value by something else"
                                           : "moves no demand value while disabled: not known",
         "6062h, 60FCh, tried");
    if (moved == MovedDemand::otherwise) miss("60B0h does not mean what its name says");
  }

  void pdos() {
    for (const ForeignPdo& pdo : drive_.receive)
      show(pdo, "RPDO", "rpdo");
    for (const ForeignPdo& pdo : drive_.transmit)
      show(pdo, "TPDO", "tpdo");
    const std::uint32_t id = canopen::kRpdo1 + 0x100U + drive_.node;
    for (const ForeignPdo& pdo : drive_.receive) {
      if (pdo.valid() && pdo.id() == id && !pdo.maps(kOffset))
        warn(
            fmt::format("without its mapping (after a reset) RPDO{} hears {:03X}h: an offset there "
                        "would be taken for {}",
                        pdo.number, id, mapping_text(pdo.mapping)));
    }
  }

  void show(const ForeignPdo& pdo, const char* title, const char* key) {
    if (!pdo.valid()) return;
    const std::string name = fmt::format("{}{}", title, pdo.number);
    fact(fmt::format("{}{}", key, pdo.number).c_str(), name.c_str(),
         fmt::format("{:03X}h, type {}: {}", pdo.id(), pdo.type, mapping_text(pdo.mapping)), "");
  }

  // The offset where a PDO takes it; else the target by way of the node, which needs 607Ah in a
  // PDO of its own; else the controller adds.
  void way() {
    fact("forwarding", "target by the node", forwarding_text(drive_),
         drive_.tried   ? "tried"
         : drive_.rules ? "by its EDS"
                        : "");
    if (csp_ == false) return;
    if (drive_.may_come_at_sync(PdoKind::receive) == false)
      warn("no RPDO takes type 1: what the node sends acts when it comes, not at SYNC");
    if (to_drive_ != false) {
      check_.best = Way::offset;
      check_.best_is_sure = to_drive_;
      check_.confirmed = from_drive_;
    } else {
      const std::optional<bool> target = may_be_forwarded(drive_);
      check_.best = target != false ? Way::forwarded_target : Way::controller_adds;
      check_.best_is_sure = target ? std::optional(true) : std::nullopt;
      const std::string reason = drive_.has(kOffset) ? "60B0h cannot be mapped into an RPDO"
                                                     : "60B0h, the position offset, is absent";
      warn(fmt::format("{}: {}", reason,
                       target != false ? "its target has to come from the node, and stops with it"
                                       : "the controller has to add what the node tells it"));
    }
  }

  void probe() {
    const bool latches = drive_.has(0x60B8) && drive_.has(0x60BA);
    const bool times = drive_.has(0x60D1);
    fact("probe", "touch probe",
         !latches ? "none"
         : times  ? "latches, says when"
                  : "latches, does not say when",
         fmt::format("{}, {}", shown(0x60B8), shown(0x60D1)));
    if (latches && !times)
      warn(
          "probing: when the edge came is not known within the cycle, which adds to the "
          "uncertainty of a point");
  }

  void following_error() {
    if (const auto window = drive_.number(0x6065))
      fact("following_error", "following error window", fmt::format("{} units", *window),
           shown(0x6065));
  }

  void sync() {
    const bool counter = drive_.has(0x1019);
    fact("sync", "SYNC", counter ? "with or without counter" : "without counter", shown(0x1019));
    if (!counter)
      warn(
          "SYNC must come without counter (1019h = 0 in all devices): a second producer of SYNC is "
          "then not found by its counter");
    if (const auto window = drive_.number(0x1007); window.value_or(0) != 0)
      warn(fmt::format("targets later than {} us after SYNC are thrown away (1007h)", *window));
  }

  void watch() {
    const std::size_t entries = drive_.heartbeat_consumers();
    const bool guarding = drive_.has(0x100C) && drive_.has(0x100D);
    const std::string guarded = guarding ? ", node guarding" : "";
    fact("watch", "watches",
         entries == 0 ? "no heartbeat" + guarded
                      : fmt::format("{} heartbeat{}{}", entries, entries == 1 ? "" : "s", guarded),
         fmt::format("{}, {}", shown(0x6007), shown(0x1029, 1)));
    if (entries == 0) {
      miss(fmt::format("1016h is absent: it cannot watch node {}", options_.node));
    } else if (!watches_node()) {
      miss(fmt::format("1016h does not watch node {}", options_.node));
    }
    if (entries > 0 && !drive_.has(0x6007)) {
      warn("it has no 6007h: what it does when a heartbeat is lost is in its manual");
    } else if (drive_.number(0x6007) == std::uint64_t{0}) {
      miss("6007h = 0: it does nothing when a node it watches falls silent");
    }
  }

  [[nodiscard]] bool watches_node() const {
    return std::any_of(drive_.objects.begin(), drive_.objects.end(), [this](const auto& object) {
      const auto& [key, value] = object;
      const std::uint64_t entry = value.number.value_or(0);
      return key.first == 0x1016 && key.second > 0 && (entry & 0xFFFFU) != 0 &&
             entry >> 16U == options_.node;
    });
  }

  void limits() {
    const auto low = static_cast<std::int32_t>(drive_.number(0x607B, 1).value_or(0));
    const auto high = static_cast<std::int32_t>(drive_.number(0x607B, 2).value_or(0));
    const bool whole = (low == 0 && high == 0) || (low == INT32_MIN && high == INT32_MAX);
    const bool told = drive_.number(0x607B, 1).has_value();
    fact("range", "position range",
         !told   ? "none told"
         : whole ? "whole"
                 : fmt::format("{} to {}", low, high),
         shown(0x607B, 1));
    if (!whole)
      warn(
          "positions wrap at its own range (607Bh), which the node does not follow: keep the axis "
          "inside");
    if ((drive_.number(0x607E).value_or(0) & 0x80U) != 0)
      warn("607Eh turns positions round (bit 7): the direction of the axis is that of the drive");
  }

  void units() {
    DriveUnits units = units_of(drive_);
    if (options_.feed_mm) units.become_linear(*options_.feed_mm);
    fact("units", "units", describe(units), units.told_by);
    if (!units.unknown.empty()) {
      warn(fmt::format("units: {}", units.unknown));
      return;
    }
    if (!units.scale && !units.fits_units_per_turn())
      miss("its units fit neither 2030h : 2031h of the node, each at most 2^20, nor 2036h");
    if (const std::string sentence = coarseness(units); !sentence.empty()) warn(sentence);
    if (units.per_turn && !units.nm_per_unit && !units.survives_wrap())
      warn(fmt::format(
          "a turn is no part of 2^32 units: a rotary axis must stay within {:.0f} turns "
          "of its zero to either side",
          2147483648.0 / *units.per_turn));
  }

  const ForeignDrive& drive_;
  const DriveCheckOptions& options_;
  DriveCheck check_;
  std::optional<bool> csp_;
  std::optional<bool> to_drive_;    // 60B0h in an RPDO
  std::optional<bool> from_drive_;  // in a TPDO
};

}  // namespace

const char* words_of(Way way) {
  switch (way) {
    case Way::offset:
      return "offset by 60B0h";
    case Way::forwarded_target:
      return "forwarded target";
    case Way::controller_adds:
      return "the controller adds";
    case Way::forwarded_frame:  // is not built, no check finds it
    case Way::none:
      return "none";
  }
  return "none";
}

DriveCheck check_drive(const ForeignDrive& drive, const DriveCheckOptions& options) {
  return Checker(drive, options).check();
}

}  // namespace volcomp::host
