"""Every way through the code of an image: depth of the stack at each instruction, calls, and what cannot be followed.

Flow is followed address by address from an entry, across tail jumps into other functions; calls are entries of their own.
"""
import dataclasses
import re
import struct

import instructions
from disassembly import disassemble


@dataclasses.dataclass
class Routine:
    """Code reached from one entry without a call."""
    entry: int
    frame: int = 0
    returns: bool = False
    calls: dict = dataclasses.field(default_factory=dict)     # entry called: depth of the stack there
    indirect: dict = dataclasses.field(default_factory=dict)  # address of the call: depth of the stack there
    symbols: set = dataclasses.field(default_factory=set)     # functions whose code it runs through
    problems: list = dataclasses.field(default_factory=list)


class CodeFlow:
    def __init__(self, image):
        self.image = image
        self.code = disassemble(image)
        self._routines = {}

    def routine(self, entry):
        """The routine at an entry; each is followed once."""
        if entry not in self._routines:
            self._routines[entry] = Routine(entry, returns=True)  # while a cycle is being followed
            self._routines[entry] = self._follow(entry)
        return self._routines[entry]

    def name(self, address):
        symbol = self.image.function_at(address)
        return self.image.plain(symbol) if symbol else f"0x{address:x}"

    def _follow(self, entry):
        routine = Routine(entry)
        seen, work = {}, [(entry, 0)]
        while work:
            address, depth = work.pop()
            if address in seen:
                if seen[address] != depth:
                    routine.problems.append(f"{self.name(address)} is reached with {seen[address]} and with {depth} bytes "
                                            f"of stack at 0x{address:x}")
                continue
            seen[address] = depth
            work.extend(self._step(routine, address, depth))
            if len(routine.problems) > 5:
                break
        return routine

    def _step(self, routine, address, depth):
        instruction = self.code.get(address)
        if instruction is None:
            routine.problems.append(f"{self.name(routine.entry)} runs into 0x{address:x}, where there is no instruction")
            return []
        symbol = self.image.function_at(address)
        if symbol:
            routine.symbols.add(symbol.name)
        effect = instructions.effect(instruction)
        if effect.problem:
            routine.problems.append(f"{self.name(address)} {effect.problem}: {instruction}")
        routine.returns = routine.returns or effect.returns
        routine.frame = max(routine.frame, depth + max(effect.grows, 0))
        following = [] if effect.ends else [(address + instruction.size, depth + effect.grows)]
        if effect.register is not None:
            routine.indirect[address] = max(depth, routine.indirect.get(address, 0))
            routine.returns = routine.returns or effect.ends
        if effect.call is not None:
            routine.calls[effect.call] = max(depth, routine.calls.get(effect.call, 0))
            if not self.routine(effect.call).returns:
                return []
        if effect.jump is not None:
            following.append((effect.jump, depth))
        if effect.table is not None:
            targets = self._table(instruction, effect.table)
            if targets is None:
                routine.problems.append(f"{self.name(address)} has a jump table of unknown length: {instruction}")
            following += [(target, depth) for target in targets or ()]
        return following

    def _table(self, jump, width):
        """Targets of tbb and tbh (A7.7.185), offsets in halfwords from the table that follows, and of a load of pc from a table
        of addresses. How many there are, the comparison before the jump tells."""
        base, index = re.match(r"(?:pc, )?\[(\w+), (\w+)", jump.operands).groups()
        before = [self.code[a] for a in sorted(a for a in self.code if jump.address - 24 <= a < jump.address)]
        limits = [instructions.immediate(i.operands) for i in before
                  if i.mnemonic.startswith("cmp") and i.operands.startswith(f"{index}, #")]
        start = jump.address + jump.size if width < 4 else self._loaded_address(before[-1], base)
        if not limits or start is None:
            return None
        raw = self.image.read(start, width * (limits[-1] + 1))
        if width == 4:
            return {target & ~1 for target, in struct.iter_unpack("<I", raw)}
        return {start + 2 * offset for offset, in struct.iter_unpack("<B" if width == 1 else "<H", raw)}

    @staticmethod
    def _loaded_address(instruction, register):
        """What `add register, pc, #n` leaves in the register."""
        found = re.match(rf"{register}, pc, #(\d+)$", instruction.operands)
        if not found or not instruction.mnemonic.startswith("add"):
            return None
        return (instruction.address + 4 & ~3) + int(found.group(1))
