#!/usr/bin/python3
"""volcomp monitor over logs written by hand: what is on the bus is known before it is watched.

    monitor_test.py VOLCOMP PROJECT_FOLDER
"""

import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

VOLCOMP, PROJECT = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1))
MACHINE = PROJECT / "host_sim/machines/xyfz.toml"
NODE, CONTROLLER = 0x20, 0x7F


class Log:
    """Lines of candump -L."""

    def __init__(self):
        self.lines = []

    def add(self, seconds, can_id, data):
        self.lines.append(f"({1700000000 + seconds:.6f}) vcan0 {can_id:03X}#{data.hex().upper()}")

    def cycle(self, seconds, counter, target_nm, offset_nm, axes=(1, 2, 3)):
        self.add(seconds, 0x080, bytes([counter]))
        for drive in axes:
            self.add(seconds + 1e-4, 0x180 + drive, struct.pack("<iHH", target_nm[drive - 1] + offset_nm[drive - 1], 0x1237, 0))
            self.add(seconds + 2e-4, 0x200 + drive, struct.pack("<Hi", 0x1F, target_nm[drive - 1]))
            self.add(seconds + 3e-4, 0x300 + drive, struct.pack("<i", offset_nm[drive - 1]))

    def text(self):
        return "\n".join(self.lines) + "\n"


