#include "firmware/node/tables/table_download.hpp"

#include "comp/tables/image.hpp"
#include "firmware/node/thermal/table_growth.hpp"

namespace volcomp::node {

using canopen::AbortCode;
using canopen::ErrorCode;

AbortCode TableDownload::begin_domain(std::size_t announced, Span<std::uint8_t>& sink) {
  if (core_.compensator.pending()) return AbortCode::device_state;
  if (announced > image_.size()) return AbortCode::out_of_memory;
  enter(TableState::receiving);
  core_.objects.staged_bytes = 0;
  core_.objects.staged_crc = 0;
  sink = {image_.data(), image_.size()};
  return AbortCode::none;
}

std::uint32_t TableDownload::crc_of(Span<const std::uint8_t> image) const {
  const Preemptible preemptible(core_.preemption);
  return image_crc(image);
}

AbortCode TableDownload::finish_domain(std::size_t size) {
  core_.objects.staged_bytes = static_cast<std::uint32_t>(size);
  core_.objects.staged_crc = crc_of({image_.data(), size});
  enter(TableState::received);
  return AbortCode::none;
}

void TableDownload::abandon_domain() { enter(TableState::empty); }

void TableDownload::reset() {
  core_.objects.image_capacity = static_cast<std::uint32_t>(image_.size());
  enter(TableState::empty);
  core_.objects.staged_bytes = 0;
  core_.objects.staged_crc = 0;
  core_.objects.active_crc = 0;
  core_.objects.active_sequence = 0;
  report({}, core_.objects);
}

AbortCode TableDownload::read_domain(canopen::ObjectId /*object*/,
                                     Span<const std::uint8_t>& source) const {
  if (core_.objects.staged_bytes == 0) return AbortCode::no_data;
  source = {image_.data(), core_.objects.staged_bytes};
  return AbortCode::none;
}

Span<const std::uint8_t> TableDownload::active_image() const {
  if (state() != TableState::active) return {};
  return {image_.data(), core_.objects.staged_bytes};
}

AbortCode TableDownload::judge(const Status& status, TableState next) {
  report(status, core_.objects);
  enter(status.ok() ? next : TableState::refused);
  if (!status.ok() && core_.objects.rejections < UINT32_MAX) ++core_.objects.rejections;
  return status.ok() ? AbortCode::none : AbortCode::general;
}

Status TableDownload::check(Span<const std::uint8_t> image) {
  const Preemptible preemptible(core_.preemption);
  return check_image(image, kNodeKnots, tables_);
}

AbortCode TableDownload::validate() {
  Status status = check({image_.data(), core_.objects.staged_bytes});
  if (status.ok()) status = check_use();
  return judge(status, TableState::valid);
}

// Checks the machine id and the expiry.
Status TableDownload::check_use() const {
  const std::uint32_t wanted = core_.objects.machine_id;
  if (wanted != 0 && tables_.provenance.machine_id != wanted)
    return refuse(Reason::machine_mismatch);
  if constexpr (kFollowsTemperature) {
    if (past_expiry(tables_, core_.objects)) return refuse(Reason::expired);
  }
  return {};
}

NodeMachine TableDownload::machine() const {
  const Preemptible preemptible(core_.preemption);
  return NodeMachine{make_runtime_chain(tables_.chain.description())};
}

Status TableDownload::stage(const RuntimeChain& chain) {
  const Preemptible preemptible(core_.preemption);
  return core_.compensator.stage_for(chain, tables_, tables_.chain.tool_point(),
                                     core_.objects.staged_crc);
}

// The first tables after a start decide which machine this is; later ones have to match. Tables of
// another machine that are refused leave the active ones as they are.
Status TableDownload::stage() {
  const RuntimeChain& own = core_.compensator.machine().chain;
  const NodeMachine machine = this->machine();
  if (machine.chain.axes > kNodeAxes) return refuse(Reason::too_many_axes);
  const Status way = core_.check_way_of(machine.chain);
  if (!way.ok()) return way;
  const Status status = stage(core_.running ? own : machine.chain);
  if (!status.ok() || same_chain(machine.chain, own)) return status;
  if (core_.running) return stage(own);  // started meanwhile: refused
  core_.compensator.adopt(machine);
  core_.note_machine();
  core_.objects.active_crc = 0;
  core_.objects.active_sequence = 0;
  return {};
}

AbortCode TableDownload::arm() {
  Status status = check_use();  // again: 2000h:01 may have been written since
  if constexpr (kFollowsTemperature) tables_.strain = strains_now(tables_, core_.objects);
  if (status.ok()) status = stage();
  return judge(status, TableState::armed);
}

// Takes a request over where no tick comes to do so.
void TableDownload::settle() {
  if (!core_.running) core_.compensator.settle();
}

AbortCode TableDownload::activate() {
  const AbortCode why = judge(core_.compensator.activate(), TableState::active);
  if (why != AbortCode::none) return why;
  settle();
  const RuntimeChain& chain = core_.compensator.machine().chain;
  core_.objects.axes = chain.axes;
  core_.objects.axis_letters = {};
  for (std::size_t a = 0; a < chain.axes; ++a)
    core_.objects.axis_letters[a] = chain.letter[a];
  core_.objects.active_crc = core_.objects.staged_crc;
  core_.objects.active_sequence = tables_.provenance.sequence;
  if constexpr (kFollowsTemperature) note_growth(tables_, core_.objects);
  return AbortCode::none;
}

AbortCode TableDownload::run(TableCommand command) {
  if (command == TableCommand::none) return AbortCode::none;
  if (core_.compensator.pending()) return AbortCode::device_state;
  if (command == TableCommand::deactivate) {
    core_.compensator.deactivate();
    settle();
    lost_active();
    return AbortCode::none;
  }
  if (command == TableCommand::discard) {
    abandon_domain();
    core_.objects.staged_bytes = 0;
    return AbortCode::none;
  }
  if (core_.objects.staged_bytes == 0 || state() == TableState::receiving)
    return AbortCode::device_state;
  AbortCode why = validate();
  if (why == AbortCode::none && command >= TableCommand::arm) why = arm();
  if (why == AbortCode::none && command >= TableCommand::activate) why = activate();
  return why;
}

AbortCode TableDownload::command(TableCommand command) {
  const AbortCode why = run(command);
  canopen::Emergency& emergency = core_.emergency();
  if (why == AbortCode::general)
    emergency.raise(ErrorCode::table_refused, core_.objects.where_axis, {core_.objects.reason});
  if (why != AbortCode::none || command < TableCommand::validate) return why;
  for (std::size_t letter = 0; letter < 128; ++letter)
    emergency.clear(ErrorCode::table_refused, static_cast<std::uint8_t>(letter));
  if (command == TableCommand::activate) {
    emergency.clear(ErrorCode::table_damaged, 0);
    emergency.clear(ErrorCode::memory_damaged, 0);
    probe_.set_machine(tables_.chain.description());
  }
  return why;
}

bool TableDownload::fold_again(const Strains& strains) {
  const Strains folded = tables_.strain;
  tables_.strain = strains;
  const std::uint32_t crc = crc_of({image_.data(), core_.objects.staged_bytes});
  const bool staged =
      crc == core_.objects.active_crc && stage(core_.compensator.machine().chain).ok();
  // The tick may have dropped the tables meanwhile.
  if (!staged || state() != TableState::active) {
    tables_.strain = folded;
    return false;
  }
  static_cast<void>(core_.compensator.activate());
  settle();
  return true;
}

void TableDownload::drop(ErrorCode cause, std::size_t source) {
  NodeCompensator& compensator = core_.compensator;
  if (compensator.active() || compensator.pending()) compensator.deactivate();
  settle();
  lost_active();
  core_.emergency().raise(cause, static_cast<std::uint8_t>(source));
}

void TableDownload::lost_active() {
  core_.objects.active_crc = 0;
  core_.objects.active_sequence = 0;
  if (state() == TableState::active) enter(TableState::valid);
}

}  // namespace volcomp::node
