#include "host_sim/experiments/internal_helical/bus_grinder.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"
#include "comp/strokes/helix_instances.hpp"
#include "firmware/node/node_objects.hpp"
#include "firmware/node/offset_gate.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace volcomp::internal_helical {
namespace {

namespace stroke = node::object::stroke;

constexpr std::size_t kX = 0;
constexpr std::size_t kZ = 1;
constexpr std::size_t kC = 2;

constexpr std::array<Direction, 2> kDirections{Direction::forward, Direction::backward};

// Longer than the longest transfer takes: 1.2 KB in segments.
constexpr int kMostWaiting = 5000;

constexpr std::int64_t kFiner = 512;  // 2^-40 turn

// A machine that is as it was drawn.
std::vector<std::uint8_t> image_without_errors(const host::MachineFile& machine) {
  return host::make_image(host::constant_tables(machine, zero_errors(), node::kNodeKnots)->tables);
}

bool corrects(const MachineChain& chain, std::size_t axis) {
  const MachineDescription& d = chain.description();
  const auto* const end = d.correcting.begin() + d.correcting_count;
  return std::find(d.correcting.begin(), end, axis) != end;
}

// Checks what a node would refuse, and names the fields of the machine file.
void check(const host::MachineFile& machine, const host::BusSettings& settings,
           const host::WatchedStrokes& watched) {
  machine.expect_axes("XZC");
  if (!corrects(machine.chain, kC))
    throw host::UserError(machine.path +
                          ": 'axes' of [correction] must contain C: the learned offset is "
                          "added to that of C");
  for (const host::BusAxis& axis : settings.axes) {
    if (axis.scale_numerator == (axis.rotary ? 512U : 1U) && axis.scale_denominator == 1) continue;
    throw host::UserError(
        fmt::format("{}: the drives of the simulated grinder count in nanometres and "
                    "2^-31 turn; axis {} has other units",
                    machine.path, axis.letter));
  }
  const std::int32_t slew = settings.limits.axis[kC].rate;
  constexpr std::uint8_t kLate = 2;  // 2200h:04
  if (node::OffsetGate::unhindered(slew, kLate) < watched.offsets.rate) {
    const double rad = watched.offsets.rate * (256.0 / kUnitsPerRad) * (2 * kLate + 3);
    throw host::UserError(
        fmt::format("{}: 'rate_rad_per_s' of [correction] must be at least {:.3f}, so that the "
                    "learned offset of C can change as fast as its tables need",
                    machine.path, 1e6 * rad / settings.period_us));
  }
  host::require(std::make_unique<GrinderMonitor>()->configure(watched.monitor), machine.path);
  host::require(check_rules(watched.along), machine.path);
  host::require(check_rules(watched.around), machine.path);
}

}  // namespace

std::unique_ptr<sim::BusAxes> grinder_axes(const host::MachineFile& machine,
                                           const host::WatchedStrokes& watched,
                                           const sim::BusAxesFactory& make_axes) {
  host::BusSettings settings = host::bus_settings(machine, 1.0 / kStrokeTick_s);
  settings.strokes = watched;
  check(machine, settings, watched);
  return make_axes(settings, image_without_errors(machine));
}

BusGrinder::BusGrinder(std::unique_ptr<sim::BusAxes> axes, const StrokeStep& standing,
                       GrinderPlant& plant)
    : axes_(std::move(axes)), last_(standing) {
  axes_->stand_at({static_cast<double>(standing.x) / kNmPerMm,
                   static_cast<double>(standing.z) / kNmPerMm,
                   static_cast<double>(standing.c) / kWirePerRad});
  axes_->couple(kX, {[&plant] { return plant.read_x(); },
                     [&plant](std::int64_t demand) { plant.follow_x(demand); }});
  axes_->couple(kZ, {[&plant] { return plant.read_z(); },
                     [&plant](std::int64_t demand) { plant.follow_z(demand); }});
  axes_->couple(kC, {[&plant] { return plant.read_c(); },
                     [&plant](std::int64_t demand) { plant.follow_c(demand); }});
  axes_->bring_up();
}

void BusGrinder::cycle(const StrokeStep& step) {
  last_ = step;
  axes_->controller().send_process_state(step);
  axes_->cycle({step.x, step.z, kFiner * step.c});
}

// Nothing begins while the machine rests.
void BusGrinder::rest_until_answered() {
  StrokeStep rest = last_;
  rest.in_face = rest.stroke_end = false;
  host::SdoChannel& sdo = axes_->controller().node_objects();
  const std::vector<std::int32_t> path = axes_->on_wire({rest.x, rest.z, kFiner * rest.c});
  for (int i = 0; i < kMostWaiting && !sdo.idle() && sdo.failure().empty(); ++i) {
    axes_->controller().send_process_state(rest);
    axes_->run_cycle(path);
  }
  if (sdo.idle()) return;
  throw host::UserError("the compensation node does not answer any more");
}

