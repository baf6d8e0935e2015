"""A controller and three drives that follow forwarded targets, around a node on a CAN interface that it may take away.

    forwarding_bus.py INTERFACE NODE_PROCESS WHAT_THE_NODE_SAYS

Every frame of the bus is judged in its order: the node may send each target of the controller once, before the next SYNC.
The node stands still for 50 ms, then the interface is removed. Ends with an assertion where the node forwards anything
that it must not.
"""

import os
import signal
import socket
import struct
import subprocess
import sys
import time

INTERFACE, PROCESS, SAID = sys.argv[1], int(sys.argv[2]), sys.argv[3]
NODE = 32
PERIOD_S = 0.01
PATIENCE_S = 30
FORWARDING_ENDED = struct.pack("<H", 0xFF23)


class Bus:
    def __init__(self):
        self.counter = 0
        self.position = 0
        self.enabled = False
        self.open()

    def open(self):
        self.socket = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_RECV_OWN_MSGS, 1)
        self.socket.setblocking(False)
        self.socket.bind((INTERFACE,))
        self.due = [None] * 3  # targets since SYNC that the node has not forwarded
        self.forwarded = self.heartbeats = 0
        self.ended = self.incomplete = None

    def send(self, identifier, data):
        self.socket.send(struct.pack("<IB3x8s", identifier, len(data), data))

    # All that is there, in the order of the bus. Gives the answers to SDO requests.
    def listen(self):
        answers = []
        while True:
            try:
                frame = self.socket.recv(16)
            except BlockingIOError:
                return answers
            identifier, size, data = struct.unpack("<IB3x8s", frame)
            axis = (identifier & 0x7F) - 1
            if identifier == 0x080:
                self.due = [None] * 3
            elif identifier in (0x201, 0x202, 0x203):
                self.due[axis] = data[2:6]
            elif identifier in (0x301, 0x302, 0x303):
                assert self.due[axis] == data[:4], "a target that is old, made up or sent twice"
                self.due[axis] = None
                self.forwarded += 1
            elif identifier == 0x080 + NODE and data[:2] == FORWARDING_ENDED:
                self.ended = True
            elif identifier == 0x180 + NODE:
                self.incomplete = (data[7] & 0x80) != 0  # bit 15 of 2600h:03, the last of the four values
            elif identifier == 0x700 + NODE:
                self.heartbeats += 1
            elif identifier == 0x580 + NODE:
                answers.append(data)

    def wait_for(self, what, condition):
        end = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < end, f"waited in vain for: {what}"
            time.sleep(0.001)

    def write(self, index, sub, form, value):
        data = struct.pack("<" + form, value)
        command = 0x23 | (4 - len(data)) << 2
        self.send(0x600 + NODE, struct.pack("<BHB", command, index, sub) + data.ljust(4, b"\0"))
        answers = []
        self.wait_for("an answer", lambda: answers.extend(self.listen()) or answers)
        assert answers[0][0] == 0x60, f"{index:04X}h:{sub:02X} is refused: {answers[0].hex()}"

    def configure(self):
        self.write(0x1006, 0, "I", round(PERIOD_S * 1e6))
        self.write(0x1029, 1, "B", 1)
        for drive in (1, 2, 3):
            self.write(0x2010, drive, "B", drive)
            self.write(0x2034, drive, "B", 1)
            self.write(0x2037, drive, "B", 1)

    # The next SYNC comes when the node has forwarded all, or after the patience: nothing depends on its speed.
    def cycle(self, patience_s):
        self.counter = self.counter % 240 + 1
        self.position += 10_000_000 if self.enabled else 0  # 1 m/s at 100 Hz
        self.send(0x080, bytes([self.counter]))
        for drive in (1, 2, 3):
            status = 0x0127 if self.enabled else 0x0121
            self.send(0x180 + drive, struct.pack("<iHb", self.position, status, 8))
        for drive in (1, 2, 3):
            command = 0x0F if self.enabled else 0x06
            self.send(0x200 + drive, struct.pack("<Hi", command, self.position))
        self.listen()
        end = time.monotonic() + patience_s
        while any(self.due) and time.monotonic() < end:
            time.sleep(0.001)
            self.listen()
        return not any(self.due)

    # Each ends after its period, whatever the node does.
    def timed_cycles(self, count):
        for _ in range(count):
            self.cycle(PERIOD_S)

    # NMT start, drives disabled, then in motion.
    def begin(self):
        self.enabled = False
        self.send(0x000, bytes([0x80, NODE]))
        self.send(0x000, bytes([0x01, NODE]))
        self.move_from_rest()

    def move_from_rest(self):
        self.enabled = False
        self.wait_for("targets of disabled drives", lambda: self.cycle(0.5))
        self.ended, self.enabled = None, True
        for _ in range(20):
            assert self.cycle(PATIENCE_S), "a target is missing"
        self.wait_for("bit 15 of 2600h:03 is 0", lambda: self.cycle(PATIENCE_S) and self.incomplete is False)
        assert not self.ended

    # Nothing leaves while the drives stay enabled.
    def expect_ended(self):
        self.wait_for("bit 15 of 2600h:03", lambda: self.cycle(PERIOD_S) or self.incomplete)
        self.heartbeats = 0
        self.timed_cycles(20)
        assert self.forwarded == 0, "a target after the end of forwarding"
        assert self.heartbeats == 0


def stand_still(bus):
    # It is idle: all of the last cycle has left.
    os.kill(PROCESS, signal.SIGSTOP)
    bus.forwarded = 0
    bus.timed_cycles(round(0.05 / PERIOD_S))
    os.kill(PROCESS, signal.SIGCONT)
    bus.wait_for("EMCY FF23h", lambda: bus.cycle(PERIOD_S) or bus.ended)
    bus.expect_ended()
    bus.move_from_rest()


def says(text):
    with open(SAID, encoding="utf-8") as said:
        return text in said.read()


def lose_interface(bus):
    subprocess.run(["ip", "link", "del", "dev", INTERFACE], check=True)
    bus.socket.close()
    bus.wait_for("the node misses its interface", lambda: says("the interface is down or gone"))
    subprocess.run(["ip", "link", "add", "dev", INTERFACE, "type", "vcan"], check=True)
    subprocess.run(["ip", "link", "set", "dev", INTERFACE, "up"], check=True)
    bus.open()
    bus.wait_for("the node has its interface back", lambda: says("the interface is back"))
    bus.expect_ended()
    bus.begin()


def main():
    bus = Bus()
    bus.configure()
    bus.begin()
    stand_still(bus)
    lose_interface(bus)


main()
