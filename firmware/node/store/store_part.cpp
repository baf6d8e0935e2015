#include "firmware/node/store/store_part.hpp"

#include <algorithm>

#include "comp/core/bytes.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::Entry;
using canopen::ErrorCode;
using canopen::Pdo;
using canopen::PdoKind;
using canopen::PdoParameters;

namespace {

constexpr std::uint32_t kSave = 0x65766173;  // "save"
constexpr std::uint32_t kLoad = 0x64616F6C;  // "load"

// A stored value: index u16 · sub u8 · length u8 · bytes. A whole PDO that is not the predefined
// one stands under its communication index with this sub-index.
constexpr std::size_t kRecordHeader = 4;
constexpr std::uint8_t kWholePdo = 0xFF;
constexpr std::size_t kPdoBytes = 10 + 4 * canopen::kMostMapped;

bool signed_with(Span<const std::uint8_t> signature, std::uint32_t word) {
  return load_le(signature.data(), 4) == word;
}

std::array<std::uint8_t, kPdoBytes> pack(const PdoParameters& p) {
  std::array<std::uint8_t, kPdoBytes> bytes{};
  store_le(bytes.data(), 4, p.cob_id);
  bytes[4] = p.type;
  store_le(&bytes[5], 2, p.inhibit_100us);
  store_le(&bytes[7], 2, p.event_timer_ms);
  bytes[9] = p.count;
  for (std::size_t i = 0; i < canopen::kMostMapped; ++i)
    store_le(&bytes[10 + 4 * i], 4, p.mapping[i]);
  return bytes;
}

PdoParameters unpack(const std::uint8_t* bytes) {
  PdoParameters p;
  p.cob_id = load_u32(bytes);
  p.type = bytes[4];
  p.inhibit_100us = static_cast<std::uint16_t>(load_le(bytes + 5, 2));
  p.event_timer_ms = static_cast<std::uint16_t>(load_le(bytes + 7, 2));
  p.count = static_cast<std::uint8_t>(std::min<std::size_t>(bytes[9], canopen::kMostMapped));
  for (std::size_t i = 0; i < canopen::kMostMapped; ++i)
    p.mapping[i] = load_u32(bytes + 10 + 4 * i);
  return p;
}

// The learned tables are kept in pieces, under their index.
constexpr std::size_t kPiece = 240;

// Appends records as long as there is room; the sizes of the dictionary leave some.
class RecordWriter {
 public:
  explicit RecordWriter(Span<std::uint8_t> out) : out_(out) {}

  void add(std::uint16_t index, std::uint8_t sub, Span<const std::uint8_t> value) {
    if (at_ + kRecordHeader + value.size() > out_.size()) return;
    store_le(&out_[at_], 2, index);
    out_[at_ + 2] = sub;
    out_[at_ + 3] = static_cast<std::uint8_t>(value.size());
    std::copy(value.begin(), value.end(), &out_[at_ + kRecordHeader]);
    at_ += kRecordHeader + value.size();
  }
  void add_pdo(std::uint16_t index, const Pdo& pdo, const PdoParameters& predefined) {
    const auto bytes = pack(pdo.parameters());
    if (bytes != pack(predefined)) add(index, kWholePdo, bytes);
  }
  void add_learned(Span<const std::uint8_t> image) {
    std::uint8_t piece = 0;
    for (std::size_t at = 0; at < image.size(); at += kPiece)
      add(object::stroke::learned_image.index, piece++,
          {image.data() + at, std::min(kPiece, image.size() - at)});
  }
  [[nodiscard]] std::size_t size() const { return at_; }

 private:
  Span<std::uint8_t> out_;
  std::size_t at_ = 0;
};

}  // namespace

// CiA 301, 7.5.2.13: bit 0, saves on command. The signature was written over it.
void StorePart::before_read(canopen::ObjectId /*object*/) {
  const bool writable = storage_ != nullptr && storage_->writable();
  core_.objects.store = core_.objects.restore = writable ? 1 : 0;
}

// Writing flash takes long: not while the axes move. Only tables that are active are worth keeping.
AbortCode StorePart::save(Span<const std::uint8_t> signature) {
  if (!signed_with(signature, kSave)) return AbortCode::cannot_store;
  if (storage_ == nullptr) return AbortCode::hardware;
  if (core_.operational()) return AbortCode::device_state;
  const bool image_is_gone = core_.compensator.active() && tables_.active_image().empty();
  if (image_is_gone) return AbortCode::local_control;
  const std::size_t size = collect_parameters();
  return report_result(save_record({parameters_.data(), size}, tables_.active_image()));
}

AbortCode StorePart::restore(Span<const std::uint8_t> signature) {
  if (!signed_with(signature, kLoad)) return AbortCode::cannot_store;
  if (storage_ == nullptr) return AbortCode::hardware;
  if (core_.operational()) return AbortCode::device_state;
  return report_result(erase_records());
}

