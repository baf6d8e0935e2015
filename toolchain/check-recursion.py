#!/usr/bin/env python3
"""Proves from GCC's call graph that no function of the target recurses or takes memory from the stack dynamically.

    toolchain/check-recursion.py [BUILD_FOLDER]   default build/host
    toolchain/check-recursion.py --self-test      proves that each kind of offence is found

Two graphs of every source of comp, hal/linux, firmware/canopen and firmware/node must be free of cycles: as it is
built, which the preset "host" leaves beside each object, and without optimization, where no call has been inlined and
no tail recursion has become a loop. Sources are compiled for it into a temporary folder with the flags of
BUILD_FOLDER's compile_commands.json, several at once, for most of the time goes into the headers of others. The stack
figures belong to the first.

Calls through pointers and virtual functions have no target in the graph; they are counted and not followed.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
NODE = re.compile(r'^node: \{ title: "([^"]*)" label: "(.*)"( shape : ellipse)? \}$')
EDGE = re.compile(r'^edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"')
STACK = re.compile(r"(\d+) bytes \(([^)]*)\)")
INDIRECT = "__indirect_call"
AT_A_TIME = 8
LAUNCHERS = {"ccache", "sccache", "distcc"}
LIBM = re.compile(
    r"^(a?(sin|cos|tan)h?|atan2|sincos|sqrt|cbrt|hypot|pow|exp|exp2|expm1|log|log2|log10|log1p|floor|ceil|trunc"
    r"|l?l?round|l?l?rint|nearbyint|fmod|remainder|modf|frexp|ldexp|fma|fdim|erfc?|[lt]gamma)[fl]?$")


class Failure(Exception):
    """One plain sentence for the user."""


class Function:
    def __init__(self, label, defined):
        lines = label.split("\\n")
        name = lines[0].split(" [with ")[0]
        self.name = name if len(name) <= 120 else name[:117] + "..."
        self.place = lines[1].removeprefix(f"{ROOT}/") if len(lines) > 1 else "?"
        self.defined = defined
        stack = STACK.search(label)
        self.bytes = int(stack.group(1)) if stack else 0
        self.stack_kind = stack.group(2) if stack else "unknown"

    def __str__(self):
        return f"{self.name} ({self.place})"


class Graph:
    def __init__(self):
        self.functions = {}
        self.calls = collections.defaultdict(set)

    def add_file(self, path, unit):
        """Functions local to one source get its number, so that equal names do not become one function."""
        def key(title):
            return f"{unit}:{title}" if ":" in title else title

        for line in path.read_text().splitlines():
            if node := NODE.match(line):
                title, label, external = node.groups()
                function = Function(label, external is None)
                if key(title) not in self.functions or function.defined:
                    self.functions[key(title)] = function
            elif edge := EDGE.match(line):
                self.calls[key(edge.group(1))].add(key(edge.group(2)))

    def close(self):
        """Complete constructors and destructors (C1, D1) are aliases of the base ones (C2, D2)."""
        for targets in self.calls.values():
            for target in list(targets):
                alias = re.sub(r"([CD])1(?=E)", r"\g<1>2", target)
                if alias != target and not self.is_defined(target) and self.is_defined(alias):
                    targets.add(alias)

    def is_defined(self, title):
        return title in self.functions and self.functions[title].defined

    def components(self):
        """Tarjan's strongly connected components, callees first, without recursion."""
        index, low, on_stack, stack, result = {}, {}, set(), [], []
        for root in list(self.functions):
            if root in index:
                continue
            work = [(root, iter(sorted(self.calls.get(root, ()))))]
            index[root] = low[root] = len(index)
            stack.append(root)
            on_stack.add(root)
            while work:
                current, targets = work[-1]
                for target in targets:
                    if target not in index:
                        index[target] = low[target] = len(index)
                        stack.append(target)
                        on_stack.add(target)
                        work.append((target, iter(sorted(self.calls.get(target, ())))))
                        break
                    if target in on_stack:
                        low[current] = min(low[current], index[target])
                else:
                    work.pop()
                    if work:
                        low[work[-1][0]] = min(low[work[-1][0]], low[current])
                    if low[current] == index[current]:
                        component = []
                        while not component or component[-1] != current:
                            component.append(stack.pop())
                            on_stack.discard(component[-1])
                        result.append(component)
        return result

    def cycles(self):
        return [sorted(c) for c in self.components() if len(c) > 1 or c[0] in self.calls.get(c[0], ())]

    def worst_path(self):
        """Titles from the outermost to the innermost function of the deepest stack; needs a graph without cycles."""
        depth, following = {}, {}
        for (title,) in self.components():
            below = max(self.calls.get(title, ()), key=lambda t: depth.get(t, 0), default=None)
            following[title] = below
            own = self.functions[title].bytes if title in self.functions else 0
            depth[title] = own + depth.get(below, 0)
        title = max(depth, key=depth.get, default=None)
        path = []
        while title is not None and self.is_defined(title):
            path.append(title)
            title = following[title]
        return path

    def reachable(self, roots):
        seen, waiting = {}, [(root, None) for root in roots]
        while waiting:
            title, caller = waiting.pop()
            if title in seen:
                continue
            seen[title] = caller
            waiting += [(target, title) for target in self.calls.get(title, ())]
        return seen


