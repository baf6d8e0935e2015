#include "firmware/node/node_objects.hpp"

#include <cstddef>

#include "firmware/canopen/pdo.hpp"
#include "firmware/node/arrivals.hpp"
#include "firmware/node/object_handles.hpp"

namespace volcomp::node {
namespace {

namespace lines = canopen::object_lines;
using canopen::NamedEntry;

// As it is written, in the order of the indices; a part that this node does not have is left out.
struct Line {
  bool there = false;
  NamedEntry entry{};
};

constexpr std::size_t kProbe = offsetof(NodeObjects, probe);
constexpr std::size_t kFlank = kProbe + offsetof(ProbeObjects, flank);
constexpr std::size_t kStroke = offsetof(NodeObjects, stroke);
constexpr std::size_t kThermal = offsetof(NodeObjects, thermal);

constexpr std::array kLines{
#define LINE(there, index, sub, count, type, offset, use, range, name) \
  Line{there, lines::row<lines::type>(index, sub, count, offset, lines::use, lines::range, name)},
#define NODE(index, sub, count, type, member, use, value, range, name) \
  LINE(true, index, sub, count, type, offsetof(NodeObjects, member), use, range, name)
#define LATCH(index, sub, count, type, member, use, value, range, name) \
  LINE(kProbes, index, sub, count, type, offsetof(NodeObjects, member), use, range, name)
#define PROBE(index, sub, count, type, member, use, value, range, name) \
  LINE(kProbes, index, sub, count, type, kProbe + offsetof(ProbeObjects, member), use, range, name)
#define FLANK(index, sub, count, type, member, use, value, range, name) \
  LINE(kProbes, index, sub, count, type, kFlank + offsetof(FlankObjects, member), use, range, name)
#define STROKE(index, sub, count, type, member, use, value, range, name)                         \
  LINE(kWatchesStrokes, index, sub, count, type, kStroke + offsetof(StrokeObjects, member), use, \
       range, name)
#define THERMAL(index, sub, count, type, member, use, value, range, name)                         \
  LINE(kFollowsTemperature, index, sub, count, type, kThermal + offsetof(ThermalObjects, member), \
       use, range, name)
#define NODE_ROW(index, sub, count, type, member, which, use, range, name) \
  LINE(true, index, sub, count, type,                                      \
       offsetof(NodeObjects, member) + (which) * (count) * sizeof(lines::type), use, range, name)
#define STROKE_ROW(index, sub, count, type, member, which, use, range, name)                     \
  LINE(kWatchesStrokes, index, sub, count, type,                                                 \
       kStroke + offsetof(StrokeObjects, member) + (which) * (count) * sizeof(lines::type), use, \
       range, name)
#define LEARNED(index, sub, type, table, member, name)                               \
  LINE(kWatchesStrokes, index, sub, 1, type,                                         \
       kStroke + offsetof(StrokeObjects, learned) + (table) * sizeof(LearnedTable) + \
           offsetof(LearnedTable, member),                                           \
       read, any, name)
#define DOMAIN_LINE(there, index, sub, count, use, name) \
  Line{there, lines::domain(index, sub, count, lines::use, name)},
#define NODE_DOMAIN(index, sub, count, member, use, name) \
  DOMAIN_LINE(true, index, sub, count, use, name)
#define PROBE_DOMAIN(index, sub, count, member, use, name) \
  DOMAIN_LINE(kProbes, index, sub, count, use, name)
#define STROKE_DOMAIN(index, sub, count, member, use, name) \
  DOMAIN_LINE(kWatchesStrokes, index, sub, count, use, name)
#include "firmware/node/objects.def"
#undef LINE
#undef DOMAIN_LINE
};

constexpr bool in_order() {
  for (std::size_t i = 1; i < kLines.size(); ++i) {
    const NamedEntry& before = kLines[i - 1].entry;
    const NamedEntry& entry = kLines[i].entry;
    if (before.index > entry.index) return false;
    if (before.index == entry.index && before.last_sub >= entry.first_sub) return false;
  }
  return true;
}
static_assert(in_order(),
              "objects.def: lines stand in the order of index and sub-index, each once");

constexpr std::size_t count_own() {
  std::size_t count = 0;
  for (const Line& line : kLines)
    count += line.there ? 1U : 0U;
  return count;
}

constexpr std::array<NamedEntry, count_own()> take_own() {
  std::array<NamedEntry, count_own()> own{};
  std::size_t count = 0;
  for (const Line& line : kLines) {
    if (line.there) own[count++] = line.entry;
  }
  return own;
}

constexpr auto kOwn = take_own();
constexpr auto kNamed = canopen::with_communication(kOwn);

}  // namespace

NodeObjects default_objects() { return {}; }

canopen::Dictionary node_dictionary() {
  canopen::Dictionary dictionary = canopen::DictionaryOf<kNamed>::value;
  dictionary.arrival = arrival_of;
  return dictionary;
}

std::uint32_t arrival_of(canopen::ObjectId object) {
  const unsigned element = object.sub - 1U;  // axis or input
  switch (object.index) {
    case object::target.index:
      return bit(Arrival::kTarget + element);
    case object::drive_status.index:
      return bit(Arrival::kActual + element);
    case object::held_offset.index:
      return bit(Arrival::kHeld + element);
    case object::latched.index:
      return bit(Arrival::kLatched + element);
    case object::edge_count.index:
      return bit(Arrival::kCounted + element);
    case object::stroke::slot.index:
      return bit(Arrival::kProcessState);
    case object::thermal::reading.index:
      return bit(Arrival::kTemperature + element);
    default:
      return 0;
  }
}

Span<const NamedEntry> named_node_dictionary() { return kNamed; }

}  // namespace volcomp::node
