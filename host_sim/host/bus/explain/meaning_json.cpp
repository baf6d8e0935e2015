#include "host_sim/host/bus/explain/meaning_json.hpp"

#include <array>

#include "host_sim/host/bus/explain/object_text.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

const char* kind_name(CodeKind kind) {
  static constexpr std::array kNames{"reason", "status_bit", "emergency", "verdict", "abort"};
  return kNames.at(static_cast<std::size_t>(kind));
}

json codes_json(const std::vector<CodeEntry>& codes) {
  json list = json::array();
  for (const CodeEntry& e : codes) {
    list.push_back({{"kind", kind_name(e.kind)},
                    {"number", e.number},
                    {"label", e.label},
                    {"name", e.name},
                    {"what", e.what},
                    {"why", e.why},
                    {"remedy", e.remedy}});
  }
  return list;
}

template <class Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

json object_json(const EdsObject& object) {
  json values = json::array();
  for (const EdsValue& v : object.values) {
    values.push_back({{"sub", v.sub},
                      {"name", v.name},
                      {"type", type_name(v.type)},
                      {"access", v.access},
                      {"low", or_null(v.low)},
                      {"high", or_null(v.high)},
                      {"default", or_null(v.value)}});
  }
  return {{"index", object.index},
          {"name", object.name},
          {"purpose", purpose_of(object)},
          {"values", values}};
}

}  // namespace

json meaning_json(const std::string& word, const Meaning& meaning) {
  json objects = json::array();
  for (const EdsObject& object : meaning.objects)
    objects.push_back(object_json(object));
  return {{"word", word}, {"codes", codes_json(meaning.codes)}, {"objects", objects}};
}

json catalogue_json() { return {{"codes", codes_json(code_catalogue())}}; }

}  // namespace volcomp::host
