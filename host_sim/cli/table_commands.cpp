// volcomp build-tables, volcomp machine check, volcomp list

#include <ctime>
#include <memory>

#include <fmt/format.h>

#include "comp/tables/image.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/commissioning/commission.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/data/whole_file.hpp"

namespace volcomp::sim {
namespace {

struct BuildArguments {
  std::string machine;
  std::vector<std::string> runs;
  std::string out;
  std::string model = "abbe_closed";
  std::string slope = "lsq";
  bool no_resampling = false;
  std::string stamp = "volcomp";
  double temperature_C = 20.0;
  std::size_t knots = kDefaultKnots;
};

void print_axis(const MachineFile& machine, const Commissioned& tables, std::size_t a) {
  const BuiltTable& b = *tables.built[a];
  const Iso230Figures& f = b.positioning;
  const double scale = machine.chain.axis(a).kind == JointKind::rotary ? 1e6 : 1e3;
  fmt::print(
      "{}  {} targets -> {} knots, {} reversal; ISO 230-2: A {:.2f} R {:.2f} E {:.2f} B {:.2f} M "
      "{:.2f} {}\n",
      machine.axes[a].letter, b.targets, tables.tables.axis[a].knots,
      b.reversal_known ? "known" : "unknown", scale * f.A, scale * f.R, scale * f.E, scale * f.B,
      scale * f.M, machine.chain.axis(a).kind == JointKind::rotary ? "urad" : "um");
}

int build_tables(const BuildArguments& arguments) {
  const MachineFile machine = read_machine_file(arguments.machine);
  std::vector<RunsFile> runs;
  for (const std::string& path : arguments.runs)
    runs.push_back(read_runs_file(path));
  CommissionOptions options;
  options.model = arguments.model == "naive"  ? ModelKind::naive
                  : arguments.model == "abbe" ? ModelKind::abbe
                                              : ModelKind::abbe_closed;
  options.slope = arguments.slope == "end" ? SlopeFit::end_points : SlopeFit::least_squares;
  options.allow_resampling = !arguments.no_resampling;
  options.knots = arguments.knots;
  const auto tables = commission(machine, runs, options);
  Provenance& provenance = tables->tables.provenance;
  provenance.built_unix_s = static_cast<std::int64_t>(std::time(nullptr));
  provenance.temperature_C = static_cast<float>(arguments.temperature_C);
  arguments.stamp.copy(provenance.stamp.data(), provenance.stamp.size());
  const std::vector<std::uint8_t> image = make_image(tables->tables);
  write_whole_file(arguments.out, {reinterpret_cast<const char*>(image.data()), image.size()});

  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    print_axis(machine, *tables, a);
  if (machine.squareness) {
    const XyfzSquareness& p = tables->parameters;
    fmt::print("squareness in the model: a_xy {:.2f} a_xz {:.2f} a_yz {:.2f} urad\n", 1e6 * p.a_xy,
               1e6 * p.a_xz, 1e6 * p.a_yz);
  }
  for (const std::string& warning : tables->warnings)
    fmt::print("warning: {}\n", warning);
  fmt::print("first-order run-time model within {:.1f} nm of the exact chain\n",
             tables->model_bound_nm);
  fmt::print("{}: {} bytes, machine {}, CRC-32 {:08X}\n", arguments.out, image.size(), machine.id,
             image_crc({image.data(), image.size()}));
  return 0;
}

// base-to-tip reading of a branch, for instance "bed - Y - X".
std::string branch_text(const MachineFile& machine, const BodyPath& path) {
  std::string text;
  for (const std::uint8_t body : path) {
    const Joint& joint = machine.chain.joint(body);
    text += joint.moves() ? fmt::format(" - {}", joint.letter)
                          : fmt::format(" - ({})", machine.body_names[body]);
  }
  return text;
}

int check_machine(const std::string& path) {
  const MachineFile m = read_machine_file(path);
  fmt::print("{}: {} (id {}), good\n", path, m.name, m.id);
  fmt::print("workpiece: base{}\ntool:      base{}\n", branch_text(m, m.chain.work()),
             branch_text(m, m.chain.tool()));
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    const AxisFile& axis = m.axes[a];
    const bool rotary = m.chain.axis(a).kind == JointKind::rotary;
    fmt::print("axis {}: {} {} to {} {}, {} targets, zero at {}\n", axis.letter,
               rotary ? "rotary" : "linear", axis.lo, axis.hi, rotary ? "rad" : "mm", axis.targets,
               axis.reference);
  }
  fmt::print("run-time model: {}\n",
             m.chain.has_rotary() ? "second-order recursion" : "first-order sum, folded");
  if (!m.squareness) fmt::print("no [squareness]: tables will hold no squareness\n");
  return 0;
}

}  // namespace

void add_build_tables_command(CLI::App& app, int& code) {
  CLI::App* build =
      app.add_subcommand("build-tables", "Build the table image of a machine from measured runs");
  auto a = std::make_shared<BuildArguments>();
  build->add_option("--machine", a->machine, "Machine file (TOML)")->required();
  build->add_option("--runs", a->runs, "Run files (CSV), one per axis")->required();
  build->add_option("--out", a->out, "Image file to write")->required();
  build->add_option("--model", a->model, "Error model")
      ->check(CLI::IsMember({"abbe_closed", "abbe", "naive"}))
      ->capture_default_str();
  build
      ->add_option("--slope", a->slope,
                   "Line removed from straightness: least squares or end points")
      ->check(CLI::IsMember({"lsq", "end"}))
      ->capture_default_str();
  build->add_flag("--no-resampling", a->no_resampling,
                  "Refuse targets that are not equally spaced");
  build
      ->add_option("--knots", a->knots,
                   "Most knots of a table: what the node has room for (M4F board: 64)")
      ->check(CLI::Range(std::size_t{2}, kDefaultKnots))
      ->capture_default_str();
  build->add_option("--temperature", a->temperature_C, "Temperature of the campaign, deg C")
      ->capture_default_str();
  build->add_option("--stamp", a->stamp, "Operator, up to 16 characters")->capture_default_str();
  build->callback([a, &code] { code = build_tables(*a); });
}

void add_machine_command(CLI::App& app, int& code) {
  CLI::App* machine = app.add_subcommand("machine", "Machine files");
  machine->require_subcommand(1);
  CLI::App* check =
      machine->add_subcommand("check", "Read a machine file and say what it describes");
  auto path = std::make_shared<std::string>();
  check->add_option("FILE", *path, "Machine file (TOML)")->required();
  check->callback([path, &code] { code = check_machine(*path); });
}

void add_list_command(CLI::App& app, int& code) {
  CLI::App* list =
      app.add_subcommand("list", "List scenarios and the machines that come with the program");
  list->callback([&code] {
    fmt::print(
        "scenarios:\n  xyfz    three-axis machine, Abbe-optimised volumetric model, 21 errors "
        "(seed 001)\n  l300g   gear grinder that measures, involute gears, 24 errors (seed 000)\n");
    fmt::print("machines:\n  {}\n  {}\n", bundled_machine("xyfz").string(),
               bundled_machine("l300g").string());
    code = 0;
  });
}

}  // namespace volcomp::sim
