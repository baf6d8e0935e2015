// Parameters and tables into the store and back: 1010h and 1011h (CiA 301, 7.5.2.13 and 7.5.2.14).

#include <algorithm>

#include "firmware/canopen/bytes.hpp"
#include "firmware/node/node.hpp"

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
  return canopen::load_le(signature.data(), 4) == word;
}

std::array<std::uint8_t, kPdoBytes> pack(const PdoParameters& p) {
  std::array<std::uint8_t, kPdoBytes> bytes{};
  canopen::store_le(bytes.data(), 4, p.cob_id);
  bytes[4] = p.type;
  canopen::store_le(&bytes[5], 2, p.inhibit_100us);
  canopen::store_le(&bytes[7], 2, p.event_timer_ms);
  bytes[9] = p.count;
  for (std::size_t i = 0; i < canopen::kMostMapped; ++i)
    canopen::store_le(&bytes[10 + 4 * i], 4, p.mapping[i]);
  return bytes;
}

PdoParameters unpack(const std::uint8_t* bytes) {
  PdoParameters p;
  p.cob_id = static_cast<std::uint32_t>(canopen::load_le(bytes, 4));
  p.type = bytes[4];
  p.inhibit_100us = static_cast<std::uint16_t>(canopen::load_le(bytes + 5, 2));
  p.event_timer_ms = static_cast<std::uint16_t>(canopen::load_le(bytes + 7, 2));
  p.count = static_cast<std::uint8_t>(std::min<std::size_t>(bytes[9], canopen::kMostMapped));
  for (std::size_t i = 0; i < canopen::kMostMapped; ++i)
    p.mapping[i] = static_cast<std::uint32_t>(canopen::load_le(bytes + 10 + 4 * i, 4));
  return p;
}

// The learned tables are kept in pieces, under their index.
constexpr std::uint16_t kLearned = 0x2526;
constexpr std::size_t kPiece = 240;

// Appends records as long as there is room; the sizes of the dictionary leave some.
class RecordWriter {
 public:
  explicit RecordWriter(Span<std::uint8_t> out) : out_(out) {}

  void add(std::uint16_t index, std::uint8_t sub, Span<const std::uint8_t> value) {
    if (at_ + kRecordHeader + value.size() > out_.size()) return;
    canopen::store_le(&out_[at_], 2, index);
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
      add(kLearned, piece++, {image.data() + at, std::min(kPiece, image.size() - at)});
  }
  [[nodiscard]] std::size_t size() const { return at_; }

 private:
  Span<std::uint8_t> out_;
  std::size_t at_ = 0;
};

}  // namespace

// Writing flash takes long: not while the axes move. Only tables that are active are worth keeping.
AbortCode Node::run_store(Span<const std::uint8_t> signature) {
  if (!signed_with(signature, kSave)) return AbortCode::cannot_store;
  if (storage_ == nullptr) return AbortCode::hardware;
  if (device_.state() == canopen::NmtState::operational) return AbortCode::device_state;
  const bool image_is_gone = compensator_.active() && download_.active_image().empty();
  if (image_is_gone) return AbortCode::local_control;
  const std::size_t size = collect_parameters();
  return report_store(save_record({parameters_.data(), size}, download_.active_image()));
}

AbortCode Node::run_restore(Span<const std::uint8_t> signature) {
  if (!signed_with(signature, kLoad)) return AbortCode::cannot_store;
  if (storage_ == nullptr) return AbortCode::hardware;
  if (device_.state() == canopen::NmtState::operational) return AbortCode::device_state;
  return report_store(erase_records());
}

StoreResult Node::save_record(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image) {
  const Preemptible preemptible(preemption_);
  return storage_->save(parameters, image);
}

StoreResult Node::erase_records() {
  const Preemptible preemptible(preemption_);
  return storage_->erase();
}

// Only the latest answer stands, and one good answer takes back every complaint about the store.
AbortCode Node::report_store(StoreResult result) {
  objects_.store_result = static_cast<std::uint8_t>(result);
  canopen::Emergency& emergency = device_.emergency();
  for (std::uint8_t source = 0; source < kStoreResults; ++source) {
    emergency.clear(ErrorCode::store_failed, source);
    if (result == StoreResult::done) emergency.clear(ErrorCode::parameters_lost, source);
  }
  if (result == StoreResult::done) return AbortCode::none;
  emergency.raise(ErrorCode::store_failed, objects_.store_result);
  return AbortCode::hardware;
}

