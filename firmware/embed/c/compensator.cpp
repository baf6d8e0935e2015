// Setting up and the tick of volcomp.h. Its settings from seconds: settings.cpp.

#include "firmware/embed/c/compensator.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "comp/tables/image.hpp"

namespace {

using volcomp::AxisLimits;
using volcomp::OrientingCompensator;
using volcomp::OrientingMachine;
using volcomp::Status;
using volcomp::Vec3;
using volcomp::c_interface::fine;
using volcomp::c_interface::from;
using volcomp::c_interface::refused;

using Settings = OrientingCompensator::Settings;

static_assert(volcomp::kStatusBits == VOLCOMP_STATUS_BITS);
static_assert(VOLCOMP_UNITS_PER_TURN == volcomp::kUnitsPerTurn);
static_assert(VOLCOMP_TEMPERATURES == volcomp::kTemperatureInputs);

Settings settings_of(const volcomp_settings& from) {
  Settings s;
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    const volcomp_axis_limits& l = from.axis[a];
    AxisLimits& limits = s.axis[a];
    limits.limit = l.limit;
    limits.rate = l.rate;
    limits.soft_rate = l.soft_rate;
    limits.hysteresis = l.hysteresis;
    limits.max_step = l.max_step;
    limits.acceleration = l.acceleration;
  }
  s.source = from.positions == VOLCOMP_TARGET ? volcomp::PositionSource::target
                                              : volcomp::PositionSource::actual;
  s.machine_id = from.machine_id;
  s.ramp_ticks = from.ramp_ticks;
  s.stale_drop_ticks = from.stale_drop_ticks;
  return s;
}

bool finite(const double* three) {
  return std::isfinite(three[0]) && std::isfinite(three[1]) && std::isfinite(three[2]);
}

// The first tables after a start decide which machine this is; later ones have to match.
Status fold(volcomp_compensator& c, std::uint32_t crc) {
  const volcomp::Vec3 tool_point = c.tables.chain.tool_point();
  if (c.activated) return c.compensator.stage(c.tables, tool_point, crc);
  const OrientingMachine machine{make_runtime_chain(c.tables.chain.description())};
  if (same_chain(machine.chain, c.compensator.machine().chain))
    return c.compensator.stage(c.tables, tool_point, crc);
  if (machine.chain.axes > VOLCOMP_AXES) return refuse(volcomp::Reason::too_many_axes);
  const Status status = c.compensator.stage_for(machine.chain, c.tables, tool_point, crc);
  if (status.ok()) c.compensator.adopt(machine);
  return status;
}

volcomp_machine describe(const volcomp::TablesView& tables, std::uint32_t image_crc) {
  const volcomp::MachineChain& chain = tables.chain;
  const volcomp::MachineDescription& description = chain.description();
  volcomp_machine m{};
  m.machine_id = tables.provenance.machine_id;
  m.sequence = tables.provenance.sequence;
  m.image_crc = image_crc;
  m.expires = tables.provenance.expires_unix_s;
  m.reference_C = tables.provenance.temperature_C;
  m.axes = static_cast<std::uint32_t>(chain.axis_count());
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    m.letter[a] = chain.axis(a).letter;
    m.rotary[a] = chain.axis(a).kind == volcomp::JointKind::rotary;
  }
  for (std::size_t i = 0; i < description.correcting_count; ++i)
    m.corrects[description.correcting[i]] = true;
  for (std::size_t i = 0; i < description.orienting_count; ++i)
    m.corrects[description.orienting[i]] = true;
  return m;
}

Status stage(volcomp_compensator& c, volcomp::Span<const std::uint8_t> image,
             const double* tool_mm) {
  if (const Status s = check_image(image, volcomp::kDefaultKnots, c.tables); !s.ok()) return s;
  const std::uint32_t crc = image_crc(image);
  // Active tables continue to follow temperatures and tools.
  const bool goes_on = c.compensator.active() && crc == c.active_crc;
  if (!goes_on && volcomp::expired(c.tables.provenance.expires_unix_s, c.unix_s))
    return refuse(volcomp::Reason::expired);
  if (tool_mm != nullptr) std::copy_n(tool_mm, 3, c.tables.chain.draft().tool_point.begin());
  c.tables.strain = strains(c.tables, temperatures_of(c.temperature));
  const Status status = fold(c, crc);
  if (status.ok()) c.machine = describe(c.tables, crc);
  return status;
}

volcomp_status counted(volcomp_compensator& c, const Status& status) {
  const volcomp_status s = from(status);
  if (s.reason == VOLCOMP_OK) return s;
  c.last_rejection = s;
  if (c.rejections < UINT32_MAX) ++c.rejections;
  return s;
}

}  // namespace

volcomp_status volcomp_create(void* memory, size_t bytes, volcomp_compensator** out) {
  if (memory == nullptr) return refused(VOLCOMP_NULL_POINTER, "memory");
  if (out == nullptr) return refused(VOLCOMP_NULL_POINTER, "out");
  if (bytes < VOLCOMP_BYTES) return refused(VOLCOMP_MEMORY_TOO_SMALL, "bytes");
  if (reinterpret_cast<std::uintptr_t>(memory) % alignof(volcomp_memory) != 0)
    return refused(VOLCOMP_MEMORY_MISALIGNED, "memory");
  *out = new (memory) volcomp_compensator;
  return fine();
}

