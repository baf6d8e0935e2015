#!/usr/bin/python3
"""What an operator does and reads, in the place of LinuxCNC's screen: homes, drives to places, with and without
compensation, and beyond the table of X. One line each to the file "read":

    place X Y Z LARGEST_um [uncorrected]   tool minus command there, the worst coordinate
    pins OUT FAR                           volcomp.x.out-of-range and far-out-of-range
    message TEXT
"""
import subprocess
import sys
import time

import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
read = open("read", "w", buffering=1, encoding="utf-8")


def pin(name):
    return subprocess.run(["halcmd", "getp", name], capture_output=True, text=True, check=True).stdout.strip()


def set_pin(name, value):
    subprocess.run(["halcmd", "setp", name, value], check=True)


def read_messages():
    while message := errors.poll():
        print("message", message[1].strip(), file=read)


def wait_until(true, what):
    end = time.monotonic() + 120
    while not true():
        if time.monotonic() > end:
            print("message waited in vain:", what, file=read)
            sys.exit(1)
        time.sleep(0.1)


def done():
    wait_until(lambda: command.wait_complete(5) != -1, "the end of a command")
    read_messages()


def deviations():
    return [1e3 * (float(pin(f"known.{axis}.tool")) - float(pin(f"joint.{joint}.pos-cmd"))) for joint, axis in enumerate("xyz")]


# Until nothing changes any more: no time is promised, and changes of the compensation are ramped in.
def at_rest():
    before = deviations()
    time.sleep(0.4)
    return deviations() == before


def tell_place(note=""):
    wait_until(at_rest, "standstill")
    status.poll()
    place = " ".join(f"{float(pin(f'joint.{joint}.pos-cmd')):g}" for joint in range(3))
    print(f"place {place} {max(abs(d) for d in deviations()):.2f} {note}".strip(), file=read)


def go(x, y, z):
    command.mdi(f"G1 X{x} Y{y} Z{z} F12000")
    done()


def all_homed():
    status.poll()
    read_messages()
    return all(status.homed[:3])


command.state(linuxcnc.STATE_ESTOP_RESET)
done()
command.state(linuxcnc.STATE_ON)
done()
command.mode(linuxcnc.MODE_MANUAL)
done()
command.teleop_enable(0)
done()
command.home(-1)
wait_until(all_homed, "homing")
command.mode(linuxcnc.MODE_MDI)
done()
command.mdi("G21 G90 G64 G54")
done()

for target in ((100, 50, -50), (400, 200, -250), (20, 380, -30), (740, 20, -480), (700, 350, -450)):
    go(*target)
    tell_place()
set_pin("volcomp.enable", "0")
tell_place("uncorrected")
set_pin("volcomp.enable", "1")
for x in (762, 790):
    go(x, 200, -250)
    wait_until(at_rest, "standstill")
    read_messages()
    print("pins", pin("volcomp.x.out-of-range"), pin("volcomp.x.far-out-of-range"), file=read)
go(400, 200, -250)
command.state(linuxcnc.STATE_OFF)
done()
print("end", file=read)
