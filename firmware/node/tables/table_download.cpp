#include "firmware/node/tables/table_download.hpp"

#include <cstring>

#include "comp/tables/image.hpp"

namespace volcomp::node {

using canopen::AbortCode;

void report(const Status& status, NodeObjects& objects) {
  const Where& where = status.where;
  objects.reason = static_cast<std::uint8_t>(status.reason);
  objects.where_axis = static_cast<std::uint8_t>(where.axis);
  objects.where_index = static_cast<std::int16_t>(where.index);
  objects.where_channel = static_cast<std::int8_t>(where.channel);
  objects.reason_text = {};
  if (const char* const text = loading_sentence(status.reason); text != nullptr)
    std::strncpy(objects.reason_text.data(), text, objects.reason_text.size() - 1);
}

AbortCode TableDownload::begin(std::size_t announced, Span<std::uint8_t>& sink) {
  if (compensator_.pending()) return AbortCode::device_state;
  if (announced > image_.size()) return AbortCode::out_of_memory;
  enter(TableState::receiving);
  objects_.staged_bytes = 0;
  objects_.staged_crc = 0;
  sink = {image_.data(), image_.size()};
  return AbortCode::none;
}

std::uint32_t TableDownload::name_of(Span<const std::uint8_t> image) const {
  const Preemptible preemptible(preemption_);
  return image_crc(image);
}

void TableDownload::finish(std::size_t size) {
  objects_.staged_bytes = static_cast<std::uint32_t>(size);
  objects_.staged_crc = name_of({image_.data(), size});
  enter(TableState::received);
}

void TableDownload::abandon() { enter(TableState::empty); }

void TableDownload::reset() {
  objects_.image_capacity = static_cast<std::uint32_t>(image_.size());
  enter(TableState::empty);
  objects_.staged_bytes = 0;
  objects_.staged_crc = 0;
  objects_.active_crc = 0;
  objects_.active_sequence = 0;
  report({}, objects_);
}

AbortCode TableDownload::read(Span<const std::uint8_t>& source) const {
  if (objects_.staged_bytes == 0) return AbortCode::no_data;
  source = {image_.data(), objects_.staged_bytes};
  return AbortCode::none;
}

Span<const std::uint8_t> TableDownload::active_image() const {
  if (state() != TableState::active) return {};
  return {image_.data(), objects_.staged_bytes};
}

AbortCode TableDownload::judge(const Status& status, TableState next) {
  report(status, objects_);
  enter(status.ok() ? next : TableState::refused);
  if (!status.ok() && objects_.rejections < UINT32_MAX) ++objects_.rejections;
  return status.ok() ? AbortCode::none : AbortCode::general;
}

Status TableDownload::check(Span<const std::uint8_t> image) {
  const Preemptible preemptible(preemption_);
  return check_image(image, kNodeKnots, tables_);
}

AbortCode TableDownload::validate() {
  Status status = check({image_.data(), objects_.staged_bytes});
  if (status.ok()) status = check_use();
  return judge(status, TableState::valid);
}

// Whose tables these are, and whether they still hold.
Status TableDownload::check_use() const {
  const std::uint32_t wanted = objects_.machine_id;
  if (wanted != 0 && tables_.provenance.machine_id != wanted)
    return refuse(Reason::machine_mismatch);
  if constexpr (kFollowsTemperature) {
    if (past_expiry()) return refuse(Reason::expired);
  }
  return {};
}

NodeMachine TableDownload::machine() const {
  const Preemptible preemptible(preemption_);
  return NodeMachine{make_runtime_chain(tables_.chain.description())};
}

Status TableDownload::stage(const RuntimeChain& chain) {
  const Preemptible preemptible(preemption_);
  return compensator_.stage_for(chain, tables_, tables_.chain.tool_point(), objects_.staged_crc);
}

// The first tables after a start decide which machine this is; later ones have to match. Tables of
// another machine that are refused leave the active ones as they are.
Status TableDownload::stage() {
  const RuntimeChain& own = compensator_.machine().chain;
  const NodeMachine machine = this->machine();
  if (machine.chain.axes > kNodeAxes) return refuse(Reason::too_many_axes);
  const Status status = stage(running_ ? own : machine.chain);
  if (!status.ok() || same_chain(machine.chain, own)) return status;
  if (running_) return stage(own);  // started meanwhile: refused
  compensator_.adopt(machine);
  objects_.active_crc = 0;
  objects_.active_sequence = 0;
  return {};
}

AbortCode TableDownload::arm() {
  Status status = check_use();  // again: 2000h:01 may have been written since
  if constexpr (kFollowsTemperature) grow();
  if (status.ok()) status = stage();
  return judge(status, TableState::armed);
}

// Where no tick will come to take a request over.
void TableDownload::settle() {
  if (!running_) compensator_.settle();
}

AbortCode TableDownload::activate() {
  const AbortCode why = judge(compensator_.activate(), TableState::active);
  if (why != AbortCode::none) return why;
  settle();
  const RuntimeChain& chain = compensator_.machine().chain;
  objects_.axes = chain.axes;
  objects_.axis_letters = {};
  for (std::size_t a = 0; a < chain.axes; ++a)
    objects_.axis_letters[a] = chain.letter[a];
  objects_.active_crc = objects_.staged_crc;
  objects_.active_sequence = tables_.provenance.sequence;
  if constexpr (kFollowsTemperature) note_growth();
  return AbortCode::none;
}

AbortCode TableDownload::command(TableCommand command) {
  if (command == TableCommand::none) return AbortCode::none;
  if (compensator_.pending()) return AbortCode::device_state;
  if (command == TableCommand::deactivate) {
    compensator_.deactivate();
    settle();
    lost_active();
    return AbortCode::none;
  }
  if (command == TableCommand::discard) {
    abandon();
    objects_.staged_bytes = 0;
    return AbortCode::none;
  }
  if (objects_.staged_bytes == 0 || state() == TableState::receiving)
    return AbortCode::device_state;
  AbortCode why = validate();
  if (why == AbortCode::none && command >= TableCommand::arm) why = arm();
  if (why == AbortCode::none && command >= TableCommand::activate) why = activate();
  return why;
}

void TableDownload::lost_active() {
  objects_.active_crc = 0;
  objects_.active_sequence = 0;
  if (state() == TableState::active) enter(TableState::valid);
}

}  // namespace volcomp::node
