#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using canopen::AbortCode;
using canopen::ObjectId;
using canopen::PdoKind;
using canopen::PdoTable;

constexpr std::size_t kMostPdos = 8;
constexpr std::size_t kMostText = 64;

// CiA 301 and CiA 402-2; texts first.
constexpr std::array kTexts{ObjectId{0x1008, 0}, ObjectId{0x1009, 0}, ObjectId{0x100A, 0}};
constexpr ObjectId kDeviceType{0x1000, 0};
constexpr std::array kNumbers{
    ObjectId{0x1005, 0}, ObjectId{0x1006, 0}, ObjectId{0x1007, 0}, ObjectId{0x100C, 0},
    ObjectId{0x100D, 0}, ObjectId{0x1017, 0}, ObjectId{0x1018, 1}, ObjectId{0x1018, 2},
    ObjectId{0x1018, 3}, ObjectId{0x1018, 4}, ObjectId{0x1019, 0}, ObjectId{0x1029, 1},
    ObjectId{0x6007, 0}, ObjectId{0x6041, 0}, ObjectId{0x605A, 0}, ObjectId{0x605E, 0},
    ObjectId{0x6061, 0}, ObjectId{0x6062, 0}, ObjectId{0x6063, 0}, ObjectId{0x6064, 0},
    ObjectId{0x6065, 0}, ObjectId{0x6066, 0}, ObjectId{0x607A, 0}, ObjectId{0x607B, 1},
    ObjectId{0x607B, 2}, ObjectId{0x607D, 1}, ObjectId{0x607D, 2}, ObjectId{0x607E, 0},
    ObjectId{0x607F, 0}, ObjectId{0x6085, 0}, ObjectId{0x608F, 1}, ObjectId{0x608F, 2},
    ObjectId{0x6091, 1}, ObjectId{0x6091, 2}, ObjectId{0x6092, 1}, ObjectId{0x6092, 2},
    ObjectId{0x60A8, 0}, ObjectId{0x60B0, 0}, ObjectId{0x60B1, 0}, ObjectId{0x60B2, 0},
    ObjectId{0x60B8, 0}, ObjectId{0x60B9, 0}, ObjectId{0x60BA, 0}, ObjectId{0x60BB, 0},
    ObjectId{0x60C2, 1}, ObjectId{0x60C2, 2}, ObjectId{0x60D0, 1}, ObjectId{0x60D1, 0},
    ObjectId{0x60D5, 0}, ObjectId{0x60F4, 0}, ObjectId{0x6502, 0}};
constexpr std::uint8_t kMostConsumers = 127;
constexpr std::uint8_t kConsumersRead = 8;
// Upper bound: each PDO has a COB-ID, a type, a count and up to eight entries.
constexpr std::size_t kMostReads =
    kTexts.size() + kNumbers.size() + kConsumersRead + 2 + 2 * kMostPdos * 11;

// An answer of the drive that the object is not there.
bool says_absent(AbortCode code) {
  return code == AbortCode::no_object || code == AbortCode::no_subindex;
}

class Reader {
 public:
  Reader(NodeClient& client, const ReadProgress& progress) : client_(client), progress_(progress) {}

  // Nothing: not there.
  std::optional<ForeignValue> value(ObjectId object, std::size_t most) {
    if (progress_) progress_(done_++, kMostReads);
    try {
      const auto bytes = client_.read(object, most, "drive");
      ForeignValue value{{}, bytes.size(), {bytes.begin(), bytes.end()}};
      if (bytes.size() <= 8) value.number = volcomp::host::number(bytes);
      return value;
    } catch (const NodeRefused& refused) {
      if (says_absent(refused.code)) return std::nullopt;
      return ForeignValue{};  // write only, or not in this state
    }
  }
  std::optional<std::uint64_t> number(std::uint16_t index, std::size_t sub) {
    const auto read = value({index, static_cast<std::uint8_t>(sub)}, 8);
    return read ? read->number : std::nullopt;
  }

