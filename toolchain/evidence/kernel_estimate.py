"""Cycles of the folded kernel on a Cortex-M7 as llvm-mca estimates them from GCC's assembly.

An estimate: LLVM's model of the dual-issue pipeline, memory that answers at once, no branches, one call after the other.
"""
import json
import pathlib
import re
import shlex
import subprocess
import tempfile

from failure import Failure

SOURCE = pathlib.Path(__file__).parent / "folded_kernel.cpp"
FUNCTION = re.compile(r"^(_ZN7volcomp13folded_kernel\w+):\n(.*?)^\t\.size\t\1", re.M | re.S)
ITERATIONS = 100


def compile_command(build, source_end):
    """The compiler and flags the build uses for one of its sources."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if entry["file"].endswith(source_end):
            words = shlex.split(entry["command"])
            words = [w for w in words if not w.endswith("ccache")]
            return words[:words.index("-o")]
    raise Failure(f"{build} does not compile {source_end}: configure it again.")


def estimate(build):
    """{instructions, cycles} of one call."""
    command = compile_command(build, "comp/tick/instances.cpp")
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "kernel.s"
        run = subprocess.run([*command, "-g0", "-S", "-o", str(out), str(SOURCE)], capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise Failure(f"{SOURCE.name} does not compile: {run.stderr}")
        text = out.read_text()
    function = FUNCTION.search(text)
    if not function:
        raise Failure(f"{SOURCE.name} has no folded_kernel in its assembly.")
    body = re.sub(r"^\t\.(?!L).*\n", "", function.group(2), flags=re.M)
    run = subprocess.run(["llvm-mca", "-mtriple=thumbv7em-none-eabihf", "-mcpu=cortex-m7", "-mattr=+fp64",
                          f"-iterations={ITERATIONS}"],
                         input=".syntax unified\n" + body, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"llvm-mca cannot read the assembly of GCC: {run.stderr}")
    figures = dict(re.findall(r"^(\w[\w ]*):\s+(\d+)$", run.stdout, flags=re.M))
    return {"instructions": int(figures["Instructions"]) // ITERATIONS,
            "cycles": round(int(figures["Total Cycles"]) / ITERATIONS)}