volcomp_status volcomp_configure(volcomp_compensator* c, const volcomp_settings* settings) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  if (settings == nullptr) return refused(VOLCOMP_NULL_POINTER, "settings");
  if (settings->positions != VOLCOMP_TARGET && settings->positions != VOLCOMP_ACTUAL)
    return refused(VOLCOMP_BAD_SETTING, "positions");
  return from(c->compensator.configure(settings_of(*settings)));
}

volcomp_status volcomp_stage(volcomp_compensator* c, const void* image, size_t bytes,
                             const double* tool_mm) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  if (image == nullptr) return refused(VOLCOMP_NULL_POINTER, "image");
  if (tool_mm != nullptr && !finite(tool_mm)) return refused(VOLCOMP_NOT_FINITE, "tool");
  if (c->compensator.pending()) return from(refuse(volcomp::Reason::hand_over_pending));
  const Status status = stage(*c, {static_cast<const std::uint8_t*>(image), bytes}, tool_mm);
  c->staged = c->grows = status.ok();
  return counted(*c, status);
}

volcomp_status volcomp_start_from(volcomp_compensator* c, const int32_t offset[VOLCOMP_AXES]) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  if (offset == nullptr) return refused(VOLCOMP_NULL_POINTER, "offset");
  std::array<std::int32_t, VOLCOMP_AXES> offsets{};
  std::copy_n(offset, offsets.size(), offsets.begin());
  return from(c->compensator.start_from(offsets));
}

// Points of the probe wait for the tick, so that tables and tool point change together.
volcomp_status volcomp_activate(volcomp_compensator* c) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  if (!c->staged) return from(refuse(volcomp::Reason::not_staged));
  c->staged = false;
  const Status status = c->compensator.activate();
  if (!status.ok()) return from(status);
  c->activated = true;
  c->active_crc = c->machine.image_crc;
  c->probe.set_machine(c->tables.chain.description());
  return fine();
}

void volcomp_deactivate(volcomp_compensator* c) { c->compensator.deactivate(); }

volcomp_status volcomp_scrub(volcomp_compensator* c) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  return counted(*c, c->compensator.scrub());
}

bool volcomp_pending(const volcomp_compensator* c) { return c->compensator.pending(); }

bool volcomp_active(const volcomp_compensator* c) { return c->compensator.active(); }

bool volcomp_at_rest(const volcomp_compensator* c) { return c->compensator.at_rest(); }

void volcomp_take_temperature(volcomp_compensator* c, size_t input, float celsius, uint32_t now_s) {
  if (input >= VOLCOMP_TEMPERATURES) return;
  const bool representable = celsius > -300.0F && celsius < 300.0F;
  const float hundredths = representable ? 100.0F * celsius : 0.0F;
  const auto rounded = static_cast<std::int16_t>(hundredths + (hundredths < 0.0F ? -0.5F : 0.5F));
  c->temperature[input].take(representable ? rounded : volcomp::TemperatureInput::kNone, now_s);
}

int volcomp_temperature_state(const volcomp_compensator* c, size_t input, uint32_t now_s,
                              uint32_t stale_s) {
  if (input >= VOLCOMP_TEMPERATURES) return VOLCOMP_TEMPERATURE_UNKNOWN;
  return static_cast<int>(c->temperature[input].state(now_s, stale_s));
}

double volcomp_growth_nm(const volcomp_compensator* c) {
  if (!c->grows) return 0.0;
  return largest_growth_nm(c->tables, strains(c->tables, temperatures_of(c->temperature)));
}

void volcomp_set_time(volcomp_compensator* c, int64_t unix_s) { c->unix_s = unix_s; }

bool volcomp_expired(const volcomp_compensator* c) {
  return volcomp::expired(c->machine.expires, c->unix_s);
}

void volcomp_describe(const volcomp_compensator* c, volcomp_machine* out) { *out = c->machine; }

void volcomp_diagnose(const volcomp_compensator* c, volcomp_diagnostics* out) {
  const volcomp::Diagnostics<VOLCOMP_AXES> d = c->compensator.diagnostics();
  out->ticks = d.ticks;
  out->activations = d.activations;
  out->rejections = c->rejections;
  out->active_crc = d.active_crc;
  out->last_rejection = c->last_rejection;
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    std::copy(d.began[a].begin(), d.began[a].end(), std::begin(out->began[a]));
    out->largest[a] = d.largest[a];
    out->largest_lag[a] = d.largest_lag[a];
  }
}

void volcomp_tick(volcomp_compensator* c, const volcomp_input* in, volcomp_output* out) {
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a)
    c->in.axis[a] = {in->axis[a].position, in->axis[a].valid, in->axis[a].homed};
  c->compensator.tick(c->in, c->out);
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    out->offset[a] = c->out.offset[a];
    out->status[a] = c->out.status[a];
  }
}

int volcomp_direction(const volcomp_compensator* c, size_t axis) {
  if (axis >= VOLCOMP_AXES) return VOLCOMP_UNKNOWN;
  return static_cast<int>(c->compensator.direction(axis));
}
