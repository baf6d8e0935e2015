// The reading half: what a node does with an image. Nothing is copied but the machine description.

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"
#include "comp/machine/machine_limits.hpp"
#include "comp/tables/image.hpp"
#include "comp/tables/image_layout.hpp"
#include "comp/tables/thermal_check.hpp"

namespace volcomp {
namespace {

using namespace image_layout;
using Bytes = Span<const std::uint8_t>;

// Refuses without a place. Own function: each refusal written out takes 100 bytes of flash.
[[gnu::noinline]] Status refuse_whole(Reason reason) { return refuse(reason); }

Bytes from(Bytes bytes, std::size_t at) {
  return at < bytes.size() ? Bytes{bytes.data() + at, bytes.size() - at} : Bytes{};
}

// '\0' for a byte that names no axis.
char letter_of(std::uint8_t byte) {
  return byte >= 'A' && byte <= 'Z' ? static_cast<char>(byte) : '\0';
}

// Axis in which a damaged image is damaged, as far as its intact parts show it; '\0' when they do
// not.
char damaged_axis(Bytes image, std::size_t axes, std::size_t bodies) {
  std::size_t at = first_axis(bodies);
  if (bodies > kMaxBodies || axes > kMaxAxes || at > image.size()) return '\0';
  std::array<char, kMaxAxes> letter{};
  for (std::size_t k = 0; k < bodies; ++k) {
    const std::uint8_t* body = image.data() + first_axis(k);
    if (body[1] != 0 && body[4] < kMaxAxes) letter[body[4]] = letter_of(body[5]);
  }
  for (std::size_t a = 0; a < axes; ++a) {
    if (image.size() - at < kAxisHeaderBytes) return '\0';
    const std::size_t knots = load_u32(image.data() + at + 16);
    if (knots > kTableKnots) return letter[a];
    const std::size_t size = axis_bytes(knots);
    if (image.size() - at < size) return letter[a];
    const std::uint8_t* const axis = image.data() + at;
    if (load_u32(axis + size - kCrcBytes) != crc32c({axis, size - kCrcBytes})) return letter[a];
    at += size;
  }
  return '\0';
}

// Checks of the whole: bad_magic, version_unknown, image_truncated, crc_mismatch.
Status check_envelope(Bytes image) {
  LittleEndianReader r(image);
  for (const std::uint8_t byte : kMagic) {
    if (r.u8() != byte) return refuse_whole(Reason::bad_magic);
  }
  if (r.bits(2) != kImageVersion) return refuse_whole(Reason::version_unknown);
  const std::size_t axes = r.u8();
  const std::size_t bodies = r.u8();
  const std::size_t size = r.u32();
  if (size != image.size() || size < first_axis(0) + kCrcBytes)
    return refuse_whole(Reason::image_truncated);
  const Bytes covered{image.data(), size - kCrcBytes};
  if (load_u32(covered.end()) == crc32(covered)) return {};
  Where where;
  where.axis = damaged_axis(covered, axes, bodies);
  return refuse(Reason::crc_mismatch, where);
}

Provenance read_provenance(Bytes image) {
  LittleEndianReader r(from(image, kProvenanceAt));
  Provenance p;
  p.machine_id = r.u32();
  p.sequence = r.u32();
  p.built_unix_s = r.i64();
  p.expires_unix_s = r.i64();
  p.temperature_C = r.f32();
  for (char& c : p.stamp)
    c = static_cast<char>(r.u8());
  return p;
}

Status read_body(LittleEndianReader& r, int number, Body& body) {
  body = {};
  body.lower = r.u8();
  const std::uint8_t kind = r.u8();
  const std::uint8_t axis = r.u8();
  body.joint.kind = static_cast<JointKind>(kind);
  body.joint.axis = static_cast<Axis>(axis);
  body.joint.sign = static_cast<std::int8_t>(r.u8());
  body.joint.nc_axis = r.u8();
  body.joint.letter = letter_of(r.u8());
  Where where;
  where.body = number;
  if (kind > 2 || axis > 2 || (body.joint.moves() && body.joint.letter == '\0'))
    return refuse(Reason::bad_joint, where);
  r.f64s(body.joint.offset);
  r.f64s(body.joint.orientation);
  r.f64s(body.constant_error);
  const double* const error = body.constant_error.data();
  Reason reason = check_numbers(error, 3, kMaxConstantError_mm);
  if (reason == Reason::ok) reason = check_numbers(error + 3, 3, kMaxConstantError_rad);
  return reason == Reason::ok ? Status{} : refuse(reason, where);
}

// Checks one axis at `at` and advances `at` past it.
Status check_axis(Bytes image, std::size_t capacity, std::size_t axis, std::size_t& at,
                  TablesView& out) {
  const Joint& joint = out.chain.axis(axis);
  Vec3& direction = out.directions[axis];
  AxisExpansion& expansion = out.expansion[axis];
  LittleEndianReader r(from(image, at));
  TableGrid grid;
  grid.q0 = r.i64();
  grid.pitch = r.i64();
  grid.knots = r.u32();
  grid.periodic = r.u8() != 0;
  for (double& d : direction)
    d = r.f64();
  expansion.per_K = r.f32();
  expansion.fixed_mm = r.f32();
  expansion.input = r.u8();
  if (const Status s = check_knots(grid, joint, capacity); !s.ok()) return s;
  Where where;
  where.axis = joint.letter;
  const Reason straight = check_numbers(direction.data(), 3, kMaxDirection_rad);
  if (straight != Reason::ok) return refuse(straight, where);
  if (!usable(expansion, joint)) return refuse(Reason::bad_thermal, where);
  const std::size_t size =
      axis_bytes(grid.knots);  // its own CRC is covered by the one of the whole
  if (from(image, at).size() < size) return refuse(Reason::image_truncated, where);
  out.axis[axis] = {grid, image.data() + at + kAxisHeaderBytes};
  at += size;
  return check_values(out.axis[axis], joint);
}

}  // namespace

// Enumerations are range-checked here, everything else by MachineChain.
Status read_machine(Span<const std::uint8_t> image, MachineDescription& out) {
  const std::size_t bodies = image[kBodiesAt];
  if (bodies > kMaxBodies) return refuse_whole(Reason::too_many_bodies);
  LittleEndianReader r(from(image, kHeaderBytes));
  out.body_count = static_cast<std::uint8_t>(bodies);
  out.work_body = r.u8();
  out.tool_body = r.u8();
  out.correcting_count = r.u8();
  // By index: of two loops alike GCC 12 makes one at -O3 and warns that it leaves the first array.
  for (std::size_t i = 0; i < kMaxCorrecting; ++i)
    out.correcting[i] = r.u8();
  out.orienting_count = r.u8();
  for (std::uint8_t& axis : out.orienting)
    axis = r.u8();
  r.f64s(out.tool_point);
  for (std::size_t k = 0; k < bodies; ++k) {
    if (const Status s = read_body(r, static_cast<int>(k) + 1, out.body[k]); !s.ok()) return s;
  }
  return {};
}

Status check_image(Span<const std::uint8_t> image, std::size_t capacity, TablesView& out) {
  if (const Status s = check_envelope(image); !s.ok()) return s;
  out.provenance = read_provenance(image);
  if (!usable(out.provenance)) return refuse_whole(Reason::bad_thermal);
  if (const Status s = read_machine(image, out.chain.draft()); !s.ok()) return s;
  if (const Status s = out.chain.complete(); !s.ok()) return s;
  const std::size_t axes = out.chain.axis_count();
  if (image[kAxesAt] != axes) return refuse_whole(Reason::axes_mismatch);
  std::size_t at = first_axis(image[kBodiesAt]);
  for (std::size_t a = 0; a < axes; ++a) {
    if (const Status s = check_axis(image, capacity, a, at, out); !s.ok()) return s;
  }
  for (std::size_t a = axes; a < kMaxAxes; ++a) {
    out.directions[a].setZero();
    out.expansion[a] = {};
  }
  out.strain = {};
  return at + kCrcBytes == image.size() ? Status{} : refuse_whole(Reason::image_truncated);
}

}  // namespace volcomp
