#pragma once
// Where the figures of a report come from: the same lines in the same order for every scenario.

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::host {

struct Origins {
  std::string data = "simulated: no machine and no gear was measured";  // or where it is from
  std::vector<std::pair<std::string, std::string>> settings;            // and seeds
  std::vector<HashedInput> inputs;
  std::vector<std::string> instruments;
  std::vector<std::string> tuned;      // found by the program so that a given figure comes out
  std::vector<std::string> chosen;     // by hand
  std::vector<std::string> untouched;  // neither
  std::vector<std::string> warnings;
};

// What was read from this path: a file with its hash; what came through a pipe, which gives it only
// once, or a name that is no file, with its name alone. Throws UserError as hashed_file.
void add_origin(Origins& origins, const std::string& what, const std::string& path);

// "rows" for readers, "inputs" for programs.
[[nodiscard]] nlohmann::json provenance(const RunContext& run, const Origins& origins);

}  // namespace volcomp::host
