#include "host_sim/host/bus/drive_check/drive_restore.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "firmware/canopen/pdo.hpp"
#include "host_sim/host/bus/drive_check/drive_ready.hpp"

namespace volcomp::host {
namespace {

using canopen::ObjectId;
using canopen::PdoTable;
using Bytes = SdoChannel::Bytes;

constexpr std::uint16_t kMappingBit = 0x0200;  // between 14xxh and 16xxh, 18xxh and 1Axxh
constexpr std::size_t kMostBytes = 8;

// Objects that are put back together: those of one PDO, or one other object.
struct Unit {
  std::uint16_t index = 0;  // 14xxh or 18xxh of a PDO
  bool pdo = false;
  std::vector<KeptObject> objects;

  [[nodiscard]] const KeptObject* find(ObjectId object) const {
    const auto found = std::find_if(objects.begin(), objects.end(),
                                    [object](const KeptObject& k) { return k.object == object; });
    return found == objects.end() ? nullptr : &*found;
  }
  [[nodiscard]] ObjectId cob_id() const { return {index, 1}; }
  [[nodiscard]] ObjectId count() const {
    return {static_cast<std::uint16_t>(index | kMappingBit), 0};
  }
  [[nodiscard]] bool is_entry(ObjectId object) const {
    return pdo && object.index == count().index && object.sub > 0;
  }
  // Its count as it was does not reach so far: nothing depends on such an entry.
  [[nodiscard]] bool is_unused(ObjectId object) const {
    const KeptObject* const kept = find(count());
    return is_entry(object) && kept != nullptr && number(kept->before) < object.sub;
  }
};

// The last one changed comes first.
std::vector<Unit> units_of(const std::vector<KeptObject>& objects) {
  std::vector<Unit> units;
  for (const KeptObject& kept : objects) {
    const bool pdo = PdoTable::owns(kept.object.index);
    const auto index = static_cast<std::uint16_t>(pdo ? kept.object.index & ~unsigned{kMappingBit}
                                                      : kept.object.index);
    auto found = std::find_if(units.begin(), units.end(),
                              [index](const Unit& unit) { return unit.index == index; });
    if (found == units.end()) found = units.insert(units.end(), {index, pdo, {}});
    found->objects.push_back(kept);
  }
  std::reverse(units.begin(), units.end());
  return units;
}

Bytes made_invalid(Bytes cob_id) {
  if (!cob_id.empty()) cob_id.back() |= 0x80U;
  return cob_id;
}

bool is_valid(const Bytes& cob_id) { return !cob_id.empty() && (cob_id.back() & 0x80U) == 0; }

void add_writes(const Unit& unit, std::vector<SdoWrite>& writes) {
  const KeptObject* const cob_id = unit.pdo ? unit.find(unit.cob_id()) : nullptr;
  const KeptObject* const count = unit.pdo ? unit.find(unit.count()) : nullptr;
  if (cob_id != nullptr) writes.push_back({cob_id->object, made_invalid(cob_id->before)});
  if (count != nullptr) writes.push_back({count->object, Bytes(count->before.size(), 0)});
  for (const KeptObject& kept : unit.objects) {
    if (unit.is_entry(kept.object)) writes.push_back({kept.object, kept.before});
  }
  if (count != nullptr) writes.push_back({count->object, count->before});
  for (auto kept = unit.objects.rbegin(); kept != unit.objects.rend(); ++kept) {
    if (&*kept != cob_id && &*kept != count && !unit.is_entry(kept->object))
      writes.push_back({kept->object, kept->before});
  }
  if (cob_id != nullptr) writes.push_back({cob_id->object, cob_id->before});
}

class Restorer {
 public:
  explicit Restorer(NodeClient& client) : client_(client) {}

  Restored restore(const std::vector<KeptObject>& objects) {
    const std::vector<Unit> units = units_of(objects);
    for (const Unit& unit : units)
      attempt(unit);
    if (!open_.empty())
      throw NotRestored(fmt::format("node {} is not as it was found: {}", client_.node_id(), why_),
                        std::move(open_));
    return std::move(restored_);
  }

 private:
  // One that fails does not keep the others from being put back.
  void attempt(const Unit& unit) {
    try {
      if (put_back(unit)) return;
    } catch (const std::runtime_error& failed) {  // refused, or no answer
      if (why_.empty()) why_ = failed.what();
    }
    add_writes(unit, open_);
  }

  [[nodiscard]] Bytes read(ObjectId object) {
    return client_.read(object, kMostBytes, object_name(object));
  }

