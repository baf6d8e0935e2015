#pragma once
// The reference-case format `volcomp-cases-1`: reading, comparing, refusing.

#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp::cases {

using nlohmann::json;

// Thrown by a handler when the library refused the input.
struct Refused : std::runtime_error {
  explicit Refused(const Status& s, json where = json::object())
      : std::runtime_error(code(s.reason)), status(s), more(std::move(where)) {}
  Status status;
  json more;  // of the place, what a status cannot name
};

inline void require(const Status& status) {
  if (!status.ok()) throw Refused(status);
}

// Computes the `out` of a case from its `in`.
using Handler = std::function<json(const json& in)>;
using Handlers = std::map<std::string, Handler>;

// One difference between what was wanted and what came out.
struct Failure {
  std::string id;
  std::string text;
};

struct Tally {
  int passed = 0;
  std::vector<Failure> failed;
};

// Runs every case of a file; throws std::runtime_error if the file itself is unusable.
void run_file(const std::string& path, const Handlers& handlers, Tally& tally);

inline constexpr double kUm = 1e-3;                      // mm
inline constexpr double kDegree = 0.017453292519943295;  // rad

// Numbers may be the strings "nan", "inf", "-inf".
[[nodiscard]] double number(const json& value);
[[nodiscard]] std::vector<double> numbers(const json& values);
[[nodiscard]] Vec3 vector3(const json& value);
[[nodiscard]] std::array<double, 3> array3(const json& value);
[[nodiscard]] ErrorMotion six(const json& value);
[[nodiscard]] json to_json(const Vec3& v);
[[nodiscard]] json to_json(const ErrorMotion& v);

}  // namespace volcomp::cases
