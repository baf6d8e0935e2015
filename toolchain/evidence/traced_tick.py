"""One plain tick of a machine as it is executed: QEMU traces the instructions and registers of the image "trace". From them the cycles
that llvm-mca estimates for a Cortex-M7 and the lines of 32 bytes that code and data touch.

An estimate: LLVM's model of the dual-issue pipeline, memory that answers at once, branches taken as foreseen, the same tick again and again.
"""
import re
import subprocess
import tempfile

import disassembly
import elf
from failure import Failure

LINE_BYTES = 32
ITERATIONS = 100
# machine: its compensator
MACHINES = {"xyfz_compiled": r"CompiledMachine<volcomp::kXyfzMachine,", "five_axis_loaded": r"LoadedMachine<5u, 0u>"}
STEP = re.compile(r"^Trace \d+: \S+ \[[0-9a-f]+/([0-9a-f]+)/.*\n((?:.*=.*\n)+)", re.M)
REGISTER = re.compile(r"\bR(\d\d)=([0-9a-f]{8})")
NAMES = {"sp": 13, "lr": 14, "pc": 15, "ip": 12, "fp": 11, "sl": 10, "sb": 9}
MEMORY = re.compile(r"\[(\w+)(?:, (?:#(-?\d+)|(\w+)(?:, lsl #(\d+))?))?\](?:, #(-?\d+))?")
BYTES = {"strb": 1, "ldrb": 1, "ldrsb": 1, "strh": 2, "ldrh": 2, "ldrsh": 2, "ldrd": 8, "strd": 8}


def trace(image, machine):
    """[(address, registers)] of the last tick of this machine."""
    ticks = re.compile(rf"volcomp::Compensator<.*{machine}.*>::(tick|find_kept_excess)\(.*")
    functions = image.find(ticks)
    entry = next((f.address for f in functions if "4tickE" in f.name), None)
    if entry is None:
        raise Failure(f"{image.path.name} has no tick of {machine}.")
    ranges = ",".join(f"0x{f.address:x}+0x{f.size:x}" for f in functions)
    with tempfile.NamedTemporaryFile(suffix=".log") as log:
        command = ["qemu-system-arm", "-M", "mps2-an500", "-nographic", "-monitor", "none", "-serial", "null",
                   "-semihosting-config", "enable=on,target=native", "-kernel", str(image.path),
                   "-singlestep", "-d", "exec,nochain,cpu", "-dfilter", ranges, "-D", log.name]
        run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        if run.returncode != 0:
            raise Failure(f"{image.path.name} ended with exit code {run.returncode}: {run.stderr.strip()}")
        text = open(log.name, encoding="utf-8").read()
    steps = [(int(pc, 16), {int(n): int(v, 16) for n, v in REGISTER.findall(registers)}) for pc, registers in STEP.findall(text)]
    last = max((i for i, (pc, _) in enumerate(steps) if pc == entry), default=None)
    if last is None:
        raise Failure(f"QEMU traced no tick of {machine}.")
    return steps[last:]


def _number(name):
    return NAMES.get(name) if name in NAMES else int(name[1:]) if re.fullmatch(r"r\d+", name) else None


def span_of(instruction, registers):
    """(first, bytes) of the memory an instruction touches, or None."""
    name, operands = instruction.mnemonic.partition(".")[0], instruction.operands
    listed = re.search(r"\{(.*)\}", operands)
    if listed and re.match(r"v?(push|pop|ldm|stm)", name):
        ends = re.findall(r"([a-z]+)(\d*)(?:-[a-z]+(\d+))?", listed.group(1))
        count = sum(int(high) - int(low) + 1 if high else 1 for _, low, high in ends)
        size = count * (8 if ends[0][0] == "d" else 4)
        base = 13 if "push" in name or "pop" in name else _number(re.match(r"\w+", operands).group())
        down = "push" in name or "db" in name
        return registers[base] - (size if down else 0), size
    found = MEMORY.search(operands)
    if not found or not re.match(r"v?(ldr|str)", name):
        return None
    base, offset, index, shift, _ = found.groups()
    address = registers[_number(base)]
    if _number(base) == 15:
        address = (instruction.address + 4) & ~3
    if offset:
        address += int(offset)
    if index:
        address += registers[_number(index)] << int(shift or 0)
    wide = re.match(r"v(ldr|str)", name) and re.match(r"d\d", operands)
    return address & 0xFFFFFFFF, 8 if wide else BYTES.get(re.sub(r"(eq|ne|cs|cc|hi|ls|lt|ge|gt|le|pl|mi)$", "", name), 4)


def _lines(spans):
    return {line for first, size in spans for line in range(first // LINE_BYTES, (first + size - 1) // LINE_BYTES + 1)}


def constant(encoded):
    """The constant of a vmov (Armv7-M, A6.4.1)."""
    exponent = (encoded >> 4 & 3) - 3 if encoded & 64 else (encoded >> 4 & 3) + 1
    return (-1 if encoded & 128 else 1) * 2.0 ** exponent * (16 + (encoded & 15)) / 16


def _assembly(instruction):
    """As llvm-mca reads it: branches lead nowhere, a jump by a table is a load and a branch."""
    name, operands = instruction.mnemonic, instruction.operands
    if name.startswith(("tbb", "tbh")):
        return "ldrb r12, [sp]\n bx r12"
    if re.match(r"(b|bl|cb)(eq|ne|cs|cc|hi|ls|lt|ge|gt|le|pl|mi|z|nz)?(\.[nw])?$", name):
        operands = re.sub(r"[0-9a-f]+ <.*>", "nowhere", operands)
    if re.match(r"vmov.*\.f", name):
        operands = re.sub(r"#(\d+)", lambda encoded: f"#{constant(int(encoded[1]))}", operands)
    return f"{name} {operands}"


def _straight(code):
    """Lines for llvm-mca, which knows no IT blocks: their instructions without the condition, the IT as one that does nothing."""
    lines, conditional = [], 0
    for i in code:
        line = _assembly(i)
        if re.match(r"it[te]{0,3}$", i.mnemonic):
            conditional, line = len(i.mnemonic) - 1, "nop"
        elif conditional > 0:
            conditional -= 1
            line = re.sub(r"^(\w+?)(eq|ne|cs|cc|hi|ls|lt|ge|gt|le|pl|mi|vs|vc)(?=[. ])", r"\1", line)
        lines.append(line)
    return lines


def cycles(code):
    """What llvm-mca estimates for these instructions, once."""
    text = ".syntax unified\n" + "\n".join(_straight(code)) + "\n"
    run = subprocess.run(["llvm-mca", "-mtriple=thumbv7em-none-eabihf", "-mcpu=cortex-m7", "-mattr=+fp64", f"-iterations={ITERATIONS}"],
                         input=text, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"llvm-mca cannot read the traced instructions: {run.stderr[:500]}")
    figures = dict(re.findall(r"^(\w[\w ]*):\s+(\d+)$", run.stdout, flags=re.M))
    return round(int(figures["Total Cycles"]) / ITERATIONS)


def measure(path):
    """{machine: {instructions, cycles, code_lines, data_lines}}"""
    image = elf.Image(path)
    known = disassembly.disassemble(image)
    found = {}
    for name, machine in MACHINES.items():
        steps = trace(image, machine)
        code = [known[pc] for pc, _ in steps]
        constants = [span for i, (_, r) in zip(code, steps) if (span := span_of(i, r))]
        found[name] = {"instructions": len(code), "cycles": cycles(code), "code_lines": len(_lines([(i.address, i.size) for i in code])),
                       "data_lines": len(_lines(constants))}
    return found