def arguments_of(entry):
    return entry.get("arguments") or shlex.split(entry["command"])


def compile_command(entry):
    """The compiler and its flags for one entry of compile_commands.json, without launcher, output and source."""
    arguments = arguments_of(entry)
    while pathlib.Path(arguments[0]).name in LAUNCHERS:
        arguments = arguments[1:]
    flags, skip = [], False
    for argument in arguments:
        if skip:
            skip = False
        elif argument in ("-o", "-MF", "-MT"):
            skip = True
        elif argument not in ("-c", "-MD", entry["file"]):
            flags.append(argument)
    return flags


def object_of(entry):
    """What one entry of compile_commands.json compiles to."""
    arguments = arguments_of(entry)
    return arguments[arguments.index("-o") + 1]


def call_graph_file(command, source, folder, base):
    output = pathlib.Path(base)
    run = subprocess.run(
        command + ["-w", "-fcallgraph-info=su,da", "-c", str(source), "-o", str(output.with_suffix(".o"))],
        cwd=folder, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"{source} could not be compiled for its call graph with {command[0]}:\n{run.stderr}")
    graph_file = output.with_suffix(".ci")
    if not graph_file.exists():
        raise Failure(f"{command[0]} writes no call graph: a GCC is needed.")
    return graph_file


def together(units):
    """Lists of units that differ in nothing but their sources, AT_A_TIME at the most."""
    alike = collections.defaultdict(list)
    for unit in units:
        alike[tuple(unit[0]), unit[2]].append(unit)
    return [group[at:at + AT_A_TIME] for group in alike.values() for at in range(0, len(group), AT_A_TIME)]


def call_graph_files(group, extra, base):
    """Checks all sources at once, or one by one where they share names."""
    command, source, folder = group[0][:3]
    if len(group) > 1:
        source = pathlib.Path(f"{base}.cpp")
        source.write_text("".join(f'#include "{unit[1]}"\n' for unit in group))
    try:
        return [call_graph_file(command + extra, source, folder, base)]
    except Failure:
        if len(group) == 1:
            raise
    return [path for number, unit in enumerate(group) for path in call_graph_files([unit], extra, f"{base}-{number}")]


def graph_beside(objects):
    """The graph that was written with the objects. Each has its file: they are compiled without a cache."""
    graph = Graph()
    for number, built in enumerate(objects):
        path = built.with_suffix(".ci")
        if not path.exists():
            raise Failure(f"{path} is missing: build the preset \"host\" with GCC first.")
        graph.add_file(path, number)
    graph.close()
    return graph


def build_graph(groups, extra, jobs):
    """One graph over all groups of units; a unit is (command, source, working folder, object)."""
    graph = Graph()
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        tasks = [pool.submit(call_graph_files, group, extra, f"{temporary}/{number}")
                 for number, group in enumerate(groups)]
        for number, path in enumerate(path for task in tasks for path in task.result()):
            graph.add_file(path, number)
    graph.close()
    return graph


def judge(built, plain):
    """The offences, one sentence each."""
    offences = []
    for way, graph in (("as built", built), ("without optimization", plain)):
        for cycle in graph.cycles():
            names = "; ".join(str(graph.functions[title]) for title in cycle)
            offences.append(f"recursion ({way}): {names}")
    for function in built.functions.values():
        if function.defined and function.stack_kind not in ("static", "dynamic,bounded"):
            offences.append(f"dynamic stack memory: {function}")
    return offences


def print_figures(graph):
    own = sorted((f for f in graph.functions.values() if f.defined), key=lambda f: f.bytes, reverse=True)
    indirect = [str(graph.functions[t]) for t, targets in sorted(graph.calls.items()) if INDIRECT in targets]
    print("  the ten largest stack frames:")
    for function in own[:10]:
        print(f"    {function.bytes:6d} bytes  {function}")
    path = graph.worst_path()
    print(f"  the deepest known stack: {sum(graph.functions[t].bytes for t in path)} bytes")
    for title in path:
        print(f"    {graph.functions[title].bytes:6d} bytes  {graph.functions[title]}")
    print(f"  functions that call through a pointer or virtually (not followed): {len(indirect)}")
    for name in indirect:
        print(f"    {name}")