  bool put_back(const Unit& unit) {
    std::vector<Bytes> now;
    for (const KeptObject& kept : unit.objects)
      now.push_back(read(kept.object));
    if (is_as_it_was(unit, now)) return true;
    if (!is_ours(unit, now)) {
      restored_.notes.push_back(
          fmt::format("{} has been written by somebody else since: left as it is",
                      object_name({unit.index, 0})));
      return true;
    }
    std::vector<SdoWrite> writes = invalidation(unit, now);
    add_writes(unit, writes);
    for (const SdoWrite& one : writes)
      write(unit, one);
    return compare(unit);
  }

  // The identifier may change only while a PDO is invalid: bit 31 comes alone.
  static std::vector<SdoWrite> invalidation(const Unit& unit, const std::vector<Bytes>& now) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const ObjectId object = unit.objects[i].object;
      if (unit.pdo && object == unit.cob_id() && is_valid(now[i]))
        return {{object, made_invalid(now[i])}};
    }
    return {};
  }

  static bool is_as_it_was(const Unit& unit, const std::vector<Bytes>& now) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i] != unit.objects[i].before) return false;
    }
    return true;
  }

  // Every value is the old one or one of this tool, which may have been restoring already. It
  // leaves no PDO valid by its old COB-ID whose objects are not as they were: such a one has been
  // set up by somebody.
  static bool is_ours(const Unit& unit, const std::vector<Bytes>& now) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const KeptObject& kept = unit.objects[i];
      const bool written =
          std::find(kept.written.begin(), kept.written.end(), now[i]) != kept.written.end();
      if (!written && now[i] != kept.before && !is_passing(unit, kept, now[i])) return false;
      if (unit.pdo && kept.object == unit.cob_id() && is_valid(now[i]) && !written) return false;
    }
    return true;
  }

  // Values on the way back: invalid, count 0. Some drives clear the entries with the count.
  static bool is_passing(const Unit& unit, const KeptObject& kept, const Bytes& now) {
    if (!unit.pdo) return false;
    if (kept.object == unit.cob_id()) return now == made_invalid(kept.before);
    return (kept.object == unit.count() || unit.is_entry(kept.object)) && number(now) == 0;
  }

  void write(const Unit& unit, const SdoWrite& one) {
    try {
      client_.write(one.object, one.value, object_name(one.object));
      ++restored_.objects;
    } catch (const NodeRefused&) {
      if (!unit.is_unused(one.object)) throw;
    }
  }

  bool compare(const Unit& unit) {
    return std::all_of(unit.objects.begin(), unit.objects.end(),
                       [&](const KeptObject& kept) { return is_back(unit, kept); });
  }

  bool is_back(const Unit& unit, const KeptObject& kept) {
    if (read(kept.object) == kept.before) return true;
    if (!unit.is_unused(kept.object)) {
      if (why_.empty()) why_ = object_name(kept.object) + " does not hold what was written";
      return false;
    }
    restored_.notes.push_back(fmt::format(
        "{} lies beyond the count of its PDO and does not take its old value: nothing uses it",
        object_name(kept.object)));
    return true;
  }

  NodeClient& client_;
  Restored restored_;
  std::vector<SdoWrite> open_;
  std::string why_;
};

}  // namespace

std::string object_name(ObjectId object) {
  return fmt::format("{:04X}h:{:02X}", object.index, object.sub);
}

std::string describe(const SdoWrite& write) {
  std::string digits;
  for (auto byte = write.value.rbegin(); byte != write.value.rend(); ++byte)
    digits += fmt::format("{:02X}", *byte);
  return fmt::format("{} = {}h", object_name(write.object), digits);
}

std::vector<SdoWrite> restoring_writes(const std::vector<KeptObject>& objects) {
  std::vector<SdoWrite> writes;
  for (const Unit& unit : units_of(objects))
    add_writes(unit, writes);
  return writes;
}

Restored restore(NodeClient& client, const std::vector<KeptObject>& objects) {
  return Restorer(client).restore(objects);
}

Restored restore(NodeClient& client, DriveJournal& journal) {
  const auto refuse = [&](const std::string& why) {
    throw NotRestored(fmt::format("node {} is not as it was found: {}", client.node_id(), why),
                      restoring_writes(journal.objects()));
  };
  try {
    if (read_identity(client) != journal.owner().identity)
      refuse(fmt::format("another drive answers now (1018h); {} belongs to the one that was there",
                         journal.path().string()));
    if (is_enabled(client)) refuse("its power stage is on: disable it first");
  } catch (const NotRestored&) {
    throw;
  } catch (const std::runtime_error& failed) {
    refuse(failed.what());
  }
  Restored restored = restore(client, journal.objects());
  journal.remove();
  return restored;
}

}  // namespace volcomp::host