 private:
  NodeClient& client_;
  const ReadProgress& progress_;
  std::size_t done_ = 0;
};

std::vector<ForeignPdo> read_pdos(Reader& reader, std::uint16_t communication,
                                  std::uint16_t mapping) {
  std::vector<ForeignPdo> pdos;
  for (std::size_t n = 0; n < kMostPdos; ++n) {
    const auto cob_id = reader.number(static_cast<std::uint16_t>(communication + n), 1);
    if (!cob_id) break;
    ForeignPdo& pdo = pdos.emplace_back();
    pdo.number = n + 1;
    pdo.cob_id = static_cast<std::uint32_t>(*cob_id);
    const auto type = reader.number(static_cast<std::uint16_t>(communication + n), 2);
    pdo.type = static_cast<std::uint8_t>(type.value_or(canopen::kEventType));
    const auto mapped = static_cast<std::uint16_t>(mapping + n);
    const std::size_t count = std::min<std::uint64_t>(reader.number(mapped, 0).value_or(0), 8);
    for (std::size_t sub = 1; sub <= count; ++sub)
      pdo.mapping.push_back(static_cast<std::uint32_t>(reader.number(mapped, sub).value_or(0)));
  }
  return pdos;
}

void read_consumers(Reader& reader, ForeignDrive& drive) {
  const auto count = reader.number(0x1016, 0);
  if (!count) return;
  const auto entries = static_cast<std::uint8_t>(std::min<std::uint64_t>(*count, kMostConsumers));
  for (std::uint8_t sub = 1; sub <= entries; ++sub) {
    ForeignValue& value = drive.objects[{0x1016, sub}];
    if (sub <= kConsumersRead) value.number = reader.number(0x1016, sub);
  }
}

// Negative values as their bytes: what the drive would answer.
std::optional<std::uint64_t> as_sent(std::optional<std::uint64_t> number, std::size_t bytes) {
  if (number && bytes < 8) *number &= (std::uint64_t{1} << (8 * bytes)) - 1U;
  return number;
}

std::vector<ForeignPdo> pdos_of(const std::vector<canopen::PdoParameters>& parameters) {
  std::vector<ForeignPdo> pdos;
  pdos.reserve(parameters.size());
  for (const canopen::PdoParameters& p : parameters)
    pdos.push_back(
        {pdos.size() + 1, p.cob_id, p.type, {p.mapping.begin(), p.mapping.begin() + p.count}});
  return pdos;
}

}  // namespace

bool ForeignPdo::maps(std::uint16_t index) const {
  return std::any_of(mapping.begin(), mapping.end(), [index](std::uint32_t entry) {
    return canopen::object_of(entry).index == index;
  });
}

// Some EDS leave 1000h to the drive: then its statusword tells what it is.
bool ForeignDrive::is_cia402() const {
  const auto type = number(0x1000);
  return type ? host::is_cia402(*type) : has(0x6041);
}

bool ForeignDrive::has(std::uint16_t index, std::uint8_t sub) const {
  return objects.count({index, sub}) != 0;
}

std::optional<std::uint64_t> ForeignDrive::number(std::uint16_t index, std::uint8_t sub) const {
  const auto found = objects.find({index, sub});
  return found == objects.end() ? std::nullopt : found->second.number;
}

std::string ForeignDrive::text(std::uint16_t index) const {
  const auto found = objects.find({index, 0});
  const std::string text = found == objects.end() ? std::string() : found->second.text;
  return text.substr(0, text.find('\0'));
}

