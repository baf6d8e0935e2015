// Any bytes as a measurement plan: accepted or refused with a UserError, and what is accepted has a
// value for everything and is solved or refused with a reason.
//
// A plan names files. They lie in a folder of its own: two machines, and a table of every kind of
// observation. Nothing else is opened: a text that could name another folder is passed over.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"

namespace {

using namespace volcomp::host;
namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) std::abort();
}

// A row at each place, with the readings given.
std::string table(const std::string& header, const std::string& readings) {
  std::string text = "X [mm],Y [mm],Z [mm]," + header + "\n";
  for (const char* const place :
       {"-250,-150,-200", "-100,-150,-200", "-250,-60,-200", "-250,-150,-80", "-120,-70,-90"})
    text += std::string(place) + "," + readings + "\n";
  return text;
}

// Five touches of each of three balls.
std::string touches() {
  std::string text = "setup,sphere,tip,X [mm],Y [mm],Z [mm]\n";
  const int centre[3][3] = {{-300, -200, -250}, {-200, -200, -250}, {-300, -100, -250}};
  const int side[5][3] = {{0, 0, 13}, {13, 0, 0}, {-13, 0, 0}, {0, 13, 0}, {0, -13, 0}};
  for (int ball = 0; ball < 3; ++ball)
    for (const auto& n : side) {
      text += "P," + std::to_string(ball) + ",S0";
      for (int k = 0; k < 3; ++k)
        text += "," + std::to_string(centre[ball][k] + n[k]);
      text += "\n";
    }
  return text;
}

// Gone at the end of the program.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("volcomp_fuzz_plan." + std::to_string(getpid()))) {
    fs::create_directory(path_);
    for (const char* const machine : {"xyfz", "trunnion"})
      fs::copy_file(bundled_machine(machine), path_ / (std::string(machine) + ".toml"),
                    fs::copy_options::overwrite_existing);
    write(path_ / "length.csv", table("tip,length [mm]", "S0,400"));
    write(path_ / "radial.csv", table("direction X,radial [um]", "+,1.5"));
    write(path_ / "displacement.csv", table("displacement [mm]", "0.001"));
    write(path_ / "rtest.csv", table("A [deg],C [deg],DX [um],DY [um],DZ [um]", "0,90,1,2,3"));
    write(path_ / "positions.csv", table("tip", "S0"));
    write(path_ / "touches.csv", touches());
    write(path_ / "runs.csv",
          "target [mm],run,direction,EXX [um],EYX [um],EZX [um],EAX [urad],EBX [urad],ECX [urad]\n"
          "-500,1,up,1,2,3,4,5,6\n-250,1,up,1,2,3,4,5,6\n0,1,up,1,2,3,4,5,6\n"
          "0,1,down,1,2,3,4,5,6\n-250,1,down,1,2,3,4,5,6\n-500,1,down,1,2,3,4,5,6\n");
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void check_complete(const identify::MeasurementPlan& plan) {
  if (plan.touched.size() != plan.problem.setups.size()) __builtin_trap();
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k) {
    const identify::SetUp& s = plan.problem.setups[k];
    const std::size_t readings = s.q.size() * s.components();
    if (s.d.size() != s.q.size() || s.sigma.size() != readings) __builtin_trap();
    if (!s.y.empty() && s.y.size() != readings) __builtin_trap();
    if (s.has_pose() && s.sphere.size() != s.q.size()) __builtin_trap();
    if (!s.stylus.empty() && s.stylus.size() != s.q.size()) __builtin_trap();
    if (!plan.touched[k].empty() && plan.touched[k].size() != s.q.size()) __builtin_trap();
    for (const double sigma : s.sigma)
      if (!(sigma > 0.0)) __builtin_trap();
  }
}

// Small enough to be looked at often.
bool is_small(const identify::Problem& problem) {
  constexpr std::size_t kMostCoefficients = 90;
  constexpr std::size_t kMostShared = 120;
  constexpr std::size_t kMostSetUps = 8;
  std::size_t coefficients = 0;
  for (const identify::AxisFunctions& f : problem.model.functions)
    coefficients += (f.segments > 0 ? f.segments + 3 : 0) * f.channels.size();
  std::size_t shared = 4 * problem.styli.size();
  for (const identify::Artefact& a : problem.artefacts)
    shared += 3 * a.spheres.size();
  return coefficients <= kMostCoefficients && shared <= kMostShared &&
         problem.setups.size() <= kMostSetUps;
}

void solve(const identify::MeasurementPlan& plan) {
  if (!identify::check_problem(plan.problem).ok() || !plan.has_readings()) return;
  const identify::Equations equations(plan.problem, true);
  const identify::Solution solution = identify::solve(equations, false);
  if (!identify::check_solution(solution).ok()) return;
  if (!solution.estimate.x.allFinite() || !std::isfinite(solution.chi2)) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  // An escape could become a separator.
  if (text.find_first_of("/\\") != std::string::npos) return 0;
  write(folder.path() / "plan.toml", text);
  try {
    const auto plan = identify::read_plan(folder.path() / "plan.toml");
    check_complete(plan);
    if (is_small(plan.problem)) solve(plan);
  } catch (const UserError&) {
    return 0;
  }
  return 0;
}
