#!/usr/bin/env python3
"""Runs clang-tidy over comp, hal, firmware and host_sim with the flags of a finished build; any finding fails.

    toolchain/tidy.py [BUILD_FOLDER]   default build/host

A header that no source of these folders includes is checked through a source that includes only it. A file
that was clean is checked again only after it, a header of ours that it includes, its flags, .clang-tidy or
clang-tidy itself has changed; delete BUILD_FOLDER/tidy to check everything again. The path-sensitive analyzer
looks at the code of the target only: programs of the host meet the sanitizers in every test.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

FOLDERS = ("comp", "hal", "firmware", "host_sim")
ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIG = ROOT / ".clang-tidy"


class Failure(Exception):
    """One plain sentence for the user."""


def is_ours(path):
    return any(ROOT / folder in path.parents for folder in FOLDERS)


def read_entries(build):
    """Source -> its entry in compile_commands.json."""
    database = build / "compile_commands.json"
    if not database.exists():
        raise Failure(f"{database} is missing: configure and build first.")
    entries = {}
    for entry in json.loads(database.read_text()):
        source = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if is_ours(source):
            entries[source] = entry
    if not entries:
        raise Failure(f"{database} names no source of {', '.join(FOLDERS)}.")
    return entries


def read_includes(build):
    """Source -> the files of ours that it includes, as the build has noted them."""
    listing = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True, check=True)
    includes = {}
    for block in listing.stdout.split("\n\n"):
        paths = [pathlib.Path(os.path.normpath(build / line.strip()))
                 for line in block.splitlines() if line.startswith(" ")]
        if paths:
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


def fingerprint(version, entry, files):
    digest = hashlib.sha256(version + CONFIG.read_bytes() + entry["command"].encode())
    for path in sorted(files):
        digest.update(str(path).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def run_tidy(source, shown, database):
    start = time.monotonic()
    analyzed = ROOT / "host_sim" not in shown.parents
    run = subprocess.run(
        ["clang-tidy", f"-p={database}", f"--config-file={CONFIG}", "--quiet",
         *([] if analyzed else ["--checks=-clang-analyzer-*"]),
         "--extra-arg=-Wno-unknown-warning-option", str(source)],
        capture_output=True, text=True, check=False)
    findings = run.stdout if run.returncode == 0 or run.stdout.strip() else run.stderr
    return run.returncode == 0 and not findings.strip(), findings, time.monotonic() - start


def check_all(build, temporary):
    entries, includes = read_entries(build), read_includes(build)
    seen = set().union(*(includes.get(source, set()) for source in entries))
    headers = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.hpp")
                     if path not in seen and "node_modules" not in path.parts)
    wrapped = wrap_headers(headers, entries, temporary)
    # Which other headers such a header includes is not known, so it depends on all of them.
    everything = {path for folder in FOLDERS for path in (ROOT / folder).rglob("*.hpp")}
    tasks = [(source, source, entry, includes.get(source, everything) | {source}) for source, entry in entries.items()]
    tasks += [(wrapper, header, entry, everything) for wrapper, (header, entry) in wrapped.items()]
    database = [entry for _, _, entry, _ in tasks]
    (temporary / "compile_commands.json").write_text(json.dumps(database))

    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    memory = build / "tidy"
    memory.mkdir(exist_ok=True)
    waiting = []
    for source, shown, entry, files in tasks:
        stable = dict(entry, command=entry["command"].replace(str(temporary), ""))
        stamp = memory / fingerprint(version, stable, files)
        if not stamp.exists():
            waiting.append((source, shown, stamp))
    print(f"clang-tidy: {len(tasks)} files, {len(tasks) - len(waiting)} of them unchanged and clean", flush=True)

    jobs = int(os.environ.get("VOLCOMP_JOBS") or os.cpu_count() or 1)
    bad = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(run_tidy, source, shown, temporary): (shown, stamp) for source, shown, stamp in waiting}
        for number, task in enumerate(concurrent.futures.as_completed(running), 1):
            shown, stamp = running[task]
            clean, findings, seconds = task.result()
            name = shown.relative_to(ROOT)
            print(f"  [{number}/{len(waiting)}] {name} {seconds:.0f} s", flush=True)
            if clean:
                stamp.touch()
            else:
                bad.append(str(name))
                print(findings, flush=True)
    if bad:
        raise Failure(f"findings in {', '.join(sorted(bad))}.")


def main():
    if len(sys.argv) > 1 and sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return
    for command in ("clang-tidy", "ninja"):
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
