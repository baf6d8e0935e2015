"""Runs the node image over its frame pipe (hal/frame_pipe.hpp) through the deepest work there is; it tells how much stack it
took."""
import os
import pathlib
import re
import struct
import subprocess
import tempfile

from failure import Failure

END_OF_TURN, QUIT = 0xFFFFFFFE, 0xFFFFFFFF
RECORD = struct.Struct("<IB3x8s")
NODE = 32
TURN_US = 1000
PATIENCE = 20_000  # turns an answer may take


class Node:
    def __init__(self, root, board, image):
        self.folder = tempfile.TemporaryDirectory()
        self.clock_us = 0
        pipes = [pathlib.Path(self.folder.name) / name for name in ("to_node", "from_node")]
        for pipe in pipes:
            os.mkfifo(pipe)
        self.process = subprocess.Popen(["bash", str(root / "toolchain/run-firmware"), board, str(image)], cwd=self.folder.name,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.to_node, self.from_node = pipes[0].open("wb", buffering=0), pipes[1].open("rb")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.to_node.close()
        self.from_node.close()
        self.folder.cleanup()

    def turn(self, *frames):
        """One millisecond of the node: frames (identifier, data) in, frames out."""
        self.clock_us += TURN_US
        records = [RECORD.pack(identifier, len(data), data) for identifier, data in frames]
        self.to_node.write(b"".join(records) + RECORD.pack(END_OF_TURN, 0, struct.pack("<Q", self.clock_us)))
        answers = []
        while True:
            record = self.from_node.read(RECORD.size)
            if len(record) < RECORD.size:
                raise Failure(f"The node ended in the middle of a turn: {self.process.communicate()[0].strip()[-500:]}")
            identifier, size, data = RECORD.unpack(record)
            if identifier == END_OF_TURN:
                return answers
            answers.append((identifier, data[:size]))

    def ask(self, request):
        """The answer of the SDO server to one request (CiA 301, 7.2.4)."""
        frames = [(0x600 + NODE, request)]
        for _ in range(PATIENCE):
            for identifier, data in self.turn(*frames):
                if identifier == 0x580 + NODE:
                    if data[0] == 0x80:
                        index, sub, code = struct.unpack_from("<HBI", data, 1)
                        raise Failure(f"The node refused a request to {index:04X}h:{sub:02X}: abort code {code:08X}h.")
                    return data
            frames = []
        raise Failure("The node does not answer an SDO request.")

    def write(self, index, sub, value):
        address = struct.pack("<HB", index, sub)
        if len(value) <= 4:
            self.ask(bytes([0x23 | (4 - len(value)) << 2]) + address + value.ljust(4, b"\0"))
            return
        self.ask(b"\x21" + address + struct.pack("<I", len(value)))
        for number, at in enumerate(range(0, len(value), 7)):
            part = value[at:at + 7]
            last = at + 7 >= len(value)
            self.ask(bytes([(number & 1) << 4 | (7 - len(part)) << 1 | last]) + part.ljust(7, b"\0"))

    def quit(self):
        """What the node printed."""
        self.to_node.write(RECORD.pack(QUIT, 0, b""))
        try:
            said = self.process.communicate(timeout=30)[0]
        except subprocess.TimeoutExpired as error:
            raise Failure("The node does not quit.") from error
        if self.process.returncode != 0:
            raise Failure(f"The node ended with exit code {self.process.returncode}: {said.strip()[-500:]}")
        return said


def deepest_stack(root, board, image, tables):
    """Bytes of stack the node saw in use: an image is downloaded, checked, folded and stored; a reset loads and folds it again;
    then ticks with SYNC."""
    validate, arm, start, reset = b"\x01", b"\x02", 0x01, 0x81
    with Node(root, board, image) as node:
        node.write(0x2110, 1, tables)
        for command in (validate, arm):
            node.write(0x2111, 0, command)
        node.write(0x1010, 1, b"save")
        node.turn((0x000, bytes([reset, NODE])))
        for _ in range(1000):
            node.turn()
        node.turn((0x000, bytes([start, NODE])))
        for counter in range(1, 100):
            node.turn((0x080, bytes([counter])))
        said = node.quit()
    found = re.search(r"stack: (\d+) bytes", said)
    if not found:
        raise Failure(f"{image.name} does not say how much stack it took.")
    return int(found.group(1))
