#include "host_sim/host/io/user_error.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

namespace volcomp::host {
namespace {

std::vector<std::string> places(const Where& w) {
  std::vector<std::string> parts;
  if (w.axis != '\0') parts.push_back(fmt::format("axis {}", w.axis));
  if (w.field != nullptr) parts.push_back(fmt::format("'{}'", w.field));
  if (w.body >= 0) parts.push_back(fmt::format("body {}", w.body));
  if (w.direction != nullptr) parts.push_back(fmt::format("direction {}", w.direction));
  if (w.run >= 0) parts.push_back(fmt::format("run {}", w.run + 1));
  if (w.target >= 0) parts.push_back(fmt::format("target {}", w.target + 1));
  if (w.index >= 0) parts.push_back(fmt::format("entry {}", w.index + 1));
  if (w.channel >= 0)
    parts.push_back(
        w.axis == '\0'
            ? fmt::format("channel {}", kChannels.at(static_cast<std::size_t>(w.channel)))
            : fmt::format("{}{}", kChannels.at(static_cast<std::size_t>(w.channel)), w.axis));
  if (w.count >= 0) parts.push_back(fmt::format("{} found", w.count));
  if (w.has_value) parts.push_back(fmt::format("value {:.6g}", w.value));
  if (w.has_deviation) parts.push_back(fmt::format("off by {:.6g}", w.deviation));
  return parts;
}

}  // namespace

std::string describe(const Status& status) {
  const std::vector<std::string> parts = places(status.where);
  const std::string place = parts.empty() ? "" : fmt::format("{}: ", fmt::join(parts, ", "));
  return fmt::format("{}{} [{}]", place, sentence(status.reason), code(status.reason));
}

void require(const Status& status, const std::string& subject) {
  if (!status.ok()) throw UserError(subject + ": " + describe(status));
}

}  // namespace volcomp::host