std::optional<bool> ForeignDrive::may_map(PdoKind kind, std::uint16_t index) const {
  const std::vector<ForeignPdo>& pdos = kind == PdoKind::receive ? receive : transmit;
  if (std::any_of(pdos.begin(), pdos.end(), [index](const ForeignPdo& p) { return p.maps(index); }))
    return true;
  const auto found = objects.find({index, 0});
  const std::size_t bytes = found == objects.end() ? 0 : found->second.bytes;
  if (tried && bytes > 0 && bytes <= 4)
    return tried->took(kind, {canopen::mapped(index, 0, static_cast<std::uint8_t>(8 * bytes))});
  return rules ? std::optional(rules->may_map(kind, {index, 0})) : std::nullopt;
}

std::optional<bool> ForeignDrive::may_map(PdoKind kind, const Mapping& entries) const {
  if (tried) return tried->took(kind, entries);
  if (entries.size() == 1) return may_map(kind, canopen::object_of(entries.front()).index);
  if (!rules) return std::nullopt;
  return std::all_of(entries.begin(), entries.end(), [&](std::uint32_t entry) {
    return rules->may_map(kind, canopen::object_of(entry));
  });
}

std::optional<bool> ForeignDrive::may_come_at_sync(PdoKind kind) const {
  const bool received = kind == PdoKind::receive;
  if (tried) return received ? tried->rpdo_at_sync : tried->tpdo_at_sync;
  if (!rules) return std::nullopt;
  // By its second PDO: the first may be fixed.
  const std::uint16_t first =
      received ? PdoTable::kReceiveCommunication : PdoTable::kTransmitCommunication;
  const EdsFileObject* const type = rules->find({static_cast<std::uint16_t>(first + 1), 2});
  return type != nullptr && type->access == canopen::Access::read_write;
}

std::string mapping_text(const Mapping& entries) {
  std::vector<std::string> objects;
  for (const std::uint32_t entry : entries)
    objects.push_back(fmt::format("{:04X}h", canopen::object_of(entry).index));
  return objects.empty() ? "nothing" : fmt::format("{}", fmt::join(objects, ", "));
}

std::size_t ForeignDrive::heartbeat_consumers() const {
  return static_cast<std::size_t>(std::count_if(objects.begin(), objects.end(), [](const auto& o) {
    return o.first.first == 0x1016 && o.first.second > 0;
  }));
}

ForeignDrive read_drive(NodeClient& client, const ReadProgress& progress) {
  ForeignDrive drive;
  drive.node = client.node_id();
  Reader reader(client, progress);
  const auto take = [&](ObjectId object, std::size_t most) {
    if (auto value = reader.value(object, most))
      drive.objects[{object.index, object.sub}] = std::move(*value);
  };
  for (const ObjectId object : kTexts)
    take(object, kMostText);
  take(kDeviceType, 8);
  if (!drive.is_cia402()) return drive;
  for (const ObjectId object : kNumbers)
    take(object, 8);
  read_consumers(reader, drive);
  drive.receive = read_pdos(reader, PdoTable::kReceiveCommunication, PdoTable::kReceiveMapping);
  drive.transmit = read_pdos(reader, PdoTable::kTransmitCommunication, PdoTable::kTransmitMapping);
  return drive;
}

ForeignDrive read_drive(EdsFile eds, std::uint8_t node_id) {
  ForeignDrive drive;
  drive.node = node_id;
  for (const auto& [key, object] : eds.objects()) {
    if (PdoTable::owns(key.first)) continue;
    const auto type = static_cast<canopen::DataType>(object.type);
    ForeignValue value;
    value.bytes = canopen::size_of(type);
    if (type == canopen::DataType::visible_string) value.text = object.value;
    if (value.bytes > 0)
      value.number = as_sent(eds.number({key.first, key.second}, node_id), value.bytes);
    drive.objects[key] = std::move(value);
  }
  drive.receive = pdos_of(eds.pdos(canopen::PdoKind::receive, node_id));
  drive.transmit = pdos_of(eds.pdos(canopen::PdoKind::transmit, node_id));
  drive.rules = std::move(eds);
  return drive;
}

}  // namespace volcomp::host
