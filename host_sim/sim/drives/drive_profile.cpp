#include "host_sim/sim/drives/drive_profile.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::sim {
namespace {

using canopen::DataType;
using canopen::Entry;
using canopen::PdoTable;

constexpr std::uint16_t kFirstOfApplication = 0x2000;

constexpr std::array<std::uint16_t, 3> kOfEveryDrive{0x1000, 0x6040, 0x6041};
// What the axis of the simulation determines, not the type of its drive.
constexpr std::array<std::uint16_t, 9> kOfTheAxis{0x6062, 0x6064, 0x6065, 0x607A, 0x607C,
                                                  0x607D, 0x6085, 0x60C2, 0x60F4};
// The node id is added by the device itself.
constexpr std::array<std::uint16_t, 2> kOfTheNodeId{0x1014, 0x1200};

template <std::size_t N>
bool among(const std::array<std::uint16_t, N>& all, std::uint16_t index) {
  return std::find(all.begin(), all.end(), index) != all.end();
}

canopen::ObjectId id_of(const Entry& row) { return {row.index, row.first_sub}; }

// The row of one sub-index of the complete drive, or nullptr.
const Entry* complete_row(const host::EdsFile::Key& key) {
  static const canopen::Dictionary complete = host::cia402_dictionary();
  const auto* const found =
      std::find_if(complete.rows.begin(), complete.rows.end(), [&key](const Entry& row) {
        return row.index == key.first && key.second >= row.first_sub && key.second <= row.last_sub;
      });
  return found == complete.rows.end() ? nullptr : found;
}

// The same value, alone in its row.
Entry alone(const Entry& row, std::uint8_t sub) {
  Entry one = row;
  one.first_sub = one.last_sub = sub;
  one.offset = (row.offset + row.size() * (sub - row.first_sub)) & 0x1FFFU;
  return one;
}

}  // namespace

DriveProfile::DriveProfile(host::EdsFile eds) : eds_(std::move(eds)) {
  for (const std::uint16_t needed : kOfEveryDrive) {
    if (eds_.find({needed, 0}) == nullptr)
      throw host::UserError(
          fmt::format("{}: describes no drive, {:04X}h is missing", eds_.file(), needed));
  }
  for (const auto& [key, object] : eds_.objects()) {
    if (!PdoTable::owns(key.first)) add_row(key, object);
  }
}

std::vector<canopen::PdoParameters> DriveProfile::pdos(canopen::PdoKind kind,
                                                       std::uint8_t node_id) const {
  std::vector<canopen::PdoParameters> pdos = eds_.pdos(kind, node_id);
  for (canopen::PdoParameters& pdo : pdos) {
    if (kind == canopen::PdoKind::transmit) pdo.cob_id |= canopen::kPdoNoRtr;
  }
  return pdos;
}

// A value of the simulated drive where it has one of that type, else one that nothing acts on.
void DriveProfile::add_row(const host::EdsFile::Key& key, const host::EdsFileObject& object) {
  const auto type = static_cast<DataType>(object.type);
  const bool text = type == DataType::visible_string;
  const std::size_t size =
      text ? std::max<std::size_t>(object.value.size(), 1) : canopen::size_of(type);
  const Entry* const known = complete_row(key);
  Entry row{};
  if (known != nullptr && known->type() == type) {
    row = alone(*known, key.second);
  } else if (size > 0 && size <= UINT8_MAX && foreign_ + size <= host::kForeignBytes) {
    row.index = key.first;
    row.first_sub = row.last_sub = key.second;
    row.offset = (offsetof(host::Cia402Objects, foreign) + foreign_) & 0x1FFFU;
    row.extra = (text ? size : 0U) & 0xFFU;
    row.type_bits = object.type & 0x1FU;
    foreign_ += size;
  } else {
    return;  // a domain, or of a type that no object here has
  }
  row.access_bits = static_cast<unsigned>(object.access) & 0x3U;
  const unsigned receive = object.to_rpdo ? canopen::kReceive : canopen::kPlain;
  const unsigned transmit = object.to_tpdo ? canopen::kTransmit : canopen::kPlain;
  row.traits = (receive | transmit) & 0xFU;
  rows_.push_back(row);
}

void DriveProfile::fill(host::Cia402Objects& objects, const Entry& row,
                        std::uint8_t node_id) const {
  auto* const value = reinterpret_cast<std::uint8_t*>(&objects) + row.offset;
  if (row.type() == DataType::visible_string) {
    const std::string& text = eds_.find(id_of(row))->value;
    std::memset(value, 0, row.extra);
    std::copy_n(text.begin(), std::min<std::size_t>(text.size(), row.extra), value);
  } else if (const auto number = eds_.number(id_of(row), node_id)) {
    store_le(value, row.size(), *number);
  }
}

void DriveProfile::fill_communication(host::Cia402Objects& objects, std::uint8_t node_id) const {
  for (const Entry& row : rows_) {
    if (row.index < kFirstOfApplication && !among(kOfTheNodeId, row.index))
      fill(objects, row, node_id);
  }
}

void DriveProfile::fill_application(host::Cia402Objects& objects, std::uint8_t node_id) const {
  for (const Entry& row : rows_) {
    if (row.index >= kFirstOfApplication && !among(kOfTheAxis, row.index))
      fill(objects, row, node_id);
  }
}

}  // namespace volcomp::sim
