// Settings of the node: from objects to the compensator, and into the store and back.

#include <algorithm>

#include "firmware/canopen/bytes.hpp"
#include "firmware/node/node.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::Entry;

namespace {

constexpr std::uint32_t kSave = 0x65766173;  // "save", "load": CiA 301, 7.5.2.13 and 7.5.2.14
constexpr std::uint32_t kLoad = 0x64616F6C;

// A stored value: index u16 · sub u8 · length u8 · bytes.
constexpr std::size_t kRecordHeader = 4;

bool signed_with(Span<const std::uint8_t> signature, std::uint32_t word) {
  return canopen::load_le(signature.data(), 4) == word;
}

// Rotary slew limits are given in 2^-32 turn like every offset.
std::int32_t slew_on_wire(std::int32_t slew, const WireScale& scale) {
  return std::max(1, offset_to_wire(slew, scale));
}

}  // namespace

Status Node::configure() {
  configure_gates();
  CompensatorSettings<kNodeAxes> s;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    const std::int32_t rate = OffsetGate::unhindered(objects_.slew[a], objects_.late_cycles);
    s.axis[a] = {objects_.limit[a], rate, std::min(rate, objects_.soft_rate[a]),
                 objects_.hysteresis[a], objects_.max_step[a]};
  }
  s.source = static_cast<PositionSource>(objects_.position_source);
  s.machine_id = objects_.machine_id;
  s.ramp_ticks = objects_.ramp_cycles;
  s.stale_drop_ticks = objects_.drop_cycles;
  return compensator_.configure(s);
}

void Node::configure_gates() {
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    scale_[a] = {objects_.scale_numerator[a], objects_.scale_denominator[a],
                 objects_.rotary[a] != 0};
    gate_[a].configure(slew_on_wire(objects_.slew[a], scale_[a]), objects_.late_cycles,
                       objects_.drives_report != 0);
  }
}

// The predefined mappings are known to be good, so nothing can be refused here.
void Node::set_default_pdos() {
  for (std::size_t i = 0; i < kReceivePdos; ++i) {
    static_cast<void>(receive_[i].configure(default_receive_pdo(i, objects_.drive),
                                            canopen::PdoKind::receive, device_.objects()));
  }
  for (std::size_t i = 0; i < kTransmitPdos; ++i) {
    static_cast<void>(
        transmit_[i].configure(default_transmit_pdo(i, objects_.drive, device_.node_id()),
                               canopen::PdoKind::transmit, device_.objects()));
  }
}

// --- 1010h and 1011h

// Writing flash takes long: not while the axes move. Only tables that are active are worth keeping.
AbortCode Node::run_store(Span<const std::uint8_t> signature) {
  if (!signed_with(signature, kSave)) return AbortCode::cannot_store;
  if (storage_ == nullptr) return AbortCode::hardware;
  if (device_.state() == canopen::NmtState::operational) return AbortCode::device_state;
  const bool image_is_gone = compensator_.active() && download_.active_image().empty();
  if (image_is_gone) return AbortCode::local_control;
  const std::size_t size = collect_parameters();
  const bool saved = storage_->save({parameters_.data(), size}, download_.active_image());
  return saved ? AbortCode::none : AbortCode::hardware;
}

AbortCode Node::run_restore(Span<const std::uint8_t> signature) {
  if (!signed_with(signature, kLoad)) return AbortCode::cannot_store;
  if (storage_ == nullptr) return AbortCode::hardware;
  if (device_.state() == canopen::NmtState::operational) return AbortCode::device_state;
  return storage_->erase() ? AbortCode::none : AbortCode::hardware;
}

std::size_t Node::collect_parameters() {
  std::size_t at = 0;
  for (const Entry& entry : device_.objects().rows()) {
    if (!entry.has(canopen::kStored)) continue;
    const std::size_t bytes = canopen::size_of(entry.type);
    for (unsigned s = entry.first_sub; s <= entry.last_sub; ++s) {
      if (at + kRecordHeader + bytes > parameters_.size()) return at;
      const auto sub = static_cast<std::uint8_t>(s);
      const std::uint8_t* const value = device_.objects().find({entry.index, sub}).value;
      canopen::store_le(&parameters_[at], 2, entry.index);
      parameters_[at + 2] = sub;
      parameters_[at + 3] = static_cast<std::uint8_t>(bytes);
      std::copy(value, value + bytes, &parameters_[at + kRecordHeader]);
      at += kRecordHeader + bytes;
    }
  }
  return at;
}

// Values another version stored and this one does not know or allow are left out.
void Node::apply_parameters(Span<const std::uint8_t> stored, bool application) {
  std::size_t at = 0;
  while (at + kRecordHeader <= stored.size()) {
    const auto index = static_cast<std::uint16_t>(canopen::load_le(&stored[at], 2));
    const std::size_t bytes = stored[at + 3];
    if (at + kRecordHeader + bytes > stored.size()) return;
    const bool wanted = (index >= 0x2000) == application;
    if (wanted) {
      static_cast<void>(
          device_.write({index, stored[at + 2]}, {stored.data() + at + kRecordHeader, bytes}));
    }
    at += kRecordHeader + bytes;
  }
}

// The application area brings the tables along: validated, armed and active before the first cycle.
void Node::load_stored(bool application) {
  if (storage_ == nullptr) return;
  Span<std::uint8_t> parameters{parameters_.data(), parameters_.size()};
  Span<std::uint8_t> image = application ? download_.buffer() : Span<std::uint8_t>{};
  const Storage::Found found = storage_->load(parameters, image);
  objects_.stored = static_cast<std::uint8_t>(found);
  const bool usable = found == Storage::Found::newest || found == Storage::Found::older;
  if (found == Storage::Found::damaged || found == Storage::Found::older)
    device_.emergency().raise(canopen::ErrorCode::parameters_lost,
                              static_cast<std::uint8_t>(found));
  if (!usable) return;
  apply_parameters({parameters.data(), parameters.size()}, application);
  if (!application || image.empty()) return;
  download_.finish(image.size());
  static_cast<void>(run_table_command(TableCommand::activate));
}

}  // namespace volcomp::node
