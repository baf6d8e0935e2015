#pragma once
// Branches of a lower-body array, usable at compile time. Expects a description that
// MachineChain::build accepts.

#include <array>
#include <cstdint>

#include "comp/machine/machine_description.hpp"

namespace volcomp {

// Body indices (0-based) from base to tip.
struct BodyPath {
  std::array<std::uint8_t, kMaxBodies> body{};
  std::size_t count = 0;

  [[nodiscard]] constexpr const std::uint8_t* begin() const { return body.data(); }
  [[nodiscard]] constexpr const std::uint8_t* end() const { return body.data() + count; }
  constexpr void push(std::uint8_t value) { body[count++] = value; }
};

struct BranchPaths {
  BodyPath tool;
  BodyPath work;
};

// Body → root.
constexpr BodyPath path_to_root(const MachineDescription& description, std::uint8_t body_number) {
  BodyPath path;
  for (std::uint8_t k = body_number; k != 0 && path.count < kMaxBodies;
       k = description.body[k - 1U].lower) {
    path.push(static_cast<std::uint8_t>(k - 1U));
  }
  return path;
}

// How many bodies, counted from the root, two root-bound paths share.
constexpr std::size_t common_bodies(const BodyPath& a, const BodyPath& b) {
  std::size_t n = 0;
  while (n < a.count && n < b.count && a.body[a.count - 1 - n] == b.body[b.count - 1 - n])
    ++n;
  return n;
}

// Both branches beyond the last common body, base → tip.
constexpr BranchPaths branch_paths(const MachineDescription& description) {
  const BodyPath tool = path_to_root(description, description.tool_body);
  const BodyPath work = path_to_root(description, description.work_body);
  const std::size_t common = common_bodies(tool, work);
  BranchPaths paths;
  for (std::size_t i = tool.count - common; i > 0; --i)
    paths.tool.push(tool.body[i - 1]);
  for (std::size_t i = work.count - common; i > 0; --i)
    paths.work.push(work.body[i - 1]);
  return paths;
}

}  // namespace volcomp
