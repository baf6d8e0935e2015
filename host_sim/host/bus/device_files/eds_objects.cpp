#include "host_sim/host/bus/device_files/eds_objects.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "firmware/node/node.hpp"

namespace volcomp::host {
namespace {

using canopen::Access;
using canopen::DataType;
using canopen::NamedEntry;
using canopen::ObjectId;
using canopen::PdoTable;

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kErrorField = canopen::object::error_history.index;
constexpr std::uint16_t kSdoServer = canopen::object::sdo_cob_id.index;
constexpr std::uint16_t kIdentity = canopen::object::vendor_id.index;

// --- names

// Titles of objects whose values have names of their own; standard objects as in CiA 301.
std::string_view title(std::uint16_t index) {
  static const std::map<std::uint16_t, std::string_view> titles{
#define TITLE(index, text) {index, text},
#include "firmware/canopen/communication.def"
#define TITLE(index, text) {index, text},
#include "firmware/node/objects.def"
  };
  const auto found = titles.find(index);
  return found == titles.end() ? std::string_view{} : found->second;
}

// Many readers of INI files take a semicolon for the beginning of a comment.
std::string without_semicolon(std::string text) {
  std::replace(text.begin(), text.end(), ';', ',');
  return text;
}

std::string value_name(const NamedEntry& row, std::uint8_t sub) {
  std::string name = without_semicolon(row.name);
  if (row.index == kSdoServer)
    return sub == 1 ? "COB-ID client to server (rx)" : "COB-ID server to client (tx)";
  if (row.first_sub == row.last_sub) return name;
  if (row.index < 0x2000) return fmt::format("{} {}", name, sub);
  if (row.last_sub == kStatusBits) return fmt::format("{} (bit {})", name, sub - 1);
  const bool axes = row.first_sub == 1 && row.last_sub == node::kNodeAxes;
  return axes ? fmt::format("{} (axis {})", name, sub)
              : fmt::format("{} {}", name, sub - row.first_sub + 1);
}

// --- values

// Two nodes that differ in nothing but the node id: what differs between their values is made
// from it.
class Twins {
 public:
  Twins() {
    first_->power_on(0);
    second_->power_on(0);
  }

  [[nodiscard]] const node::Node& node() const { return *first_; }
  [[nodiscard]] std::optional<std::string> text(ObjectId object, DataType type) const;

 private:
  static constexpr std::uint8_t kFirst = 1;
  static constexpr std::uint8_t kSecond = 2;
  [[nodiscard]] static Bytes bytes(const node::Node& node, ObjectId object);