StoreResult StorePart::save_record(Span<const std::uint8_t> parameters,
                                   Span<const std::uint8_t> image) {
  const Preemptible preemptible(core_.preemption);
  return storage_->save(parameters, image);
}

StoreResult StorePart::erase_records() {
  const Preemptible preemptible(core_.preemption);
  return storage_->erase();
}

// Only the latest answer stands, and one good answer takes back every complaint about the store.
AbortCode StorePart::report_result(StoreResult result) {
  core_.objects.store_result = static_cast<std::uint8_t>(result);
  canopen::Emergency& emergency = core_.emergency();
  for (std::uint8_t source = 0; source < kStoreResults; ++source) {
    emergency.clear(ErrorCode::store_failed, source);
    if (result == StoreResult::done) emergency.clear(ErrorCode::parameters_lost, source);
  }
  if (result == StoreResult::done) return AbortCode::none;
  emergency.raise(ErrorCode::store_failed, core_.objects.store_result);
  return AbortCode::hardware;
}

std::size_t StorePart::collect_parameters() {
  RecordWriter writer({parameters_.data(), parameters_.size()});
  for (const Entry& entry : core_.device.objects().rows()) {
    if (!entry.has(canopen::kStored)) continue;
    for (unsigned s = entry.first_sub; s <= entry.last_sub; ++s) {
      const auto sub = static_cast<std::uint8_t>(s);
      const std::uint8_t* const value = core_.device.objects().find({entry.index, sub}).value;
      writer.add(entry.index, sub, {value, entry.size()});
    }
  }
  for (std::size_t i = 0; i < kReceivePdos; ++i) {
    writer.add_pdo(static_cast<std::uint16_t>(canopen::PdoTable::kReceiveCommunication + i),
                   core_.receive[i], default_receive_pdo(i, core_.objects));
  }
  for (std::size_t i = 0; i < kTransmitPdos; ++i) {
    writer.add_pdo(static_cast<std::uint16_t>(canopen::PdoTable::kTransmitCommunication + i),
                   core_.transmit[i],
                   default_transmit_pdo(i, core_.objects, core_.device.node_id()));
  }
  writer.add_learned(strokes_.learned_image());
  return writer.size();
}

// Values another version stored and this one does not know or allow are left out.
void StorePart::apply_parameters(Span<const std::uint8_t> stored, bool application) {
  std::size_t learned = 0;
  std::size_t at = 0;
  while (at + kRecordHeader <= stored.size()) {
    const auto index = static_cast<std::uint16_t>(load_le(&stored[at], 2));
    const std::uint8_t sub = stored[at + 2];
    const Span<const std::uint8_t> value{stored.data() + at + kRecordHeader, stored[at + 3]};
    at += kRecordHeader + value.size();
    if (at > stored.size()) break;
    if (index == object::stroke::learned_image.index) {
      strokes_.load_learned(value, learned);
      continue;
    }
    const bool wanted = (index >= object::machine_id.index) == application;
    if (wanted && sub == kWholePdo) apply_pdo(index, value);
    if (wanted && sub != kWholePdo) static_cast<void>(core_.device.write({index, sub}, value));
  }
  if (application) strokes_.finish_loading(learned);
}

void StorePart::apply_pdo(std::uint16_t index, Span<const std::uint8_t> value) {
  if (value.size() != kPdoBytes || !canopen::PdoTable::owns(index)) return;
  const bool receive = index < canopen::PdoTable::kTransmitCommunication;
  const std::size_t number = index & 0x1FFU;
  if (number >= (receive ? kReceivePdos : kTransmitPdos)) return;
  Pdo& pdo = receive ? core_.receive[number] : core_.transmit[number];
  PdoParameters p = unpack(value.data());
  if (!receive) p.cob_id |= canopen::kPdoNoRtr;
  if (!receive && number < kStatusPdo) {  // of an offset: the mapping is constant
    p.count = pdo.parameters().count;
    p.mapping = pdo.parameters().mapping;
  }
  static_cast<void>(
      pdo.configure(p, receive ? PdoKind::receive : PdoKind::transmit, core_.device.objects()));
}

void StorePart::load(bool application) {
  if (storage_ == nullptr) return;
  Span<std::uint8_t> parameters{parameters_.data(), parameters_.size()};
  Span<std::uint8_t> image = application ? tables_.buffer() : Span<std::uint8_t>{};
  const StoreResult found = storage_->load(parameters, image);
  core_.objects.stored = static_cast<std::uint8_t>(found);
  if (found != StoreResult::loaded && found != StoreResult::nothing_stored)
    core_.emergency().raise(ErrorCode::parameters_lost, core_.objects.stored);
  if (found != StoreResult::loaded && found != StoreResult::loaded_older) return;
  apply_parameters({parameters.data(), parameters.size()}, application);
  if (!application || image.empty()) return;
  static_cast<void>(tables_.finish_domain(image.size()));
  static_cast<void>(tables_.command(TableCommand::activate));
}

}  // namespace volcomp::node
