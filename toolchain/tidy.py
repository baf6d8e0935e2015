#!/usr/bin/env python3
"""Runs clang-tidy over comp, hal, firmware and host_sim with the flags of a finished build; any finding fails.

    toolchain/tidy.py [BUILD_FOLDER]   default build/host

The build may compile several sources at once; their own flags are those of BUILD_FOLDER/tidy, configured without.
A header that no source of these folders includes is checked through a source that includes only it. A file
that was clean is checked again only after it, a header of ours that it includes, its flags, .clang-tidy or
clang-tidy itself has changed; delete BUILD_FOLDER/tidy to check everything again. The path-sensitive analyzer
looks at the code of the target only: programs of the host meet the sanitizers in every test. Sources are
checked several at a time, as the build compiles them; those that do not compile together with clang are
checked apart. The price: an unused using-declaration is not seen there. The plugin own_code.cpp,
compiled here, keeps the checks out of the headers of others, where nothing is reported.

    toolchain/tidy.py --self-test      with the plugin each of a few planted faults is found, with it and without alike
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

FOLDERS = ("comp", "hal", "firmware", "host_sim")
ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIG = ROOT / ".clang-tidy"
AT_A_TIME = 4  # of those that the build compiles alone
PLUGIN_SOURCE = ROOT / "toolchain/own_code.cpp"
# Of another compiler; without precompiled headers, too, a file has to include what it uses.
OF_GCC = re.compile(r" -Winvalid-pch| -include \S+/cmake_pch\.hxx")


class Failure(Exception):
    """One plain sentence for the user."""


def is_ours(path):
    return any(ROOT / folder in path.parents for folder in FOLDERS)


def is_analyzed(path):
    return ROOT / "host_sim" not in path.parents


def configure_apart(build):
    """The folder with compile_commands.json of every source by itself, configured like the build."""
    if not (build / "CMakeCache.txt").exists():
        raise Failure(f"{build} is not configured: build first.")
    folder = build / "tidy"
    run = subprocess.run(["cmake", "--preset", "host", "-B", str(folder), "-DVOLCOMP_TOGETHER=OFF"], cwd=ROOT,
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"{folder} cannot be configured:\n{run.stdout}{run.stderr}")
    return folder


def read_entries(folder):
    """Source -> its entry in compile_commands.json."""
    database = folder / "compile_commands.json"
    entries = {}
    for entry in json.loads(database.read_text()):
        source = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if is_ours(source):
            entries[source] = dict(entry, command=OF_GCC.sub("", entry["command"]))
    if not entries:
        raise Failure(f"{database} names no source of {', '.join(FOLDERS)}.")
    return entries


def read_includes(build):
    """Source, or several at once -> the files of ours that it includes, as the build has noted them."""
    listing = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True, check=True)
    includes = {}
    for block in listing.stdout.split("\n\n"):
        paths = [pathlib.Path(os.path.normpath(build / line.strip()))
                 for line in block.splitlines() if line.startswith(" ")]
        if paths and block.startswith(FOLDERS):
            includes.setdefault(paths[0], set()).update(p for p in paths[1:] if ROOT in p.parents)
    return includes


def wrap_headers(headers, entries, folder):
    """A source with a single #include for each header, compiled like a source of the same top folder."""
    wrapped = {}
    for header in headers:
        name = header.relative_to(ROOT)
        like = next((s for s in sorted(entries) if s.relative_to(ROOT).parts[0] == name.parts[0]), None)
        if like is None:
            continue
        wrapper = folder / ("_".join(name.parts) + ".cpp")
        wrapper.write_text(f'#include "{name}"  // IWYU pragma: keep\n')
        entry = dict(entries[like])
        entry["command"] = entry["command"].replace(entry["file"], str(wrapper))
        entry["file"] = str(wrapper)
        wrapped[wrapper] = (header, entry)
    return wrapped


class Task:
    """One run of clang-tidy over `source`, which is or includes those it is about."""

    def __init__(self, source, about, entry, files):
        self.source = source
        self.about = about
        self.entry = entry
        self.files = files  # a change of one of them is a reason to check again

    def name(self):
        first, more = self.about[0].relative_to(ROOT), len(self.about) - 1
        return f"{first} and {more} more" if more else str(first)