def monitor(text, *arguments):
    done = subprocess.run([VOLCOMP, "monitor", "--log", "-", "--machine", MACHINE, *arguments], input=text,
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def seen(text, *arguments):
    code, out, err = monitor(text, "--json", *arguments)
    if code != 0:
        raise AssertionError(err)
    return [json.loads(line) for line in out.splitlines()]


class Monitor(unittest.TestCase):
    TARGET = (-123456789, 1, -2147483648)
    OFFSET = (-1500, 0, 20250)

    def axis(self, snapshot, letter):
        return next(a for a in snapshot["axes"] if a["axis"] == letter)

    def station(self, snapshot, can_id):
        return next(s for s in snapshot["stations"] if s["id"] == can_id)

    def test_positions_offsets_and_states(self):
        log = Log()
        for i in range(100):
            log.cycle(0.004 * i, i + 1, self.TARGET, self.OFFSET)
        log.add(0.4, 0x1A0, struct.pack("<IBBH", 0xCBF43926, 3, 100, 0))
        log.add(0.4, 0x700 + NODE, b"\x05")
        log.add(0.4, 0x700 + CONTROLLER, b"\x05")
        log.add(0.4, 0x701, b"\x7F")
        (s,) = seen(log.text(), "--once")
        self.assertEqual(s["frames"], len(log.lines))
        self.assertEqual(s["sync"]["lost"], 0)
        self.assertAlmostEqual(s["sync"]["mean_us"], 4000.0, delta=1.0)
        for letter, target, offset in zip("XYZ", self.TARGET, self.OFFSET):
            axis = self.axis(s, letter)
            self.assertEqual(axis["unit"], "mm")
            self.assertAlmostEqual(axis["target"], 1e-6 * target, places=9)
            # 6064h contains the offset.
            self.assertAlmostEqual(axis["actual"], 1e-6 * (target + offset), places=9)
            self.assertEqual(axis["offset_unit"], "um")
            self.assertAlmostEqual(axis["offset"], 1e-3 * offset, places=9)
            self.assertEqual(axis["cycles_incomplete"], 0)
            self.assertEqual(axis["status_word"], 0x1237)
        self.assertEqual(s["node"]["active_crc"], "CBF43926")
        self.assertEqual(s["node"]["state"], "compensating")
        self.assertEqual(self.station(s, NODE)["name"], "node")
        self.assertEqual(self.station(s, CONTROLLER)["name"], "controller")
        self.assertEqual(self.station(s, 1)["name"], "drive X")
        self.assertEqual(self.station(s, 1)["state"], "pre-operational")

    # The machine file says where the node is; an option knows better.
    def test_node_of_the_machine_file(self):
        log = Log()
        log.add(0.0, 0x700 + 40, b"\x05")
        log.add(0.1, 0x700 + 41, b"\x05")
        log.add(0.2, 0x080 + 40, bytes.fromhex("10FF810014000000"))
        with tempfile.TemporaryDirectory() as folder:
            machine = pathlib.Path(folder) / "machine.toml"
            machine.write_text(MACHINE.read_text().replace("\nnode_id = 32", "\nnode_id = 40"))
            for option, node in (([], 40), (["--node-id", "41"], 41)):
                done = subprocess.run([VOLCOMP, "monitor", "--log", "-", "--once", "--json", "--machine", machine, *option],
                                      input=log.text(), capture_output=True, text=True, check=True)
                s = json.loads(done.stdout)
                self.assertEqual(self.station(s, node)["name"], "node")
                self.assertEqual([e["who"] == "node" for e in s["emergencies"]], [node == 40])
        done = subprocess.run([VOLCOMP, "monitor", "--log", "-", "--once", "--json"], input="(1.000000) vcan0 720#05\n",
                              capture_output=True, text=True, check=True)
        self.assertEqual(self.station(json.loads(done.stdout), NODE)["name"], "node")

    # 100 frames of one data byte, 47 + 8 bits without stuff bits and 47 + 8 + 13 with all that there can be, in a second.
    def test_bus_load(self):
        log = Log()
        for i in range(101):
            log.add(0.01 * i, 0x123, b"\x55")
        first = seen(log.text(), "--rate-hz", "1")[0]
        self.assertGreaterEqual(first["load_percent"], 100 * 55 / 1e4)
        self.assertLessEqual(first["load_percent"], 100 * 68 / 1e4)

    def test_lost_sync_and_cycles(self):
        log = Log()
        counters = [238, 239, 240, 1, 2, 5, 6]
        for i, counter in enumerate(counters):
            log.cycle(0.004 * i, counter, self.TARGET, self.OFFSET, axes=(1, 2, 3) if i != 4 else (1, 3))
        (s,) = seen(log.text(), "--once")
        self.assertEqual(s["sync"]["lost"], 2)
        self.assertEqual([self.axis(s, letter)["cycles_incomplete"] for letter in "XYZ"], [0, 1, 0])

    def test_any_overflow_of_the_counter(self):
        for last in (2, 60, 239):
            log = Log()
            for i in range(5 * last):
                log.add(0.004 * i, 0x080, bytes([i % last + 1]))
            self.assertEqual([s["sync"]["lost"] for s in seen(log.text(), "--once")], [0], last)

    def test_a_clock_that_was_set_back(self):
        log = Log()
        for seconds in (10.0, 10.2, 10.15, 9.0, 9.3):
            log.add(seconds, 0x080, b"\x01")
        (s,) = seen(log.text(), "--once")
        self.assertAlmostEqual(s["time_s"], 0.5)

    def test_a_station_falls_silent_and_comes_back(self):
        log = Log()
        for i in range(60):
            log.add(0.1 * i, 0x700 + CONTROLLER, b"\x05")
            if i < 20 or i >= 40:
                log.add(0.1 * i, 0x700 + NODE, b"\x00" if i == 40 else b"\x05")
        silent = [self.station(s, NODE)["silent"] for s in seen(log.text(), "--rate-hz", "1")]
        self.assertEqual(silent[:2], [False, False])
        self.assertEqual(silent[2:4], [True, True])
        self.assertFalse(any(silent[4:]))
        self.assertFalse(any(self.station(s, CONTROLLER)["silent"] for s in seen(log.text())))

    def test_emergencies_in_words(self):
        log = Log()
        log.add(0.0, 0x700 + NODE, b"\x05")
        log.add(0.5, 0x080 + NODE, bytes.fromhex("10FF810014000000"))
        log.add(0.6, 0x080 + NODE, bytes.fromhex("0000000010FF0000"))
        log.add(0.7, 0x082, bytes.fromhex("1186010000000000"))
        (s,) = seen(log.text(), "--once")
        self.assertEqual([(round(e["time_s"], 3), e["who"]) for e in s["emergencies"]],
                         [(0.5, "node"), (0.6, "node"), (0.7, "drive Y")])
        self.assertIn("FF10h", s["emergencies"][0]["text"])
        self.assertTrue(s["emergencies"][1]["text"].startswith("gone: "))
        self.assertIn("FF10h", s["emergencies"][1]["text"])
        self.assertIn("8611h", s["emergencies"][2]["text"])
        code, out, _ = monitor(log.text(), "--once")
        self.assertEqual(code, 0)
        self.assertIn("EMCY at 0.500 s, node: ", out)

    def test_what_is_too_short_is_not_taken(self):
        log = Log()
        for can_id in (0x080, 0x1A0, 0x181, 0x201, 0x301, 0x720, 0x0A0, 0x081):
            for size in range(8):
                log.add(0.001, can_id, bytes(size))
        code, out, err = monitor(log.text(), "--once")
        self.assertEqual((code, err), (0, ""))
        self.assertNotIn("EMCY", out)

    def test_refusals(self):
        for text, wanted in (("", "standard input: holds no frames"), ("\n\n", "standard input: holds no frames"),
                             ("(1.000000) vcan0 080#0\n", "standard input:1: not a line of candump -L"),
                             ("\xff\xfe\x00\n", "standard input:1: not a line of candump -L")):
            code, out, err = monitor(text, "--json")
            self.assertEqual((code, out), (2, ""))
            self.assertEqual(err.count("\n"), 1)
            self.assertIn(wanted, err)
        for arguments, wanted in (([], "--can or --log"), (["--can", "vcan0", "--log", "-"], "--can or --log"),
                                  (["--can", "loopback"], "nothing to be heard"), (["--can", "no-such-can0"], "no-such-can0"),
                                  (["--log", "/no/such"], "/no/such: cannot be opened")):
            done = subprocess.run([VOLCOMP, "monitor", *arguments], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(wanted, done.stderr)


# A machine in motion, seen in the log of it: the last words of the bus, read here by other means.
class Campaign(unittest.TestCase):
    def test_last_values(self):
        lines = self.recorded(60000)
        last = {}
        for line in lines:
            can_id, _, data = line.split()[2].partition("#")
            last[can_id] = bytes.fromhex(data)
        (s,) = seen("\n".join(lines) + "\n", "--once")
        self.assertEqual(s["frames"], len(lines))
        for number, letter in enumerate("XYZ", start=1):
            axis = self.axis_of(s, letter)
            self.assertAlmostEqual(axis["target"], 1e-6 * struct.unpack("<i", last[f"20{number}"][2:6])[0], places=9)
            self.assertAlmostEqual(axis["actual"], 1e-6 * struct.unpack("<i", last[f"18{number}"][0:4])[0], places=9)
            self.assertAlmostEqual(axis["offset"], 1e-3 * struct.unpack("<i", last[f"30{number}"][0:4])[0], places=9)
        self.assertEqual(s["node"]["active_crc"], f"{struct.unpack('<I', last['1A0'][:4])[0]:08X}")

    # Of the second machine of the campaign, the first with tables; who reads no more ends the run.
    @staticmethod
    def recorded(count):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "bus.fifo"
            os.mkfifo(log)
            with subprocess.Popen([VOLCOMP, "run", "xyfz", "--draws", "0", "--volume-points", "10", "--can", "loopback",
                                   "--log", log], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
                lines, machines = [], 0
                with log.open() as stream:
                    for line in stream:
                        machines += " 000#8100" in line
                        if machines == 2:
                            lines.append(line.rstrip("\n"))
                        if len(lines) == count:
                            return lines
        raise AssertionError("the campaign ended too early")

    @staticmethod
    def axis_of(snapshot, letter):
        return next(a for a in snapshot["axes"] if a["axis"] == letter)


if __name__ == "__main__":
    unittest.main()
