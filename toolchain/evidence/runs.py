"""Runs an image on its emulated board and reads the figures it prints: lines of a word and fields name=value."""
import re
import subprocess

from failure import Failure

LINE = re.compile(r"^(\w+)((?: \w+=\S+)+)$")


def run(root, board, image, timeout=180):
    """What the image printed; anything but exit code 0 is a failure."""
    command = ["bash", str(root / "toolchain/run-firmware"), board, str(image)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False, cwd=root)
    except subprocess.TimeoutExpired as error:
        raise Failure(f"{image.name} was still running after {timeout} s.") from error
    if done.returncode != 0:
        raise Failure(f"{image.name} ended with exit code {done.returncode}: {(done.stdout + done.stderr).strip()[-500:]}")
    return done.stdout


def figures(text):
    """[(word, {name: value})], whole numbers as such."""
    found = []
    for line in text.splitlines():
        if match := LINE.match(line.strip()):
            fields = dict(field.split("=", 1) for field in match.group(2).split())
            found.append((match.group(1), {k: int(v) if v.isdigit() else v for k, v in fields.items()}))
    return found
