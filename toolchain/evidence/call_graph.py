"""Who calls whom in an image: every call and every jump from one function into another. Calls through pointers have no target here."""
import collections
import graphlib
import re

import elf
from disassembly import disassemble

BRANCH = re.compile(r"b|cb|tb|call|j")
CALL = re.compile(r"bl(\.|$)|call")
INDIRECT = re.compile(r"blx r|blr |call\w* \*")
TARGET = re.compile(r"(?:^|, )([0-9a-f]+) <([^>+]+)[^>]*>$")
# What leaves in the stack pointer what is known at run time only, behind the instruction before. Large frames of A64 take their size
# from a register.
DYNAMIC = {"EM_ARM": re.compile(r".*; (?!(?:cm|tst|st|ldm)\w*)\S+ sp, (?!(?:sp, )?#)"),
           "EM_AARCH64": re.compile(r"(?!mov (x\d+), #.*; sub sp, sp, \1$).*; (?:sub|and|mov) sp, (?!(?:sp, )?#)"),
           "EM_X86_64": re.compile(r".*; (?:leave|(?:mov|add|sub|and|lea)\w* (?!\$).*,%rsp$)")}


class CallGraph:
    def __init__(self, image):
        self.image = image
        self.calls = collections.defaultdict(set)  # symbols of functions, also of those in other files (x@plt)
        self.through_pointers = set()              # functions that call where no instruction shows it
        self.dynamic = {}                          # function: instruction that takes stack of variable size
        dynamic, caller, before = DYNAMIC[image.machine], None, ""
        for address, instruction in disassemble(image).items():
            if caller is None or not caller.address <= address < caller.address + caller.size:
                caller = image.function_at(address)
            if caller is None:
                continue
            text = f"{instruction.mnemonic} {instruction.operands}"
            target = BRANCH.match(text) and TARGET.search(instruction.operands)
            if target:
                self._add(caller, instruction, int(target[1], 16), target[2])
            elif INDIRECT.match(text):
                self.through_pointers.add(caller)
            elif dynamic.match(f"{before}; {text}"):
                self.dynamic[caller] = instruction
            before = text

    def _add(self, caller, instruction, address, name):
        """A jump to where no function begins is one inside, or the way back from a part that was moved elsewhere; one to its own
        beginning is a loop."""
        callee = self.image.function_at(address) or elf.Symbol(name.partition("@")[0], address, 0, "STT_FUNC", False)
        if callee.address == address and (callee != caller or CALL.match(instruction.mnemonic)):
            self.calls[caller].add(callee)

    def cycles(self):
        """Lists of functions, each called by the next, the first again at the end."""
        graph = {caller: set(callees) for caller, callees in self.calls.items()}
        found = []
        while True:
            try:
                graphlib.TopologicalSorter(graph).prepare()
                return found
            except graphlib.CycleError as error:
                cycle = error.args[1]
                found.append(cycle)
                graph[cycle[1]].remove(cycle[0])

    def reached(self, roots, leave_out):
        """The functions that the roots reach, without what `leave_out` names and what lies behind."""
        seen, waiting = set(), list(roots)
        while waiting:
            function = waiting.pop()
            if function not in seen and not leave_out(function):
                seen.add(function)
                waiting += self.calls.get(function, ())
        return seen