def print_realtime_mathematics(graph):
    """What check-archive.sh cannot see: C library mathematics behind calls into other folders of comp."""
    roots = [t for t, f in graph.functions.items() if f.defined and f.place.startswith(INTERRUPT_ROOMS)]
    reached = graph.reachable(roots)
    found = sorted(t for t in reached if LIBM.match(t))
    print(f"  C library mathematics reached from the {len(roots)} functions of the interrupt: {len(found)}")
    for title in found:
        path = [title]
        while reached[path[-1]] is not None:
            path.append(reached[path[-1]])
        print("    " + " <- ".join(graph.functions[t].name if graph.is_defined(t) else t for t in path))


# What a tick may call.
INTERRUPT_ROOMS = ("comp/tables/", "comp/tick/", "comp/probe/", "comp/strokes/")

# What runs on a target, or beside one as a Linux process.
TARGET_FOLDERS = ("comp", "hal/linux", "firmware/canopen", "firmware/node")


def target_units(build):
    database = build / "compile_commands.json"
    if not database.exists():
        raise Failure(f"{database} is missing: configure the build first.")
    units = []
    for entry in json.loads(database.read_text()):
        source = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if any(ROOT / folder in source.parents for folder in TARGET_FOLDERS) and source.exists():
            built = pathlib.Path(entry["directory"], object_of(entry))
            units.append((compile_command(entry), source, entry["directory"], built))
    if not units:
        raise Failure(f"{database} names no source of {', '.join(TARGET_FOLDERS)}, so nothing can be proved.")
    return sorted(units, key=lambda unit: unit[1])


SELF_TESTS = (
    ("", "int f(int n) { return 2 * n; } int g(int n) { return f(n) + f(n + 1); }"),
    ("", "struct B { virtual int f() const = 0; }; int g(const B& b) { return b.f(); }"),
    ("recursion", "int f(int n) { return n < 2 ? n : f(n - 1) * f(n - 2); }"),
    ("recursion", "int f(int n, int s) { return n == 0 ? s : f(n - 1, s + n); }"),
    ("recursion", "int h(int); int g(int n) { return n ? h(n - 1) : 0; } int h(int n) { return n ? g(n / 2) : 1; }"),
    ("recursion", "namespace { struct A { int n; A(int k) : n(k ? A(k - 1).n + 1 : 0) {} }; } int f(int k) { return A(k).n; }"),
    ("recursion", "int across_two(int); int across_one(int n) { return n ? across_two(n - 1) : 0; }",
     "int across_one(int); int across_two(int n) { return n ? across_one(n / 2) : 0; }"),
    ("", "static int same(int n) { return n; } int one(int n) { return same(n); }",
     "int one(int); static int same(int n) { return one(n); } int two(int n) { return same(n); }"),
    ("dynamic stack memory", "void g(char*); void f(int n) { g(static_cast<char*>(__builtin_alloca(n))); }"),
    ("dynamic stack memory", "void g(char*); void f(int n) { char a[n]; g(a); }"),
)


def self_test(jobs):
    for expected, *texts in SELF_TESTS:
        with tempfile.TemporaryDirectory() as folder:
            units = []
            for number, text in enumerate(texts):
                source = pathlib.Path(folder, f"s{number}.cpp")
                source.write_text(text + "\n")
                units.append((["g++", "-std=c++17", "-O2"], source, folder))
            offences = judge(build_graph([[unit] for unit in units], [], jobs),
                             build_graph(together(units), ["-O0"], jobs))
        right = any(o.startswith(expected) for o in offences) if expected else not offences
        if not right:
            raise Failure(f"self-test: expected \"{expected or 'no offence'}\", found {offences} in {texts}")
    print(f"self-test: {len(SELF_TESTS)} small programs judged rightly")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default="build/host", type=pathlib.Path)
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    jobs = int(os.environ.get("VOLCOMP_JOBS") or os.cpu_count() or 1)
    if options.self_test:
        return self_test(jobs)
    units = target_units(options.build)
    built = graph_beside([unit[3] for unit in units])
    plain = build_graph(together(units), ["-O0"], jobs)
    defined = sum(f.defined for f in built.functions.values())
    print(f"call graph of {len(units)} sources of the target: {defined} functions, "
          f"{sum(f.defined for f in plain.functions.values())} before inlining")
    offences = judge(built, plain)
    for offence in offences:
        print(f"  FOUND {offence}")
    if offences:
        raise Failure("the target code breaks a promise, see FOUND above.")
    print("  no recursion, no dynamic stack memory")
    print_figures(built)
    print_realtime_mathematics(plain)
    return None


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(f"check-recursion.py: {failure}")
