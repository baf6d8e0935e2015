#!/usr/bin/env python3
"""Freezes the background of the node image with a debugger while its tick goes on: the watchdog has to restart it.

    tests/target/node/frozen_background_test.py BOARD IMAGE

The limits are those of firmware/node/guardian.hpp (a background is overdue after 100 ms) and of the image (the
watchdog bites 20 ms after the last food); a turn of the frame pipe is a millisecond.
"""
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

RUN_FIRMWARE = pathlib.Path(__file__).resolve().parents[3] / "toolchain" / "run-firmware"
NODE_ID = 32
HEARTBEAT, EMERGENCY, END_OF_TURN, QUIT = 0x700 + NODE_ID, 0x080 + NODE_ID, 0xFFFFFFFE, 0xFFFFFFFF
RESTARTED_BY_WATCHDOG = 0x6010  # CiA 301, 7.2.7.1: software reset (watchdog)
OVERDUE, BITE, SLACK = 100, 20, 5  # ms

# Where main calls background_step() the tick is not masked: there the processor is sent into a loop ("b ."). The
# time of the last turn tells when.
FREEZE = """
set confirm off
set pagination off
target remote gdb.socket
tbreak {place}
continue
set {{unsigned short}}$pc = 0xe7fe
printf "frozen at %llu us\\n", '(anonymous namespace)::link'.pipe_.now_us_
detach
"""


started = []  # processes, ended with the test whatever happens


def turn(to_node, from_node, now_us):
    """One turn; returns the frames of the node as (identifier, data)."""
    to_node.write(struct.pack("<IB3xQ", END_OF_TURN, 0, now_us))
    frames = []
    while True:
        record = from_node.read(16)
        if len(record) < 16:
            sys.exit("the node image has ended")
        identifier, size, data = struct.unpack("<IB3x8s", record)
        if identifier == END_OF_TURN:
            return frames
        frames.append((identifier, data[:size]))


def line_of(text):
    source = pathlib.Path(__file__).resolve().parents[3] / "firmware/boards/mps2/node_main.cpp"
    lines = source.read_text().splitlines()
    return f"node_main.cpp:{next(n for n, line in enumerate(lines, 1) if text in line)}"


def run(board, image):
    os.mkfifo("to_node")
    os.mkfifo("from_node")
    output = open("output", "w")
    node = subprocess.Popen([RUN_FIRMWARE, board, image, "pipe", "--", "-gdb", "unix:gdb.socket,server=on,wait=off"],
                            stdout=output, stderr=output)
    started.append(node)
    pathlib.Path("freeze.gdb").write_text(FREEZE.format(place=line_of("background_step()")))
    with open("to_node", "wb", buffering=0) as to_node, open("from_node", "rb") as from_node:
        now_us, debugger = 0, None
        for count in range(20000):
            now_us += 1000
            frames = turn(to_node, from_node, now_us)
            if count == 50:
                debugger = subprocess.Popen(["gdb-multiarch", "-batch", "-nx", "-x", "freeze.gdb", image],
                                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                started.append(debugger)
            if count > 50 and (HEARTBEAT, b"\0") in frames:
                break
        else:
            sys.exit("nothing restarted the node")
        restarted_us = now_us
        emergencies = [data for identifier, data in frames if identifier == EMERGENCY]
        for _ in range(10):
            now_us += 1000
            frames = turn(to_node, from_node, now_us)
            emergencies += [data for identifier, data in frames if identifier == EMERGENCY]
        to_node.write(struct.pack("<IB3xQ", QUIT, 0, 0))
        code = node.wait()
    text = pathlib.Path("output").read_text()
    said = debugger.communicate()[0]
    frozen = re.search(r"frozen at (\d+) us", said)
    if frozen is None:
        sys.exit(f"the debugger did not freeze it:\n{said}")
    waited = (restarted_us - int(frozen.group(1))) / 1000
    print(f"restarted {waited} ms after the background froze")
    if not OVERDUE <= waited <= OVERDUE + BITE + SLACK:
        sys.exit("that is too early or too late")
    if "WATCHDOG: nobody fed it in time" not in text:
        sys.exit(f"there is no report of the watchdog\n{text}")
    if RESTARTED_BY_WATCHDOG not in [int.from_bytes(data[:2], "little") for data in emergencies]:
        sys.exit(f"no emergency tells of the restart: {[data.hex() for data in emergencies]}")
    if code != 0:
        sys.exit(f"the restarted node ended with {code}\n{text}")


def main():
    board, image = sys.argv[1], os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            run(board, image)
        finally:
            for process in started:
                process.kill()
            os.chdir("/")


if __name__ == "__main__":
    main()