std::size_t Node::collect_parameters() {
  RecordWriter writer({parameters_.data(), parameters_.size()});
  for (const Entry& entry : device_.objects().rows()) {
    if (!entry.has(canopen::kStored)) continue;
    for (unsigned s = entry.first_sub; s <= entry.last_sub; ++s) {
      const auto sub = static_cast<std::uint8_t>(s);
      const std::uint8_t* const value = device_.objects().find({entry.index, sub}).value;
      writer.add(entry.index, sub, {value, canopen::size_of(entry.type)});
    }
  }
  for (std::size_t i = 0; i < kReceivePdos; ++i) {
    writer.add_pdo(static_cast<std::uint16_t>(canopen::PdoTable::kReceiveCommunication + i),
                   receive_[i], default_receive_pdo(i, objects_.drive, objects_.controller));
  }
  for (std::size_t i = 0; i < kTransmitPdos; ++i) {
    writer.add_pdo(static_cast<std::uint16_t>(canopen::PdoTable::kTransmitCommunication + i),
                   transmit_[i], default_transmit_pdo(i, objects_.drive, device_.node_id()));
  }
  if constexpr (kWatchesStrokes) writer.add_learned(learned_image());
  return writer.size();
}

// Values another version stored and this one does not know or allow are left out.
void Node::apply_parameters(Span<const std::uint8_t> stored, bool application) {
  [[maybe_unused]] std::size_t learned = 0;
  std::size_t at = 0;
  while (at + kRecordHeader <= stored.size()) {
    const auto index = static_cast<std::uint16_t>(canopen::load_le(&stored[at], 2));
    const std::uint8_t sub = stored[at + 2];
    const Span<const std::uint8_t> value{stored.data() + at + kRecordHeader, stored[at + 3]};
    at += kRecordHeader + value.size();
    if (at > stored.size()) break;
    if constexpr (kWatchesStrokes) {
      if (index == kLearned) {
        load_learned(value, learned);
        continue;
      }
    }
    const bool wanted = (index >= 0x2000) == application;
    if (wanted && sub == kWholePdo) apply_pdo(index, value);
    if (wanted && sub != kWholePdo) static_cast<void>(device_.write({index, sub}, value));
  }
  if constexpr (kWatchesStrokes) {
    if (application) load_strokes(learned);
  }
}

void Node::apply_pdo(std::uint16_t index, Span<const std::uint8_t> value) {
  if (value.size() != kPdoBytes || !canopen::PdoTable::owns(index)) return;
  const bool receive = index < canopen::PdoTable::kTransmitCommunication;
  const std::size_t number = index & 0x1FFU;
  if (number >= (receive ? kReceivePdos : kTransmitPdos)) return;
  Pdo& pdo = receive ? receive_[number] : transmit_[number];
  PdoParameters p = unpack(value.data());
  if (!receive && number < kStatusPdo) {  // of an offset: the mapping is constant
    p.count = pdo.parameters().count;
    p.mapping = pdo.parameters().mapping;
  }
  static_cast<void>(
      pdo.configure(p, receive ? PdoKind::receive : PdoKind::transmit, device_.objects()));
}

// The application area brings the tables along: validated, armed and active before the first cycle.
void Node::load_stored(bool application) {
  if (storage_ == nullptr) return;
  Span<std::uint8_t> parameters{parameters_.data(), parameters_.size()};
  Span<std::uint8_t> image = application ? download_.buffer() : Span<std::uint8_t>{};
  const StoreResult found = storage_->load(parameters, image);
  objects_.stored = static_cast<std::uint8_t>(found);
  if (found != StoreResult::loaded && found != StoreResult::nothing_stored)
    device_.emergency().raise(ErrorCode::parameters_lost, objects_.stored);
  if (found != StoreResult::loaded && found != StoreResult::loaded_older) return;
  apply_parameters({parameters.data(), parameters.size()}, application);
  if (!application || image.empty()) return;
  download_.finish(image.size());
  static_cast<void>(run_table_command(TableCommand::activate));
}

}  // namespace volcomp::node
