#include "tests/cases/case_file.hpp"

#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>

namespace volcomp::cases {
namespace {

// Walks a wanted value beside what came out and collects every difference.
class Comparison {
 public:
  Comparison(const json& tolerances, std::string id, std::vector<Failure>& failures)
      : tolerances_(tolerances), id_(std::move(id)), failures_(failures) {}

  void walk(const json& want, const json& got, const std::string& path) {
    if (want.is_object()) return walk_object(want, got, path);
    if (want.is_array()) return walk_array(want, got, path);
    if (want == "nan") {
      const bool missing = got.is_null() || (got.is_number() && std::isnan(got.get<double>()));
      if (!missing && got != "nan") report(path, want, got, "");
    } else if (want.is_number()) {
      walk_number(want, got, path);
    } else if (want != got) {
      report(path, want, got, "");
    }
  }

 private:
  void walk_object(const json& want, const json& got, const std::string& path) {
    if (!got.is_object()) return report(path, want, got, "");
    for (const auto& [key, value] : want.items()) {
      const std::string inner = path.empty() ? key : path + "." + key;
      if (got.contains(key)) {
        walk(value, got[key], inner);
      } else {
        report(inner, value, "missing", "");
      }
    }
    for (const auto& [key, value] : got.items()) {
      if (!want.contains(key)) report(path + "." + key, "absent", value, "");
    }
  }

  void walk_array(const json& want, const json& got, const std::string& path) {
    if (!got.is_array() || got.size() != want.size()) return report(path, want, got, "");
    for (std::size_t i = 0; i < want.size(); ++i)
      walk(want[i], got[i], path);
  }

  void walk_number(const json& want, const json& got, const std::string& path) {
    if (!got.is_number()) return report(path, want, got, "");
    const double tolerance = tolerance_of(path);
    const double difference = std::abs(got.get<double>() - want.get<double>());
    if (!(difference <= tolerance)) report(path, want, got, fmt::format("{}", tolerance));
  }

  // The entry of the path or of its longest leading part; none means exact.
  [[nodiscard]] double tolerance_of(std::string path) const {
    for (;;) {
      if (tolerances_.contains(path)) return tolerances_[path].get<double>();
      const std::size_t dot = path.rfind('.');
      if (dot == std::string::npos) return 0.0;
      path.resize(dot);
    }
  }

  void report(const std::string& path, const json& want, const json& got,
              const std::string& tolerance) {
    const auto shorten = [](const json& value) {
      const std::string text = value.dump();
      return text.size() > 120 ? text.substr(0, 117) + "..." : text;
    };
    std::string text = fmt::format("{}: wanted {}, got {}", path, shorten(want), shorten(got));
    if (!tolerance.empty()) text += ", tolerance " + tolerance;
    failures_.push_back({id_, text});
  }

  const json& tolerances_;
  std::string id_;
  std::vector<Failure>& failures_;
};

json where_to_json(const Where& where) {
  json j = json::object();
  if (where.axis != '\0') j["axis"] = std::string(1, where.axis);
  if (where.direction != nullptr) j["direction"] = where.direction;
  if (where.field != nullptr) j["field"] = where.field;
  if (where.run >= 0) j["run"] = where.run;
  if (where.target >= 0) j["target"] = where.target;
  if (where.channel >= 0) j["channel"] = where.channel;
  if (where.index >= 0) j["index"] = where.index;
  if (where.body >= 0) j["body"] = where.body;
  if (where.count >= 0) j["n"] = j["rank"] = j["count"] = where.count;
  if (where.has_deviation) j["deviation"] = where.deviation;
  return j;
}

void check_refusal(const json& c, const Refused& refused, std::vector<Failure>& failures) {
  const Status& status = refused.status;
  const std::string id = c["id"];
  const std::string reason = code(status.reason);
  if (!c.contains("reason")) {
    failures.push_back({id, fmt::format("refused with {}", reason)});
    return;
  }
  if (c["reason"] != reason) {
    failures.push_back({id, fmt::format("wanted refusal {}, got {}", c["reason"].dump(), reason)});
    return;
  }
  if (!c.contains("out_where")) return;
  json where = where_to_json(status.where);
  where.update(refused.more);
  if (status.reason == Reason::unknown_plane) where["plane"] = where["field"];
  for (const auto& [key, value] : c["out_where"].items()) {
    const json got = where.contains(key) ? where[key] : json(nullptr);
    const bool near = value.is_number_float() && got.is_number() &&
                      std::abs(value.get<double>() - got.get<double>()) <= 1e-9;
    if (got == value || near) continue;
    failures.push_back(
        {id, fmt::format("out_where.{}: wanted {}, got {}", key, value.dump(), got.dump())});
  }
}

std::vector<Failure> run_case(const json& c, const Handlers& handlers) {
  std::vector<Failure> failures;
  const std::string id = c.at("id");
  const auto handler = handlers.find(c.at("kind").get<std::string>());
  if (handler == handlers.end()) return {{id, "unknown kind " + c["kind"].dump()}};
  try {
    const json out = handler->second(c.at("in"));
    if (c.contains("reason")) return {{id, "wanted refusal " + c["reason"].dump() + ", accepted"}};
    const json tolerances = c.contains("tol") ? c["tol"] : json::object();
    Comparison(tolerances, id, failures).walk(c.at("out"), out, "");
  } catch (const Refused& refused) {
    check_refusal(c, refused, failures);
  } catch (const std::exception& e) {
    failures.push_back({id, std::string("cannot be run: ") + e.what()});
  }
  return failures;
}

}  // namespace

void run_file(const std::string& path, const Handlers& handlers, Tally& tally) {
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error("cannot open " + path);
  const json file = json::parse(stream);
  if (!file.is_object() || file.value("format", "") != "volcomp-cases-1") {
    throw std::runtime_error(path + " is not in the format volcomp-cases-1");
  }
  for (const json& c : file.at("cases")) {
    const std::vector<Failure> failures = run_case(c, handlers);
    if (failures.empty()) ++tally.passed;
    tally.failed.insert(tally.failed.end(), failures.begin(), failures.end());
  }
}

double number(const json& value) {
  if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (value == "inf") return std::numeric_limits<double>::infinity();
  if (value == "-inf") return -std::numeric_limits<double>::infinity();
  return value.get<double>();
}

std::vector<double> numbers(const json& values) {
  std::vector<double> v;
  for (const json& value : values)
    v.push_back(number(value));
  return v;
}

Vec3 vector3(const json& value) {
  return {number(value.at(0)), number(value.at(1)), number(value.at(2))};
}

std::array<double, 3> array3(const json& value) {
  return {number(value.at(0)), number(value.at(1)), number(value.at(2))};
}

ErrorMotion six(const json& value) {
  ErrorMotion e;
  for (Eigen::Index i = 0; i < 6; ++i)
    e(i) = number(value.at(static_cast<std::size_t>(i)));
  return e;
}

json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json to_json(const ErrorMotion& v) { return {v(0), v(1), v(2), v(3), v(4), v(5)}; }

}  // namespace volcomp::cases