host::SdoChannel::Bytes BusGrinder::read(canopen::ObjectId object, std::size_t most,
                                         const std::string& what) {
  host::SdoChannel& sdo = axes_->controller().node_objects();
  host::SdoChannel::Bytes found;
  sdo.read(object, most, what, [&found](const host::SdoChannel::Bytes& bytes) { found = bytes; });
  rest_until_answered();
  if (!sdo.failure().empty()) throw host::UserError(sdo.failure());
  return found;
}

std::vector<double> BusGrinder::read_means(std::size_t table, std::size_t most) {
  const auto& means = stroke::means;
  const host::SdoChannel::Bytes bytes = read(means[table].id(), sizeof(float) * most, means.name);
  std::vector<double> values;
  for (std::size_t at = 0; at + sizeof(float) <= bytes.size(); at += sizeof(float))
    values.push_back(static_cast<double>(load_f32(&bytes[at])));
  return values;
}

std::string BusGrinder::feed_trouble() {
  if ((read(stroke::offset_status) & kOtherFeed) == 0) return {};
  return fmt::format(
      "the node adds no learned offset: its tables are for F={:g} mm/s, the stroke has F={:g} mm/s",
      read(stroke::table_feed) / kNmPerMm, last_.feed_nm_per_s / kNmPerMm);
}

void BusGrinder::learn() {
  if (const std::string trouble = feed_trouble(); !trouble.empty()) throw host::UserError(trouble);
  host::SdoChannel& sdo = axes_->controller().node_objects();
  sdo.write(stroke::learn, static_cast<std::uint8_t>(node::LearnCommand::learn));
  rest_until_answered();
  if (sdo.failure().empty()) return;
  sdo.clear();
  const auto reason = static_cast<Reason>(read(stroke::learn_reason));
  throw host::UserError(
      fmt::format("the node refuses to learn: {} [{}]", sentence(reason), code(reason)));
}

MonitorView BusGrinder::view() {
  const host::WatchedStrokes& watched = *axes_->controller().settings().strokes;
  const double um_per_rad = kUmPerMm * watched.monitor.flank_per_rad;
  const auto on_flank = [um_per_rad](std::vector<double> rad) {
    for (double& value : rad)
      value *= um_per_rad;
    return rad;
  };
  const auto amplitude = [](const std::vector<double>& values) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return least == values.end() ? 0.0 : 0.5 * (*most - *least);
  };
  MonitorView view;
  for (std::size_t d = 0; d < kDirections.size(); ++d) {
    const std::vector<double> means = read_means(d, kStrokeNodes);
    if (kDirections[d] == Direction::forward) view.over_stroke.amplitude = amplitude(means);
    view.stroke[d] = on_flank(means);
  }
  const std::vector<double> slots = read_means(kDirections.size(), kGearSlots);
  view.over_slots.amplitude = amplitude(slots);
  view.slot = on_flank(slots);
  view.around = orders_around(view.slot);
  for (std::size_t k = 0; k < kMostLines; ++k) {
    view.along.push_back(std::hypot(read(stroke::lines_0[k]), read(stroke::lines_1[k])) /
                         std::sqrt(2.0));
  }
  return view;
}

// 2526h:01, see firmware/node/strokes/stroke_objects.hpp.
LearnedTables BusGrinder::tables() {
  const auto& learned = stroke::learned_image;
  const host::SdoChannel::Bytes image = read(learned.id(), node::kMostLearnedBytes, learned.name);
  const auto damaged = [] {
    return host::UserError("the node's learned tables are damaged on the way");
  };
  if (image.size() < node::kLearnedHeader + 4) throw damaged();
  const std::size_t body = image.size() - 4;
  if (crc32({image.data(), body}) != load_u32(&image[body])) throw damaged();
  const auto number_at = [&image](std::size_t at, std::size_t count) {
    return load_le(&image[at], count);
  };
  const auto nodes = static_cast<std::size_t>(number_at(12, 2));
  const auto slots = static_cast<std::size_t>(number_at(14, 2));
  if (body != node::kLearnedHeader + 4 * (2 * nodes + slots)) throw damaged();
  LearnedTables t;
  t.z0_mm = static_cast<double>(static_cast<std::int64_t>(number_at(16, 8))) / kNmPerMm;
  t.pitch_mm = static_cast<double>(number_at(24, 4)) / kNmPerMm;
  std::size_t at = node::kLearnedHeader;
  const auto take = [&image, &at](std::size_t count, std::vector<double>& out) {
    for (std::size_t i = 0; i < count; ++i, at += 4)
      out.push_back(static_cast<double>(load_f32(&image[at])));
  };
  take(nodes, t.stroke[0]);
  take(nodes, t.stroke[1]);
  take(slots, t.slot);
  return t;
}

}  // namespace volcomp::internal_helical
