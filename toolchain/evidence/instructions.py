"""What each Thumb-2 instruction, as objdump prints it, does to the stack pointer and to the flow of control.

Armv7-M Architecture Reference Manual (Arm DDI 0403), A7. Whatever changes the stack pointer in a way that is not known here
is reported, never guessed.
"""
import dataclasses
import re

CONDITIONS = ("eq", "ne", "cs", "cc", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le", "hs", "lo")
REGISTER_RANGE = re.compile(r"([a-z]+)(\d+)-[a-z]+(\d+)")
TABLE_OF_ADDRESSES = re.compile(r"pc, \[(\w+), (\w+), lsl #2\]$")
ONLY_READS = {"cmp", "cmn", "tst", "str", "strd", "stm", "stmia", "stmdb", "ldm", "ldmia"}  # their first operand
BRANCHES = {"b", "bl", "bx", "blx", "cbz", "cbnz", "tbb", "tbh"}


@dataclasses.dataclass
class Instruction:
    address: int
    mnemonic: str
    operands: str
    size: int = 2

    def __str__(self):
        return f"{self.address:x}: {self.mnemonic} {self.operands}"


@dataclasses.dataclass
class Effect:
    grows: int = 0        # bytes the stack grows by (negative: shrinks)
    returns: bool = False
    ends: bool = False    # nothing follows it
    call: int = None      # address called
    jump: int = None      # address jumped to
    register: str = None  # register called or jumped through
    table: int = None     # bytes per entry of a jump table
    problem: str = None


def base_of(mnemonic):
    """Mnemonic without width, and whether it is conditional: `bne.n` is (b, True), `popeq` is (pop, True)."""
    name = mnemonic.split(".")[0]
    if name in BRANCHES:
        return name, name in ("cbz", "cbnz")
    if name.endswith(CONDITIONS) and len(name) > 2:
        stem = name[:-2]
        if stem in ("b", "bl", "bx", "blx", "pop", "push", "ldr", "ldmia", "stmdb", "str", "strd", "ldrd", "mov", "add", "sub",
                    "addw", "subw", "vpush", "vpop", "vldmia", "vstmdb", "tbb", "tbh"):
            return stem, True
    return name, False


def registers(text, each):
    """Bytes of a register list such as {r4, r5, d8-d15, lr}."""
    count = 0
    for part in re.search(r"\{(.*?)\}", text).group(1).split(","):
        spread = REGISTER_RANGE.fullmatch(part.strip())
        count += int(spread.group(3)) - int(spread.group(2)) + 1 if spread else 1
    return count * each


def listed(text):
    """Bytes of a list of core or floating-point registers."""
    return registers(text, 8 if "{d" in text else 4)


def immediate(text):
    found = re.search(r"#(-?\d+)", text)
    return int(found.group(1)) if found else None


def branch_target(operands):
    found = re.match(r"(?:\w+, )?([0-9a-f]+)(?: <.*)?$", operands)
    return int(found.group(1), 16) if found else None


def effect(instruction):
    name, conditional = base_of(instruction.mnemonic)
    operands = instruction.operands
    result = _flow(name, operands) or _stack(name, operands) or _unknown(name, operands) or Effect()
    if conditional:
        if result.grows and not result.returns:
            result.problem = "changes the stack on a condition"
        result.ends = False
        result.grows = 0
    elif result.returns:
        result.ends = True
    return result


def _flow(name, operands):
    if name in ("b", "cbz", "cbnz"):
        return Effect(jump=branch_target(operands), ends=name == "b")
    if name == "bl":
        return Effect(call=branch_target(operands))
    if name == "blx":
        return Effect(register=operands.strip())
    if name == "bx":
        return Effect(returns=True) if operands.strip() == "lr" else Effect(register=operands.strip(), ends=True)
    if name in ("tbb", "tbh"):
        return Effect(table=1 if name == "tbb" else 2, ends=True)
    if name == "udf":
        return Effect(ends=True)
    if name == "mov" and operands.startswith("pc, lr"):
        return Effect(returns=True)
    if name in ("ldr", "mov", "add") and operands.startswith("pc,"):
        if name == "ldr" and re.match(r"pc, \[sp\], #\d+$", operands):
            return Effect(returns=True, grows=-immediate(operands))
        if name == "ldr" and TABLE_OF_ADDRESSES.match(operands):
            return Effect(table=4, ends=True)
        return Effect(ends=True, problem="jumps through memory or a computed address")
    return None


def _stack(name, operands):
    on_stack = re.match(r"sp!, \{", operands)
    if name == "push" or (name in ("stmdb", "vstmdb") and on_stack) or name == "vpush":
        return Effect(grows=listed(operands))
    if name == "pop" or (name in ("ldmia", "vldmia", "ldm") and on_stack) or name == "vpop":
        return Effect(grows=-listed(operands), returns=bool(re.search(r"\bpc\b", operands)))
    if name in ("sub", "subw", "add", "addw") and re.match(r"sp, (sp, )?#-?\d+$", operands):
        return Effect(grows=immediate(operands) * (1 if name.startswith("sub") else -1))
    if name in ("str", "strd", "strb", "strh") and (found := re.search(r"\[sp, #-(\d+)\]!", operands)):
        return Effect(grows=int(found.group(1)))
    if name in ("ldr", "ldrd", "ldrb", "ldrh") and (found := re.search(r"\[sp\], #(\d+)$", operands)):
        return Effect(grows=-int(found.group(1)))
    return None


def _unknown(name, operands):
    if re.match(r"sp\b", operands) and name not in ONLY_READS:
        return Effect(problem="sets the stack pointer to what is known at run time only")
    if re.search(r"\[sp.*\]!|\bsp!|\[sp\], ", operands):
        return Effect(problem="changes the stack pointer in an unknown way")
    if name == "msr" and re.match(r"(?i)[mp]sp\b", operands):
        return Effect(problem="switches the stack")
    return None
