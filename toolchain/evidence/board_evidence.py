"""Everything measured on one Cortex-M board: sizes, stack, instructions."""
import re
import sys

import budgets
import code_flow
import elf
import groups
import link_map
import node_run
import runs
import sizes
import stack_bound
import symbol_rules
from documented_calls import CALLS
from failure import Failure

PRODUCTS = ("node", "servo")  # images that a controller would carry
# Entries that share the stack of main, by priority (hal/mps2/nvic.hpp): those of one priority do not interrupt each other.
# And what the processor puts there first: eight words, eighteen more where the FPU is in use, one to align (Armv7-M, B1.5.7).
INTERRUPTS = {"timers": ("TIMER0_Handler", "TIMER1_Handler"), "link": ("UARTRX0_Handler", "UARTTX0_Handler")}
EXCEPTION_FRAME = 4 * (8 + 18 + 1)
FAULT = "report_fault"
TICK_OF = {
    "xyfz_compiled": r"CompiledMachine<volcomp::kXyfzMachine, \(volcomp::RuntimeModel\)0>",
    "xyz_second_order_compiled": r"CompiledMachine<volcomp::bench::kGeneric, \(volcomp::RuntimeModel\)2>",
    "xyb_a_compiled": r"CompiledMachine<volcomp::bench::kGrinder, \(volcomp::RuntimeModel\)0>",
    "five_axis_compiled": r"CompiledMachine<volcomp::bench::kFiveAxis, \(volcomp::RuntimeModel\)0>",
    "xyb_a_loaded": r"LoadedMachine<5u, 0u>",
    "five_axis_loaded": r"LoadedMachine<5u, 0u>",
    "xyfz_loaded": r"LoadedMachine<5u, 0u>",
    "five_axis_orienting": r"LoadedMachine<5u, 2u>",
    "eight_axis": r"LoadedMachine<8u, 0u>",
}


