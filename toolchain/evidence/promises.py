"""What is promised of all code that runs beside a machine, judged in linked images: no heap, no exceptions, no types at run time, no work
before main, no recursion, no stack of variable size; no mutable globals in the libraries; no mathematics of the C library in what runs in
the interrupt.

The image "whole" of each target holds every member of the libraries, also what no product uses but another's program may link.
Recursion that the compiler turned into a loop is found by clang-tidy (misc-no-recursion). Calls through pointers are counted here;
stack_bound.py follows them.
"""
import collections
import re

import elf
import symbol_rules
from call_graph import CallGraph
from failure import Failure
from link_map import LinkMap, Piece

IMAGES = {"host": ("whole",), "m7": ("whole", "node", "plain", "servo", "grinder"), "m4": ("whole", "node", "plain", "servo"), "a53": ("whole", "node")}
LIBRARIES = {"comp", "metrology", "c", "canopen", "hal_link"}
LIBRARIES_OF = {"host": {"node", "hal_linux"}, "m7": {"grinder_node", "hal_mps2"}, "m4": {"node", "hal_mps2"}, "a53": {"node", "hal_virt"}}
DEVICES = {"hal_mps2", "hal_virt"}  # hold the state of a device
INTERRUPT_ROOMS = ("tables", "tick", "probe", "strokes")
BACKGROUND = {"spectral_line.cpp"}  # only the background of a grinder calls it
# The M4F computes in double by calls; these two are instructions elsewhere.
ARITHMETIC = {"m4": {"sqrt", "floor"}}
BEFORE_MAIN = re.compile(r"\.(preinit_array|init_array|fini_array|ctors|dtors)(\..*)?")
# Constants that hold addresses are written by the loader alone.
MUTABLE = re.compile(r"(\.(data(?!\.rel\.ro)|bss|tdata|tbss|sdata|sbss)(\..*)?|COMMON)")
OURS = (".cpp", ".S")  # objects of C libraries have other names
NOWHERE = Piece("", 0, 0, "", "")


class Promises:
    def __init__(self, path, interrupt, arithmetic=frozenset()):
        """`interrupt`: names of the sources of comp whose code runs in the interrupt."""
        self.image = elf.Image(path)
        self.map = LinkMap(path.with_suffix(".map"))
        self.graph = CallGraph(self.image)
        self.names = collections.defaultdict(set)  # of the functions at an address
        for symbol in self.image.symbols:
            if symbol.is_function():
                self.names[symbol.address].add(symbol.name)
        self.interrupt = interrupt
        self.arithmetic = arithmetic

    def offences(self):
        """Sentences, one each."""
        name = self.image.path.name
        return symbol_rules.forbidden_in(self.image) + [f"{name}: {o}" for check in (
            self._before_main, self._globals, self._recursion, self._dynamic_stack, self._mathematics) for o in check()]

    def require(self, libraries):
        """Fails unless something of each library and of each source of the interrupt is in the image."""
        pieces = self.map.pieces
        missing = (libraries - {p.library for p in pieces}) | (self.interrupt - {p.source for p in pieces})
        if missing:
            raise Failure(f"{self.image.path.name} holds nothing of {', '.join(sorted(missing))}, so nothing is proven of it.")

    def functions(self):
        return sum(s.is_function() for s in self.image.symbols)

    def roots(self):
        """The functions of the interrupt that call."""
        return [f for f in self.graph.calls if self._is_of(f, self.interrupt)]

    def _piece(self, function):
        """Where the code of a function comes from; of nowhere if the image does not contain it."""
        return function.defined and self.map.code_at(function.address) or NOWHERE

    def _is_of(self, function, sources):
        piece = self._piece(function)
        return piece.library == "comp" and piece.source in sources

    def _before_main(self):
        return [f"initializers: {p.section} of {p.source}" for p in self.map.pieces if BEFORE_MAIN.fullmatch(p.section) and p.library]

    def _globals(self):
        return [f"globals: {p.section} of {p.source}" for p in self.map.pieces
                if MUTABLE.fullmatch(p.section) and p.library and p.library not in DEVICES]

    def _recursion(self):
        """Of our functions, be it by way of others."""
        return ["recursion: " + " is called by ".join(self.image.plain(f) for f in cycle) for cycle in self.graph.cycles()
                if any(self._piece(f).source.endswith(OURS) for f in cycle)]

    def _dynamic_stack(self):
        """Startup code sets the stack pointer, too: it is no C++."""
        return [f"stack of variable size: {self.image.plain(f)}, {i}" for f, i in self.graph.dynamic.items()
                if self._piece(f).source.endswith(".cpp")]

    def _mathematics(self):
        reached = self.graph.reached(self.roots(), lambda function: self._is_of(function, BACKGROUND) or self._is_mathematics(function))
        calls = ((caller, callee) for caller in reached for callee in self.graph.calls.get(caller, ()) if self._is_mathematics(callee))
        return [f"mathematics: {min(self._names(callee), key=len)} is called by {self.image.plain(caller)}, in the interrupt"
                for caller, callee in calls]

    def _names(self, function):
        """All of them: the C library has most of its functions under several."""
        return self.names[function.address] | {function.name}

    def _is_mathematics(self, function):
        names = self._names(function)
        return any(symbol_rules.LIBM.fullmatch(name) for name in names) and not names & self.arithmetic


def interrupt_sources(root):
    return {p.name for room in INTERRUPT_ROOMS for p in (root / "comp" / room).rglob("*.cpp")} - BACKGROUND


def prove(root, target):
    """Offences of all images of a target."""
    found, interrupt = [], interrupt_sources(root)
    for name in IMAGES[target]:
        path = root / "build" / target / "firmware" / f"volcomp-{name}-{target}.elf"
        promises = Promises(path, interrupt, ARITHMETIC.get(target, frozenset()))
        if name == "whole":
            promises.require(LIBRARIES | LIBRARIES_OF[target])
        offences = promises.offences()
        print(f"  {path.name}: {promises.functions()} functions, {len(promises.graph.through_pointers)} with calls through "
              f"pointers, not followed; {len(promises.roots())} of the interrupt call others; {len(offences)} offences")
        found += offences
    return found
