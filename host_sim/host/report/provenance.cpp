#include "host_sim/host/report/provenance.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "host_sim/host/io/version.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

std::string version() {
  const std::string revision = source_revision();
  return revision.empty() ? kVersion : fmt::format("{}, revision {}", kVersion, revision);
}

}  // namespace

void add_origin(Origins& origins, const std::string& what, const std::string& path) {
  if (std::filesystem::is_regular_file(path)) {
    origins.inputs.push_back(hashed_file(what, path));
  } else {
    origins.settings.emplace_back(what, path == "-" ? "standard input" : path);
  }
}

json provenance(const RunContext& run, const Origins& origins) {
  json rows = json::array();
  const auto add = [&rows](const std::string& name, const std::string& value) {
    rows.push_back(json::array({name, value}));
  };
  const auto add_all = [&add](const char* name, const std::vector<std::string>& values) {
    for (const std::string& value : values)
      add(name, value);
  };
  add("data", origins.data);
  add("command", run.command);
  add("version", version());
  if (!run.transport.empty()) add("transport", run.transport);
  for (const auto& [name, value] : origins.settings)
    add(name, value);
  json inputs = json::array();
  for (const HashedInput& file : origins.inputs) {
    add(file.what, fmt::format("{}, {} bytes, SHA-256 {}", file.name, file.bytes, file.sha256));
    inputs.push_back(
        {{"what", file.what}, {"name", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
  }
  add_all("instruments", origins.instruments);
  add_all("tuned", origins.tuned);
  add_all("chosen by hand", origins.chosen);
  add_all("neither tuned nor chosen", origins.untouched);
  add_all("warning", origins.warnings);
  return {{"rows", rows}, {"inputs", inputs}};
}

}  // namespace volcomp::host
