#include "comp/tables/image.hpp"

#include <cmath>
#include <cstring>

#include "comp/tables/crc32.hpp"
#include "comp/units.hpp"

namespace volcomp {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'V', 'C', 'T', '1'};
constexpr std::size_t kHeaderBytes = 4 + 2 + 1 + 1 + 4 + 4 + 4 + 8 + 4 + 16;
constexpr std::size_t kMachineBytes = 3 + 3 + 24;
constexpr std::size_t kBodyBytes = 6 + sizeof(double) * 18;
constexpr std::size_t kAxisHeaderBytes = 8 + 8 + 4 + 1 + 24;
constexpr std::size_t kKnotBytes = sizeof(float) * 12;  // two directions, six channels
constexpr std::size_t kCrcBytes = 4;

std::size_t axis_bytes(std::size_t knots) {
  return kAxisHeaderBytes + kKnotBytes * knots + kCrcBytes;
}

std::size_t axis_count(const MachineDescription& machine) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < machine.body_count; ++k)
    n += machine.body[k].joint.moves() ? 1U : 0U;
  return n;
}

// Byte order is fixed by shifting, so that the image is the same on every target.
class Writer {
 public:
  explicit Writer(Span<std::uint8_t> bytes) : bytes_(bytes) {}

  void bits(std::uint64_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      bytes_[at_++] = static_cast<std::uint8_t>(value >> (8U * i));
  }
  void u8(std::uint8_t value) { bits(value, 1); }
  void u32(std::uint32_t value) { bits(value, 4); }
  void i64(std::int64_t value) { bits(static_cast<std::uint64_t>(value), 8); }
  void f32(float value) {
    std::uint32_t raw = 0;
    std::memcpy(&raw, &value, sizeof raw);
    bits(raw, 4);
  }
  void f64(double value) {
    std::uint64_t raw = 0;
    std::memcpy(&raw, &value, sizeof raw);
    bits(raw, 8);
  }
  template <class Array>
  void f64s(const Array& values) {
    for (const double v : values)
      f64(v);
  }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  Span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

// Reads zeros beyond the end and remembers that it did.
class Reader {
 public:
  explicit Reader(Span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t bits(std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t byte = at_ < bytes_.size() ? bytes_[at_] : 0U;
      value |= byte << (8U * i);
      ++at_;
    }
    return value;
  }
  std::uint8_t u8() { return static_cast<std::uint8_t>(bits(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(bits(4)); }
  std::int64_t i64() { return static_cast<std::int64_t>(bits(8)); }
  float f32() {
    const auto raw = static_cast<std::uint32_t>(bits(4));
    float value = 0.0F;
    std::memcpy(&value, &raw, sizeof value);
    return value;
  }
  double f64() {
    const std::uint64_t raw = bits(8);
    double value = 0.0;
    std::memcpy(&value, &raw, sizeof value);
    return value;
  }
  template <class Array>
  void f64s(Array& values) {
    for (auto& v : values)
      v = f64();
  }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  Span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void write_machine(Writer& w, const MachineDescription& m) {
  w.u8(m.work_body);
  w.u8(m.tool_body);
  w.u8(m.correcting_count);
  for (const std::uint8_t axis : m.correcting)
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

// Enumerations are range-checked here, everything else by MachineChain::build.
Status read_machine(Reader& r, std::size_t bodies, MachineDescription& m) {
  m = {};
  m.body_count = static_cast<std::uint8_t>(bodies);
  m.work_body = r.u8();
  m.tool_body = r.u8();
  m.correcting_count = r.u8();
  for (std::uint8_t& axis : m.correcting)
    axis = r.u8();
  r.f64s(m.tool_point);
  for (std::size_t k = 0; k < bodies; ++k) {
    Body& body = m.body[k];
    body.lower = r.u8();
    const std::uint8_t kind = r.u8();
    const std::uint8_t axis = r.u8();
    if (kind > 2 || axis > 2) {
      Where where;
      where.body = static_cast<int>(k) + 1;
      return refuse(Reason::bad_joint, where);
    }
    body.joint.kind = static_cast<JointKind>(kind);
    body.joint.axis = static_cast<Axis>(axis);
    body.joint.sign = static_cast<std::int8_t>(r.u8());
    body.joint.nc_axis = r.u8();
    body.joint.letter = static_cast<char>(r.u8());
    r.f64s(body.joint.offset);
    r.f64s(body.joint.orientation);
    r.f64s(body.constant_error);
  }
  for (const double value : m.tool_point) {
    if (!std::isfinite(value)) return refuse(Reason::not_finite);
  }
  return {};
}

Status read_axis(Reader& r, const Joint& joint, std::size_t capacity, Vec3& direction,
                 AxisTable& table) {
  table.q0 = r.i64();
  table.pitch = r.i64();
  table.knots = r.u32();
  table.periodic = r.u8() != 0;
  for (double& d : direction)
    d = r.f64();
  if (const Status s = check_knots(table, joint, capacity); !s.ok()) return s;
  Where where;
  where.axis = joint.letter;
  if (!direction.allFinite()) return refuse(Reason::not_finite, where);
  for (auto& column : table.value) {
    for (std::uint32_t i = 0; i < table.knots; ++i) {
      for (std::size_t c = 0; c < 6; ++c) {
        column[i][c] = r.f32();
      }
    }
  }
  static_cast<void>(r.u32());  // covered by the CRC of the whole image
  return check_values(table, joint);
}

// Which axis a damaged image was damaged in, as far as its intact parts still tell; '\0' when they
// do not.
char damaged_axis(Span<const std::uint8_t> image, std::size_t axes, std::size_t bodies) {
  std::size_t at = kHeaderBytes + kMachineBytes + kBodyBytes * bodies;
  if (bodies > kMaxBodies || axes > kMaxAxes || at > image.size()) return '\0';
  std::array<char, kMaxAxes> letter{};
  for (std::size_t k = 0; k < bodies; ++k) {
    const std::uint8_t* body = image.data() + kHeaderBytes + kMachineBytes + kBodyBytes * k;
    if (body[1] != 0 && body[4] < kMaxAxes) letter[body[4]] = static_cast<char>(body[5]);
  }
  for (std::size_t a = 0; a < axes; ++a) {
    if (image.size() - at < kAxisHeaderBytes) return '\0';
    Reader header({image.data() + at + 16, 4});
    const std::size_t knots = header.u32();
    if (knots > kTableKnots) return letter[a];
    const std::size_t size = axis_bytes(knots);
    if (image.size() - at < size) return letter[a];
    Reader stored({image.data() + at + size - kCrcBytes, kCrcBytes});
    if (stored.u32() != crc32({image.data() + at, size - kCrcBytes})) return letter[a];
    at += size;
  }
  return '\0';
}

}  // namespace

std::size_t image_size(const MachineTables& tables) {
  std::size_t bytes =
      kHeaderBytes + kMachineBytes + kBodyBytes * tables.machine.body_count + kCrcBytes;
  const std::size_t axes = axis_count(tables.machine);
  for (std::size_t a = 0; a < axes; ++a)
    bytes += axis_bytes(tables.axis[a].knots);
  return bytes;
}

std::size_t image_value_offset(const MachineTables& tables, std::size_t axis, std::size_t travel,
                               std::size_t knot, std::size_t channel) {
  std::size_t at = kHeaderBytes + kMachineBytes + kBodyBytes * tables.machine.body_count;
  for (std::size_t a = 0; a < axis; ++a)
    at += axis_bytes(tables.axis[a].knots);
  return at + kAxisHeaderBytes + 4 * (6 * (travel * tables.axis[axis].knots + knot) + channel);
}

Status encode_image(const MachineTables& tables, Span<std::uint8_t> out, std::size_t& written) {
  const std::size_t size = image_size(tables);
  if (out.size() < size) return refuse(Reason::image_truncated);
  const std::size_t axes = axis_count(tables.machine);
  Writer w(out);
  for (const std::uint8_t byte : kMagic)
    w.u8(byte);
  w.bits(kImageVersion, 2);
  w.u8(static_cast<std::uint8_t>(axes));
  w.u8(tables.machine.body_count);
  w.u32(static_cast<std::uint32_t>(size));
  w.u32(tables.provenance.machine_id);
  w.u32(tables.provenance.sequence);
  w.i64(tables.provenance.built_unix_s);
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
    for (const auto& column : table.value) {
      for (std::uint32_t i = 0; i < table.knots; ++i) {
        for (const float v : column[i])
          w.f32(v);
      }
    }
    w.u32(crc32({out.data() + start, w.at() - start}));
  }
  w.u32(crc32({out.data(), w.at()}));
  written = w.at();
  return {};
}

Status decode_image(Span<const std::uint8_t> image, std::size_t capacity, MachineTables& out) {
  Reader r(image);
  for (const std::uint8_t byte : kMagic) {
    if (r.u8() != byte) return refuse(Reason::bad_magic);
  }
  if (r.bits(2) != kImageVersion) return refuse(Reason::version_unknown);
  const std::size_t axes = r.u8();
  const std::size_t bodies = r.u8();
  const std::size_t size = r.u32();
  if (size != image.size() || size < kHeaderBytes + kMachineBytes + kCrcBytes)
    return refuse(Reason::image_truncated);
  Reader tail({image.data() + size - kCrcBytes, kCrcBytes});
  if (tail.u32() != crc32({image.data(), size - kCrcBytes})) {
    Where where;
    where.axis = damaged_axis({image.data(), size - kCrcBytes}, axes, bodies);
    return refuse(Reason::crc_mismatch, where);
  }

  out.provenance.machine_id = r.u32();
  out.provenance.sequence = r.u32();
  out.provenance.built_unix_s = r.i64();
  out.provenance.temperature_C = r.f32();
  for (char& c : out.provenance.stamp)
    c = static_cast<char>(r.u8());
  if (bodies > kMaxBodies) return refuse(Reason::too_many_bodies);
  if (const Status s = read_machine(r, bodies, out.machine); !s.ok()) return s;
  MachineChain chain;
  if (const Status s = MachineChain::build(out.machine, chain); !s.ok()) return s;
  if (axes != chain.axis_count()) return refuse(Reason::axes_mismatch);
  out.directions = zero_directions();
  for (std::size_t a = 0; a < axes; ++a) {
    if (const Status s = read_axis(r, chain.axis(a), capacity, out.directions[a], out.axis[a]);
        !s.ok())
      return s;
  }
  return r.at() + kCrcBytes == size ? Status{} : refuse(Reason::image_truncated);
}

}  // namespace volcomp