  std::unique_ptr<node::Node> first_ = std::make_unique<node::Node>(kFirst, nullptr);
  std::unique_ptr<node::Node> second_ = std::make_unique<node::Node>(kSecond, nullptr);
};

Bytes Twins::bytes(const node::Node& node, ObjectId object) {
  if (PdoTable::owns(object.index)) {
    PdoTable::Value value;
    static_cast<void>(node.device().pdos().read(object, value));
    Bytes all(value.bytes);
    store_le(all.data(), all.size(), value.value);
    return all;
  }
  const canopen::ObjectDictionary::Found found = node.device().objects().find(object);
  if (found.entry == nullptr) return {found.highest_sub};
  if (found.value == nullptr) return {};
  return {found.value, found.value + canopen::ObjectDictionary::size(*found.entry, found.value)};
}

std::optional<std::string> Twins::text(ObjectId object, DataType type) const {
  if (object.index == kErrorField && object.sub > 0) return std::nullopt;
  const Bytes mine = bytes(*first_, object);
  if (type == DataType::visible_string) return std::string(mine.begin(), mine.end());
  const std::size_t size = mine.size();
  if (size == 0) return std::nullopt;  // a domain
  if (canopen::is_signed(type)) return fmt::format("{}", load_le_signed(mine.data(), size));
  const std::uint64_t value = load_le(mine.data(), size);
  if (type == DataType::real32) return fmt::format("{}", load_f32(mine.data()));
  if (type == DataType::real64) return fmt::format("{}", bit_cast<double>(value));
  if (mine != bytes(*second_, object)) return fmt::format("$NODEID+0x{:X}", value - kFirst);
  const bool identifier = object.index < 0x2000 && type == DataType::unsigned32;
  return identifier ? fmt::format("0x{:08X}", value) : fmt::format("{}", value);
}

// --- objects of the dictionary

std::string access_text(const NamedEntry& row) {
  if (row.access == Access::constant) return "const";
  if (row.access == Access::read_only) return "ro";
  if (row.access == Access::write_only) return "wo";
  if (row.has(canopen::kReceive) == row.has(canopen::kTransmit)) return "rw";
  return row.has(canopen::kReceive) ? "rww" : "rwr";
}

EdsValue make_value(const Twins& twins, const NamedEntry& row, std::uint8_t sub) {
  EdsValue v;
  v.sub = sub;
  v.name = value_name(row, sub);
  v.type = row.type;
  v.access = access_text(row);
  v.mappable = row.has(canopen::kReceive) || row.has(canopen::kTransmit);
  if (row.writable() && row.limited()) {
    v.low = row.low;
    v.high = row.high;
  }
  v.value = twins.text({row.index, sub}, row.type);
  return v;
}

EdsValue make_count(const Twins& twins, std::uint16_t index) {
  EdsValue v;
  v.name = "Highest sub-index supported";
  v.access = "const";
  v.value = twins.text({index, 0}, v.type);
  return v;
}

// Identity (23h) and SDO parameter (22h) are records though their values have one type.
ObjectCode code_of(const EdsObject& object) {
  if (object.index == kIdentity || object.index == kSdoServer) return ObjectCode::record;
  const auto& v = object.values;
  const bool alike =
      std::all_of(v.begin() + 1, v.end(), [&v](const EdsValue& x) { return x.type == v[1].type; });
  return alike ? ObjectCode::array : ObjectCode::record;
}

EdsObject make_object(const Twins& twins, const NamedEntry* first, const NamedEntry* last) {
  EdsObject object;
  object.index = first->index;
  object.name = title(object.index);
  if (object.name.empty()) object.name = without_semicolon(first->name);
  if (first->first_sub > 0) object.values.push_back(make_count(twins, object.index));
  for (const NamedEntry* row = first; row != last; ++row) {
    for (unsigned sub = row->first_sub; sub <= row->last_sub; ++sub)
      object.values.push_back(make_value(twins, *row, static_cast<std::uint8_t>(sub)));
  }
  if (object.values.size() > 1) object.code = code_of(object);
  return object;
}

void add_dictionary(const Twins& twins, std::vector<EdsObject>& objects) {
  const Span<const NamedEntry> rows = node::named_node_dictionary();
  for (const NamedEntry* first = rows.begin(); first != rows.end();) {
    const NamedEntry* const last = std::find_if(
        first, rows.end(), [first](const NamedEntry& row) { return row.index != first->index; });
    objects.push_back(make_object(twins, first, last));
    first = last;
  }
}

// --- PDO parameters

DataType unsigned_of(std::uint8_t bytes) {
  if (bytes == 1) return DataType::unsigned8;
  return bytes == 2 ? DataType::unsigned16 : DataType::unsigned32;
}

std::string communication_name(std::uint8_t sub) {
  constexpr std::array<const char*, 6> names{"Highest sub-index supported", "COB-ID used by PDO",
                                             "Transmission type",           "Inhibit time, 100 us",
                                             "Compatibility entry",         "Event timer, ms"};
  return names.at(sub);
}

std::string mapping_name(std::uint8_t sub) {
  return sub == 0 ? "Number of mapped objects" : fmt::format("Mapped object {}", sub);
}

EdsObject make_pdo_object(const Twins& twins, std::uint16_t index, bool mapping,
                          const std::string& name) {
  const PdoTable& pdos = twins.node().device().pdos();
  EdsObject object;
  object.index = index;
  object.name = name;
  object.code = ObjectCode::record;
  for (std::uint8_t sub = 0; sub <= canopen::kMostMapped; ++sub) {
    PdoTable::Value value;
    if (pdos.read({index, sub}, value) != canopen::AbortCode::none) continue;
    std::uint8_t bytes = 0;
    EdsValue v;
    v.sub = sub;
    v.name = mapping ? mapping_name(sub) : communication_name(sub);
    v.type = unsigned_of(value.bytes);
    v.access = pdos.writable({index, sub}, bytes) == canopen::AbortCode::none ? "rw" : "const";
    v.value = twins.text({index, sub}, v.type);
    object.values.push_back(v);
  }
  return object;
}

void add_pdos(const Twins& twins, std::vector<EdsObject>& objects) {
  const auto add = [&](std::uint16_t first, std::size_t count, bool mapping, const char* name) {
    for (std::size_t i = 0; i < count; ++i) {
      objects.push_back(make_pdo_object(twins, static_cast<std::uint16_t>(first + i), mapping,
                                        fmt::format("{} {}", name, i + 1)));
    }
  };
  add(PdoTable::kReceiveCommunication, node::kReceivePdos, false, "RPDO communication parameter");
  add(PdoTable::kReceiveMapping, node::kReceivePdos, true, "RPDO mapping parameter");
  add(PdoTable::kTransmitCommunication, node::kTransmitPdos, false, "TPDO communication parameter");
  add(PdoTable::kTransmitMapping, node::kTransmitPdos, true, "TPDO mapping parameter");
}

}  // namespace

std::vector<EdsObject> node_eds_objects() {
  const Twins twins;
  std::vector<EdsObject> objects;
  add_dictionary(twins, objects);
  add_pdos(twins, objects);
  std::sort(objects.begin(), objects.end(),
            [](const EdsObject& a, const EdsObject& b) { return a.index < b.index; });
  return objects;
}

}  // namespace volcomp::host