class BoardEvidence:
    def __init__(self, root, board):
        self.root = root
        self.board = board
        self.folder = root / "build" / board / "firmware"
        self.offences = []
        self.used = set()
        self.checks = []

    def image(self, name):
        return elf.Image(self.folder / f"volcomp-{name}-{self.board}.elf")

    def measure(self):
        products = {name: self._product(name) for name in PRODUCTS}
        self.offences += [f"The list documents calls of {call.caller} that no image makes." for call in CALLS if call not in self.used]
        ticks = self._ticks()
        self.checks.append(budgets.Check(f"{self.board}, node, bytes of flash", products["node"]["flash"], budgets.NODE_FLASH))
        found = self._groups(products["node"]["flash"])
        plain = sizes.measure(self.image("plain"))
        self.checks.append(budgets.Check(f"{self.board}, node without a probe, bytes of flash", plain.flash, budgets.PLAIN_FLASH))
        return {"products": products, "plain": {"flash": plain.flash, "ram": plain.ram}, "groups": found, **ticks, "worst": self._worst(), "latency": self._latency(), "services": self._services(), "touches": self._touches(),
                "strokes": self._strokes()}

    def _groups(self, flash):
        """What the flash of the node is taken by; with budgets for the Cortex-M7."""
        found = groups.measure(link_map.LinkMap(self.image("node").path.with_suffix(".map")), flash)
        if self.board == "m7":
            self.checks += [budgets.Check(f"m7, node, {group}, bytes of flash", found[group], budget) for group, budget in groups.BUDGETS.items()]
        return found

    def _product(self, name):
        image = self.image(name)
        size = sizes.measure(image)
        bounds = stack_bound.StackBound(code_flow.CodeFlow(image))
        stack = {"background": self._bound(bounds, "main")}
        unused = image.symbol("Unexpected_Handler").address
        for priority, handlers in INTERRUPTS.items():
            used = [h for h in handlers if image.symbol(h) and image.symbol(h).address != unused]
            if used:
                stack[priority] = max(self._bound(bounds, handler) for handler in used)
        fault = self._bound(bounds, FAULT)
        bound = sum(stack.values()) + EXCEPTION_FRAME * len(stack)
        self.checks.append(budgets.Check(f"{self.board}, {name}, bytes of stack, interrupts nested", bound, size.stack))
        self._check_tick(image, bounds)
        self.used |= bounds.used
        painted = self._painted(name, image.path)
        if painted > bound:
            self.offences.append(f"{image.path.name} was seen with {painted} bytes of stack; at most {bound} were proven.")
        return {"flash": size.flash, "ram": size.ram,
                "stack": {"reserved": size.stack, "bound": bound, "painted": painted, "parts": stack, "fault": fault}}

    def _painted(self, name, path):
        """Bytes of stack in use when the image did its deepest work."""
        if name == "node":
            tables = self.root / f"build/evidence/tables-{self.board}.vct"
            return node_run.deepest_stack(self.root, self.board, path, tables.read_bytes())
        found = re.search(r"stack: (\d+) bytes", runs.run(self.root, self.board, path))
        if not found:
            raise Failure(f"{path.name} does not say how much stack it took.")
        return int(found.group(1))

    def _bound(self, bounds, name):
        symbol = bounds.image.symbol(name)
        if symbol is None:
            raise Failure(f"{bounds.image.path.name} has no function {name}.")
        bound = bounds.of(symbol.address)
        self.offences += [f"{bounds.image.path.name}: {p}." for p in bound.problems]
        return bound.bytes

    def _check_tick(self, image, bounds):
        """Every tick in the image uses nothing but itself. Returns {function: bytes of stack}."""
        found = {}
        for symbol in image.find(re.compile(r"volcomp::Compensator<.*>::tick\(.*")):
            bound = bounds.of(symbol.address)
            self.offences += [f"{image.path.name}, tick: {p}." for p in bound.problems]
            self.offences += [f"{image.path.name}: {s}" for s in symbol_rules.foreign_in_tick(image, bound.symbols)]
            found[image.plain(symbol)] = bound.bytes
        if not found:
            raise Failure(f"{image.path.name} has no tick to look at.")
        return found

    def _ticks(self):
        static = {}
        for name in ("ticks", "worst"):
            image = self.image(name)
            static |= self._check_tick(image, stack_bound.StackBound(code_flow.CodeFlow(image)))
        # With a bound on acceleration and without: what takes more.
        bounds = {variant: max(b for name, b in static.items() if re.search(machine, name)) for variant, machine in TICK_OF.items()}
        figures = runs.figures(runs.run(self.root, self.board, self.image("ticks").path))
        kinds = [f for word, f in figures if word == "tick"]
        painted = {(f["variant"], f["knots"]): f["bytes"] for word, f in figures if word == "stack"}
        spans = {(f["variant"], f["knots"], f["phase"]): (f["min"], f["max"]) for f in kinds if f["kind"] == "any"}
        most_knots = {v: max(k for w, k, _ in spans if w == v) for v, _, _ in spans}
        self.checks += budgets.of_stack(self.board, bounds)
        self.checks += self._independence(spans)
        self.offences += [f"{self.board}, {v}: {painted[v, k]} bytes of stack were seen, the bound says {bounds[v]}."
                          for v, k in painted if painted[v, k] > bounds[v]]
        return {"ticks": {v: {"min": spans[v, k, "usual"][0], "max": spans[v, k, "usual"][1], "stack_painted": painted[v, k]}
                          for v, k in most_knots.items()},
                "kinds": kinds, "stack_bounds": bounds}

    def _worst(self):
        """{machine: {kind of tick: figures}}; the image itself refuses digests that are not those of the other boards."""
        found = {}
        for word, fields in runs.figures(runs.run(self.root, self.board, self.image("worst").path)):
            if word == "worst":
                found.setdefault(fields["machine"], {})[fields["kind"]] = fields
        self.checks += budgets.of_worst(self.board, found)
        return found

    def _latency(self):
        figures = runs.figures(runs.run(self.root, self.board, self.image("latency").path))
        found = {fields["way"]: fields for word, fields in figures if word == "latency"}
        self.checks += budgets.of_latency(self.board, found)
        return found

    def _services(self):
        found = {"sdo": {}, "image": {}}
        for word, fields in runs.figures(runs.run(self.root, self.board, self.image("services").path)):
            found[word][fields["request" if word == "sdo" else "machine"]] = fields
        return found

    def _touches(self):
        figures = runs.figures(runs.run(self.root, self.board, self.image("touches").path))
        found = {fields["machine"]: fields for word, fields in figures if word == "touch"}
        found["flank"] = next(fields for word, fields in figures if word == "flank")
        self.checks += budgets.of_touches(self.board, found)
        return found

    def _strokes(self):
        """Only boards with memory for them watch strokes."""
        if self.board not in budgets.GRINDERS:
            return None
        figures = dict(runs.figures(runs.run(self.root, self.board, self.image("strokes").path)))
        size = sizes.measure(self.image("grinder"))
        return {"tick": figures["stroke"], "background": figures["learning"], "flash": size.flash, "ram": size.ram}

    def _independence(self, spans):
        """Whatever was measured with two sizes of tables costs the same with both."""
        checks = []
        for variant, knots, phase in spans:
            fewest = min(k for v, k, p in spans if v == variant)
            if phase == "usual" and knots > fewest:
                few, many = spans[variant, fewest, phase], spans[variant, knots, phase]
                name = budgets.TICKS[variant]
                checks.append(budgets.Check(f"{self.board}, {name}, instructions more with {knots} than with {fewest} knots",
                                            max(many[0] - few[0], many[1] - few[1]), 0))
        if not checks:
            raise Failure("No tick was measured with two sizes of tables.")
        return checks


sys.setrecursionlimit(10_000)
