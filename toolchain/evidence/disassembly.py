"""The instructions of an image, as objdump prints them."""
import re
import subprocess

from failure import Failure
from instructions import Instruction

OBJDUMP = {"EM_ARM": "arm-none-eabi-objdump", "EM_AARCH64": "aarch64-linux-gnu-objdump", "EM_X86_64": "objdump"}
COMMENT = re.compile(r"\s*(?:[@;#]|//) ")
WIDE = ("bl", "tbb", "tbh")  # where no following code shows it
LINE = re.compile(r"^\s*([0-9a-f]+):\t(\S+)(?:\s+(.*))?$")


def disassemble(image):
    """{address: instruction}"""
    run = subprocess.run([OBJDUMP[image.machine], "-d", "--no-show-raw-insn", "-w", str(image.path)],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"{OBJDUMP[image.machine]} cannot read {image.path}: {run.stderr.strip()}")
    code, last = {}, None
    for line in run.stdout.splitlines():
        found = LINE.match(line)
        if not found or found.group(2).startswith("."):
            last = None
            continue
        address = int(found.group(1), 16)
        operands = COMMENT.split(found.group(3) or "", 1)[0].strip()
        if last is not None:
            last.size = address - last.address
        last = code[address] = Instruction(address, found.group(2), operands,
                                           4 if found.group(2) in WIDE or found.group(2).endswith(".w") else 2)
    return code