def read_batches(build):
    """The sources that the build compiles at once, as the unity files of CMake name them; others alone."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["directory"], entry["file"])
        if source.parent.name == "Unity":
            yield [pathlib.Path(name) for name in re.findall(r'#include "(.+)"', source.read_text())]
        else:
            yield [source]


def tasks_of_sources(build, entries, includes, everything, folder):
    waiting, alone = dict(entries), {}  # a source may be compiled for two targets
    for batch in read_batches(build):
        group = [source.resolve() for source in batch if source.resolve() in waiting]
        for source in group:
            del waiting[source]
        if len(group) > 1:
            yield task_of(group, entries, includes, everything, folder)
        elif group:
            command = entries[group[0]]["command"]
            target = re.search(r" -o (\S+?\.dir)/", command)
            alone.setdefault((re.sub(r" -(o|c) \S+", "", command), target and target[1]), []).extend(group)
    for sources in alone.values():
        for at in range(0, len(sources), AT_A_TIME):
            yield task_of(sources[at:at + AT_A_TIME], entries, includes, everything, folder)


def task_of(group, entries, includes, everything, folder):
    entry = entries[group[0]]
    files = set(group).union(*(includes.get(source, everything) for source in group))
    if len(group) == 1:
        return Task(group[0], group, entry, files)
    wrapper = folder / ("_".join(group[0].relative_to(ROOT).parts) + f"_and_{len(group) - 1}_more.cpp")
    wrapper.write_text("".join(f'#include "{source.relative_to(ROOT)}"  // NOLINT\n' for source in group))
    command = entry["command"].replace(entry["file"], str(wrapper))
    return Task(wrapper, group, dict(entry, file=str(wrapper), command=command), files)


def tidy_version():
    return subprocess.run(["clang-tidy", "--version"], capture_output=True, text=True, check=True).stdout


def fingerprint(version, entry, files):
    digest = hashlib.sha256(version.encode() + CONFIG.read_bytes() + PLUGIN_SOURCE.read_bytes() + entry["command"].encode())
    for path in sorted(files):
        digest.update(str(path).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def build_plugin(version, folder):
    """own_code.cpp as a plugin for exactly this version of clang-tidy."""
    major = re.search(r"version (\d+)", version)[1]
    plugin = folder / "own_code.so"
    config = f"llvm-config-{major}"
    if shutil.which(config) is None:
        raise Failure(f'the command "{config}" is missing: run toolchain/setup.sh first.')
    flags = subprocess.run([config, "--cppflags"], capture_output=True, text=True, check=True).stdout.split()
    # As LLVM itself: without run-time type information. Its headers are not ours to warn about.
    run = subprocess.run(["c++", "-std=c++17", "-O1", "-fPIC", "-shared", "-fno-rtti", "-w", *flags, str(PLUGIN_SOURCE),
                          "-o", str(plugin)], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"{PLUGIN_SOURCE} cannot be compiled (toolchain/setup.sh installs what it needs):\n{run.stderr}")
    return plugin


def run_tidy(source, analyzed, database):
    """Findings, or nothing."""
    run = subprocess.run(
        ["clang-tidy", f"--load={database / 'own_code.so'}", f"-p={database}", f"--config-file={CONFIG}", "--quiet",
         "--header-filter=" + "/(" + "|".join(FOLDERS) + r")/[^:]*\.[ch]pp$",
         *([] if analyzed else ["--checks=-clang-analyzer-*"]),
         "--extra-arg=-Wno-unknown-warning-option", str(source)],
        capture_output=True, text=True, check=False)
    findings = run.stdout if run.returncode == 0 or run.stdout.strip() else run.stderr
    return "" if run.returncode == 0 and not findings.strip() else findings


def check(task, database):
    start = time.monotonic()
    analyzed = is_analyzed(task.about[0])
    findings = run_tidy(task.source, analyzed, database)
    # Together they may just not compile: names of one file alone.
    if findings and len(task.about) > 1:
        findings = "".join(run_tidy(source, analyzed, database) for source in task.about)
    return findings, time.monotonic() - start


def all_tasks(build, temporary):
    entries, includes = read_entries(configure_apart(build)), read_includes(build)
    seen = set().union(*includes.values())
    everything = {path for folder in FOLDERS for path in (ROOT / folder).rglob("*.hpp")
                  if "node_modules" not in path.parts}
    # Which other headers such a header includes is not known, so it depends on all of them.
    wrapped = wrap_headers(sorted(everything - seen), entries, temporary)
    tasks = list(tasks_of_sources(build, entries, includes, everything, temporary))
    tasks += [Task(wrapper, [header], entry, everything) for wrapper, (header, entry) in wrapped.items()]
    database = list(entries.values()) + [task.entry for task in tasks if task.source not in entries]
    (temporary / "compile_commands.json").write_text(json.dumps(database))
    return tasks


def check_all(build, temporary):
    tasks = all_tasks(build, temporary)
    version = tidy_version()
    build_plugin(version, temporary)
    memory = build / "tidy" / "clean"
    memory.mkdir(exist_ok=True)
    waiting = []
    for task in tasks:
        stable = dict(task.entry, command=task.entry["command"].replace(str(temporary), ""))
        stamp = memory / fingerprint(version, stable, task.files)
        if not stamp.exists():
            waiting.append((task, stamp))
    print(f"clang-tidy: {len(tasks)} runs, {len(tasks) - len(waiting)} of them unchanged and clean", flush=True)

    jobs = int(os.environ.get("VOLCOMP_JOBS") or os.cpu_count() or 1)
    bad = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(check, task, temporary): (task, stamp) for task, stamp in waiting}
        for number, finished in enumerate(concurrent.futures.as_completed(running), 1):
            task, stamp = running[finished]
            findings, seconds = finished.result()
            print(f"  [{number}/{len(waiting)}] {task.name()} {seconds:.0f} s", flush=True)
            if findings:
                bad.append(task.name())
                print(findings, flush=True)
            else:
                stamp.touch()
    if bad:
        raise Failure(f"findings in {', '.join(sorted(bad))}.")


PLANTED = r"""
#include <Eigen/Core>
#include <vector>
int planted(int* p, bool b) { int x; if (b) p = nullptr; if (b) x = 2; return *p + x; }
double planted(const std::vector<int>& v) { return v.size() == 0 ? 0.0 : (double)v[0]; }
template <class T> T in_template(T a) { T b; Eigen::Matrix<T, 3, 1> m; m.setZero(); return a + b + m.sum(); }
double instantiate() { return in_template(2.0); }
namespace std { template <> struct hash<Eigen::Vector2d> { hash(int salt); }; }
int twice(int n) { return n < 2 ? n : twice(n - 1) * twice(n - 2); }
int at_its_end(int n, int s) { return n == 0 ? s : at_its_end(n - 1, s + n); }
int odd(int n);
int even(int n) { return n != 0 ? odd(n - 1) : 0; }
int odd(int n) { return n != 0 ? even(n / 2) : 1; }
namespace { struct Made { int n; explicit Made(int k) : n(k != 0 ? Made(k - 1).n + 1 : 0) {} }; }
int make(int k) { return Made(k).n; }
"""
PLANTED_FAULTS = ("readability-non-const-parameter", "cppcoreguidelines-init-variables", "core.NullDereference",
                  "readability-container-size-empty", "core.UndefinedBinaryOperatorResult",
                  "google-explicit-constructor",
                  *(f"function '{name}' is within a recursive call chain" for name in ("twice", "at_its_end", "even", "odd", "Made")))


def self_test():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        source = folder / "planted.cpp"
        source.write_text(PLANTED)
        command = ["clang-tidy", f"--config-file={CONFIG}", "--quiet", str(source), "--", "-std=c++17",
                   "-isystem", "/usr/include/eigen3"]
        plugin = build_plugin(tidy_version(), folder)
        found = []
        for load in ([], [f"--load={plugin}"]):
            run = subprocess.run([command[0], *load, *command[1:]], capture_output=True, text=True, check=False)
            found.append([line for line in run.stdout.splitlines() if re.search(r": (error|warning): ", line)])
        missing = [fault for fault in PLANTED_FAULTS if not any(fault in line for line in found[0])]
        if missing or found[0] != found[1]:
            raise Failure("self-test: not found: " + ", ".join(missing) + "\nwithout the plugin:\n" +
                          "\n".join(found[0]) + "\nwith it:\n" + "\n".join(found[1]))
        print(f"self-test: {len(found[1])} planted faults are found, with the plugin as without")


def main():
    if len(sys.argv) > 1 and sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return
    for command in ("clang-tidy", "cmake", "ninja"):
        if shutil.which(command) is None:
            raise Failure(f'the command "{command}" is missing: run toolchain/setup.sh first.')
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/host").resolve()
    with tempfile.TemporaryDirectory() as temporary:
        check_all(build, pathlib.Path(temporary))


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"tidy.py: {failure}")
