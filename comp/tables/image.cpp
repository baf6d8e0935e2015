// The writing half, on the host: see image_check.cpp for the half a node needs.

#include "comp/tables/image.hpp"

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"
#include "comp/tables/image_layout.hpp"

namespace volcomp {
namespace {

using namespace image_layout;

std::size_t axis_count(const MachineDescription& machine) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < machine.body_count; ++k)
    n += machine.body[k].joint.moves() ? 1U : 0U;
  return n;
}

void write_machine(LittleEndianWriter& w, const MachineDescription& m) {
  w.u8(m.work_body);
  w.u8(m.tool_body);
  w.u8(m.correcting_count);
  for (const std::uint8_t axis : m.correcting)
    w.u8(axis);
  w.u8(m.orienting_count);
  for (const std::uint8_t axis : m.orienting)
    w.u8(axis);
  w.f64s(m.tool_point);
  for (std::size_t k = 0; k < m.body_count; ++k) {
    const Body& body = m.body[k];
    w.u8(body.lower);
    w.u8(static_cast<std::uint8_t>(body.joint.kind));
    w.u8(static_cast<std::uint8_t>(body.joint.axis));
    w.u8(static_cast<std::uint8_t>(body.joint.sign));
    w.u8(body.joint.nc_axis);
    w.u8(static_cast<std::uint8_t>(body.joint.letter));
    w.f64s(body.joint.offset);
    w.f64s(body.joint.orientation);
    w.f64s(body.constant_error);
  }
}

}  // namespace

std::size_t image_size(const MachineTables& tables) {
  std::size_t bytes = first_axis(tables.machine.body_count) + kCrcBytes;
  const std::size_t axes = axis_count(tables.machine);
  for (std::size_t a = 0; a < axes; ++a)
    bytes += axis_bytes(tables.axis[a].knots);
  return bytes;
}

std::size_t image_value_offset(const MachineTables& tables, std::size_t axis, std::size_t travel,
                               std::size_t knot, std::size_t channel) {
  std::size_t at = first_axis(tables.machine.body_count);
  for (std::size_t a = 0; a < axis; ++a)
    at += axis_bytes(tables.axis[a].knots);
  return at + kAxisHeaderBytes + 4 * (6 * (travel * tables.axis[axis].knots + knot) + channel);
}

Status encode_image(const MachineTables& tables, Span<std::uint8_t> out, std::size_t& written) {
  const std::size_t size = image_size(tables);
  if (out.size() < size) return refuse(Reason::image_truncated);
  const std::size_t axes = axis_count(tables.machine);
  LittleEndianWriter w(out);
  for (const std::uint8_t byte : kMagic)
    w.u8(byte);
  w.bits(kImageVersion, 2);
  w.u8(static_cast<std::uint8_t>(axes));
  w.u8(tables.machine.body_count);
  w.u32(static_cast<std::uint32_t>(size));
  w.u32(tables.provenance.machine_id);
  w.u32(tables.provenance.sequence);
  w.i64(tables.provenance.built_unix_s);
  w.i64(tables.provenance.expires_unix_s);
  w.f32(tables.provenance.temperature_C);
  for (const char c : tables.provenance.stamp)
    w.u8(static_cast<std::uint8_t>(c));
  write_machine(w, tables.machine);
  for (std::size_t a = 0; a < axes; ++a) {
    const AxisTable& table = tables.axis[a];
    const std::size_t start = w.at();
    w.i64(table.q0);
    w.i64(table.pitch);
    w.u32(table.knots);
    w.u8(table.periodic ? 1 : 0);
    w.f64s(tables.directions[a]);
    w.f32(tables.expansion[a].per_K);
    w.f32(tables.expansion[a].fixed_mm);
    w.u8(tables.expansion[a].input);
    for (const auto& column : table.value) {
      for (std::uint32_t i = 0; i < table.knots; ++i) {
        for (const float v : column[i])
          w.f32(v);
      }
    }
    w.u32(crc32c({out.data() + start, w.at() - start}));
  }
  w.u32(crc32({out.data(), w.at()}));
  written = w.at();
  return {};
}

std::uint32_t image_crc(Span<const std::uint8_t> image) {
  return image.size() < kCrcBytes ? 0 : crc32({image.data(), image.size() - kCrcBytes});
}

Status decode_image(Span<const std::uint8_t> image, std::size_t capacity, MachineTables& out) {
  TablesView view;
  if (const Status s = check_image(image, capacity, view); !s.ok()) return s;
  out.provenance = view.provenance;
  out.directions = view.directions;
  out.expansion = view.expansion;
  if (const Status s = read_machine(image, out.machine); !s.ok()) return s;
  for (std::size_t a = 0; a < view.chain.axis_count(); ++a) {
    AxisTable& table = out.axis[a];
    static_cast<TableGrid&>(table) = view.axis[a].grid();
    for (std::size_t travel = 0; travel < 2; ++travel) {
      for (std::size_t i = 0; i < table.knots; ++i)
        table.value[travel][i] = view.axis[a].row(travel, i);
    }
  }
  return {};
}

}  // namespace volcomp
