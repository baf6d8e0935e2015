"""Static bound of the stack from an entry of an image: the deepest way through its call graph.

Recursion, a stack of variable size and an indirect call that nobody documented are failures, not numbers.
"""
import dataclasses
import re

from documented_calls import CALLS


@dataclasses.dataclass
class Bound:
    bytes: int
    path: list      # (function, bytes of stack before its deepest call or in itself)
    symbols: set    # every function that may run
    problems: list  # sentences


class StackBound:
    def __init__(self, flow, calls=CALLS):
        self.flow = flow
        self.image = flow.image
        self.documented = calls
        self.used = set()  # documented calls that were met
        self._done = {}

    def of(self, entry):
        self.problems = []
        symbols = set()
        path = self._deepest(entry, [], symbols)
        return Bound(sum(depth for _, depth in path), path, symbols, list(dict.fromkeys(self.problems)))

    def _deepest(self, entry, callers, symbols):
        if entry in callers:
            names = [self.flow.name(a) for a in callers[callers.index(entry):] + [entry]]
            self.problems.append("recursion: " + " calls ".join(names))
            return []
        if entry in self._done:
            path, reached, problems = self._done[entry]
            symbols |= reached
            self.problems += problems
            return path
        before = len(self.problems)
        routine = self.flow.routine(entry)
        self.problems += routine.problems
        reached = set(routine.symbols)
        best = [(self.flow.name(entry), routine.frame)]
        for target, depth in self._callees(routine):
            below = self._deepest(target, callers + [entry], reached)
            if depth + sum(d for _, d in below) > sum(d for _, d in best):
                best = [(self.flow.name(entry), depth)] + below
        self._done[entry] = (best, reached, self.problems[before:])
        symbols |= reached
        return best

    def _callees(self, routine):
        yield from sorted(routine.calls.items())
        for address, depth in sorted(routine.indirect.items()):
            for target in self._targets(address):
                yield target, depth

    def _targets(self, address):
        """Where an indirect call may go, as documented; each possible target."""
        caller = self.flow.name(address)
        slot = self._slot(address)
        targets = set()
        for call in self.documented:
            if not re.fullmatch(call.caller, caller):
                continue
            found = call.targets(self.image, slot)
            if found:
                self.used.add(call)
            targets |= found
        if not targets:
            where = "" if slot is None else f", slot {slot // 4} of a virtual table"
            self.problems.append(f"{caller} calls what no list documents (0x{address:x}{where})")
        return sorted(targets)

    def _slot(self, address):
        """Offset in the virtual table the called register was loaded with, None where it was not loaded that way."""
        register = self.flow.code[address].operands.strip()
        for at in sorted((a for a in self.flow.code if address - 40 <= a < address), reverse=True):
            name, operands = self.flow.code[at].mnemonic.split(".")[0], self.flow.code[at].operands
            if not operands.startswith(f"{register}, "):
                continue
            loaded = re.match(r"\w+, \[(?!sp|pc)\w+(?:, #(\d+))?\]$", operands)
            moved = re.match(r"\w+, (\w+)$", operands)
            if name == "ldr" and loaded:
                return int(loaded.group(1) or 0)
            if name != "mov" or not moved:
                return None
            register = moved.group(1)
        return None
