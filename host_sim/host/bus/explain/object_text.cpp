#include "host_sim/host/bus/explain/object_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "firmware/node/object_handles.hpp"

namespace volcomp::host {
namespace {

using canopen::DataType;

std::string range_of(const EdsValue& v) {
  if (!v.low || !v.high) return "";
  return fmt::format("{} … {}", *v.low, *v.high);
}

std::string without_number(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  const bool numbered = end != std::string::npos && end + 1 < name.size() && name[end] == ' ';
  return numbered ? name.substr(0, end) : name;
}

// "Target position (axis 3)" and "Offset in force 3" are one line of the table.
std::string common_name(const EdsValue& v) {
  const std::size_t bracket = v.name.rfind(" (");
  const bool numbered =
      bracket != std::string::npos && v.name.back() == ')' &&
      (v.name.compare(bracket, 7, " (axis ") == 0 || v.name.compare(bracket, 6, " (bit ") == 0);
  return numbered ? v.name.substr(0, bracket) : without_number(v.name);
}

// Whether the lines of two values would be the same.
bool alike(const EdsValue& a, const EdsValue& b) {
  return common_name(a) == common_name(b) && a.type == b.type && a.access == b.access &&
         a.low == b.low && a.high == b.high;
}

struct Line {
  const EdsValue* first;
  const EdsValue* last;
  bool same_default;

  [[nodiscard]] std::string name() const {
    return first == last ? first->name : common_name(*first);
  }
};

std::vector<Line> lines_of(const EdsObject& object) {
  std::vector<Line> lines;
  for (const EdsValue& v : object.values) {
    if (!lines.empty() && alike(*lines.back().first, v)) {
      lines.back().last = &v;
      lines.back().same_default = lines.back().same_default && lines.back().first->value == v.value;
    } else {
      lines.push_back({&v, &v, true});
    }
  }
  return lines;
}

std::string subs_of(const Line& l) {
  return l.first == l.last ? fmt::format(":{:02X}", l.first->sub)
                           : fmt::format(":{:02X} … :{:02X}", l.first->sub, l.last->sub);
}

std::string default_of(const Line& l) {
  return l.same_default ? l.first->value.value_or("") : "by sub-index";
}

bool differ_by_a_number(const EdsObject& a, const EdsObject& b) {
  if (purpose(a.index) == nullptr || purpose(a.index) != purpose(b.index)) return false;
  if (a.values.size() != b.values.size()) return false;
  const bool same_name =
      without_number(a.name) == without_number(b.name) || a.index >= node::object::began_0.index;
  return same_name && std::equal(a.values.begin(), a.values.end(), b.values.begin(),
                                 [](const EdsValue& x, const EdsValue& y) {
                                   return x.sub == y.sub && x.type == y.type &&
                                          x.access == y.access;
                                 });
}

std::string heading(const std::vector<EdsObject>& group) {
  const EdsObject& first = group.front();
  if (group.size() == 1) return fmt::format("{:04X}h {}", first.index, first.name);
  return fmt::format("{:04X}h … {:04X}h {}", first.index, group.back().index,
                     without_number(first.name));
}

}  // namespace

const char* type_name(DataType type) {
  switch (type) {
    case DataType::boolean:
      return "boolean";
    case DataType::integer8:
      return "i8";
    case DataType::integer16:
      return "i16";
    case DataType::integer32:
      return "i32";
    case DataType::integer64:
      return "i64";
    case DataType::unsigned8:
      return "u8";
    case DataType::unsigned16:
      return "u16";
    case DataType::unsigned32:
      return "u32";
    case DataType::unsigned64:
      return "u64";
    case DataType::real32:
      return "float";
    case DataType::real64:
      return "double";
    case DataType::visible_string:
      return "text";
    case DataType::domain:
      return "block";
  }
  return "";
}

const char* purpose_of(const EdsObject& object) {
  const char* const text = purpose(object.index);
  return text == nullptr ? "" : text;
}

std::vector<std::vector<EdsObject>> objects_alike() {
  std::vector<std::vector<EdsObject>> groups;
  for (const EdsObject& object : node_eds_objects()) {
    const bool joins = !groups.empty() && differ_by_a_number(groups.back().back(), object);
    if (!joins) groups.emplace_back();
    groups.back().push_back(object);
  }
  return groups;
}

std::string object_section(const std::vector<EdsObject>& group) {
  std::string text = fmt::format("\n## {}\n\n{}\n\n", heading(group), purpose_of(group.front()));
  text += "| sub | name | type | access | range | default |\n|---|---|---|---|---|---|\n";
  for (const Line& l : lines_of(group.front())) {
    if (l.first->sub == 0 && group.front().values.size() > 1 && l.first->access == "const")
      continue;
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", subs_of(l), l.name(),
                        type_name(l.first->type), l.first->access, range_of(*l.first),
                        group.size() > 1 && l.first->sub == 1 ? "by object" : default_of(l));
  }
  return text;
}

std::string object_text(const EdsObject& object) {
  std::string text =
      fmt::format("Object {:04X}h: {}\n  {}\n", object.index, object.name, purpose_of(object));
  for (const Line& l : lines_of(object)) {
    std::string line = fmt::format("  {:<12} {:<7} {:<5} {}", subs_of(l), type_name(l.first->type),
                                   l.first->access, l.name());
    if (const std::string range = range_of(*l.first); !range.empty())
      line += fmt::format(" [{}]", range);
    if (const std::string usual = default_of(l); !usual.empty())
      line += fmt::format(", default {}", usual);
    text += line + '\n';
  }
  return text;
}

}  // namespace volcomp::host
