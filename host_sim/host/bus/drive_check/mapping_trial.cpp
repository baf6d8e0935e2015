#include "host_sim/host/bus/drive_check/mapping_trial.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using canopen::AbortCode;
using canopen::PdoKind;

// How much a trial takes from a drive that is started meanwhile; nothing: too much.
std::optional<int> price_of(const ForeignPdo& pdo, const std::set<std::uint16_t>& heard) {
  if (!pdo.valid()) return 0;
  if (pdo.mapping.empty()) return 1;
  if (pdo.number > 1 && heard.count(pdo.id()) == 0) return 2;
  return std::nullopt;
}

ForeignPdo cheapest(const std::vector<ForeignPdo>& pdos, const std::set<std::uint16_t>& heard,
                    const std::string& refusal) {
  const ForeignPdo* best = nullptr;
  for (const ForeignPdo& pdo : pdos) {
    const auto price = price_of(pdo, heard);
    if (price && (best == nullptr || *price <= *price_of(*best, heard))) best = &pdo;
  }
  if (best == nullptr) throw UserError(refusal);
  return *best;
}

// The drive says what it is able to, not that something is wrong (CiA 301, table 22).
bool is_answer(AbortCode code) {
  return code == AbortCode::not_mappable || code == AbortCode::mapping_too_long ||
         code == AbortCode::read_only || code == AbortCode::invalid_value ||
         code == AbortCode::no_object || code == AbortCode::no_subindex;
}

std::vector<MappingAnswer> questions(const ForeignDrive& drive) {
  std::vector<MappingAnswer> all;
  const auto ask = [&all](PdoKind kind, Mapping entries) {
    all.push_back({kind, std::move(entries)});
  };
  const bool offset = drive.has(canopen::object_of(kOffsetEntry).index);
  if (offset) ask(PdoKind::receive, {kOffsetEntry});
  ask(PdoKind::receive, control_alone());
  ask(PdoKind::receive, control_and_four_bytes());
  ask(PdoKind::receive, control_and_single_bytes());
  ask(PdoKind::receive, {kTargetEntry});
  if (offset) ask(PdoKind::transmit, {kOffsetEntry});
  ask(PdoKind::transmit, {kModeEntry});
  return all;
}

// One PDO of the trial.
class Trial {
 public:
  Trial(DriveChanges& changes, PdoKind kind, const ForeignPdo& pdo)
      : changes_(changes),
        kind_(kind),
        pdo_(pdo),
        communication_(communication_of(kind, pdo.number)),
        mapping_(mapping_of(kind, pdo.number)) {}

  void begin() {
    changes_.keep(kind_, pdo_);
    changes_.write({communication_, 1}, pdo_.cob_id | canopen::kPdoInvalid, 4);
  }

  AbortCode map(const Mapping& entries) {
    return answer([&] {
      changes_.write({mapping_, 0}, 0, 1);
      for (std::size_t i = 0; i < entries.size(); ++i)
        changes_.write(entry(i), entries[i], 4);
      changes_.write({mapping_, 0}, static_cast<std::uint32_t>(entries.size()), 1);
      return holds(entries);
    });
  }

  AbortCode come_at_sync() {
    const canopen::ObjectId type{communication_, 2};
    return answer([&] {
      changes_.write(type, kEverySync, 1);
      return changes_.read(type) == kEverySync;
    });
  }

 private:
  template <class Question>
  static AbortCode answer(const Question& question) {
    try {
      return question() ? AbortCode::none : AbortCode::cannot_store;
    } catch (const NodeRefused& refused) {
      if (!is_answer(refused.code)) throw;
      return refused.code;
    }
  }

  [[nodiscard]] canopen::ObjectId entry(std::size_t i) const {
    return {mapping_, static_cast<std::uint8_t>(i + 1)};
  }

  bool holds(const Mapping& entries) {
    if (changes_.read({mapping_, 0}) != entries.size()) return false;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (changes_.read(entry(i)) != entries[i]) return false;
    }
    return true;
  }

  DriveChanges& changes_;
  PdoKind kind_;
  const ForeignPdo& pdo_;
  std::uint16_t communication_;
  std::uint16_t mapping_;
};

}  // namespace

TrialPdos pdos_for_trial(const ForeignDrive& drive, const std::set<std::uint16_t>& heard) {
  const auto refusal = [&drive](const char* kind) {
    return fmt::format("node {} has no {} that is free for a trial", drive.node, kind);
  };
  return {cheapest(drive.receive, heard, refusal("RPDO")),
          cheapest(drive.transmit, heard, refusal("TPDO"))};
}

TriedMappings try_mappings(DriveChanges& changes, const ForeignDrive& drive,
                           const TrialPdos& pdos) {
  TriedMappings tried;
  tried.rpdo = pdos.receive.number;
  tried.tpdo = pdos.transmit.number;
  tried.answers = questions(drive);
  const Restored restored = changes.run_and_restore([&] {
    Trial receive(changes, PdoKind::receive, pdos.receive);
    Trial transmit(changes, PdoKind::transmit, pdos.transmit);
    receive.begin();
    transmit.begin();
    tried.rpdo_at_sync = receive.come_at_sync() == AbortCode::none;
    tried.tpdo_at_sync = transmit.come_at_sync() == AbortCode::none;
    for (MappingAnswer& one : tried.answers)
      one.why = (one.kind == PdoKind::receive ? receive : transmit).map(one.entries);
  });
  tried.notes = restored.notes;
  return tried;
}

}  // namespace volcomp::host
