#!/usr/bin/python3
"""toolchain/with-vcan bash as its user meets it: somebody types at a terminal, in the virtual machine as on the running
kernel.

    terminal.py WITH_VCAN [ARGUMENT...]      what to start, for instance toolchain/with-vcan --vm bash
"""

import fcntl
import os
import pty
import re
import select
import struct
import sys
import termios
import time

LONGEST_S = 240
INTERRUPT, SUSPEND = "\x03", "\x1a"  # Ctrl+C, Ctrl+Z
MARK = "/usr/lib/mark-of-the-caller"


class Terminal:
    def __init__(self, command):
        self.said = ""
        self.process, self.fd = pty.fork()
        if self.process == 0:
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 33, 101, 0, 0))
            os.execvpe(command[0], command, {**os.environ, "PATH": f"{os.environ['PATH']}:{MARK}", "TERM": "vt100"})

    def type(self, text):
        os.write(self.fd, text.encode())

    def read_more(self, end):
        if time.monotonic() > end or not select.select([self.fd], [], [], max(0.0, end - time.monotonic()))[0]:
            sys.exit(f"FAILED: {LONGEST_S} s in vain; said so far:\n{self.said}")
        try:
            piece = os.read(self.fd, 4096).decode(errors="replace")
        except OSError:  # the other end of a terminal is closed
            piece = ""
        self.said += piece
        return piece

    # Until what was said since the last one matches; commands are typed so that their echo does not.
    def expect(self, pattern):
        end = time.monotonic() + LONGEST_S
        while not (found := re.search(pattern, self.said)):
            if not self.read_more(end):
                sys.exit(f"FAILED: it ended before \"{pattern}\"; said:\n{self.said}")
        self.said = self.said[found.end():]
        return found

    def ask(self, command, pattern):
        self.type(command + "\n")
        return self.expect(pattern)

    def exit_code(self):
        end = time.monotonic() + LONGEST_S
        while self.read_more(end):
            pass
        return os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])


terminal = Terminal(sys.argv[1:])
settings = termios.tcgetattr(terminal.fd)
terminal.ask("echo $((40 + 2))=the-answer", "42=the-answer")
terminal.ask("ip -o link show vcan0 | grep -c UP; echo up-$?", r"up-0")
terminal.ask('echo "[$PATH]"', re.escape(f":{MARK}]"))
terminal.ask('echo "<$(stty size)>" "<$TERM>"', "<33 101> <vt100>")

# Ctrl+C ends what runs in the foreground, and nothing else. What runs says itself that it does.
terminal.ask("bash -c 'echo begin-$((1 + 1)); sleep 10000'", "begin-2")
terminal.type(INTERRUPT)
terminal.ask("echo after-$?-$((1 + 2))", "after-130-3")

# Job control.
terminal.ask("bash -c 'echo begin-$((2 + 2)); sleep 20000'", "begin-4")
terminal.type(SUSPEND)
terminal.expect("Stopped")
terminal.ask("bg; jobs", "Running .*sleep 20000")
terminal.ask("kill %1; wait; echo jobs-$(jobs | wc -l)", "jobs-0")

terminal.type("exit 7\n")
code = terminal.exit_code()
if code != 7:
    sys.exit(f"FAILED: exit code {code} instead of 7; said:\n{terminal.said}")
if termios.tcgetattr(terminal.fd) != settings:
    sys.exit("FAILED: the terminal is not left as it was found")
print("a shell at a terminal: answers, vcan0, PATH, size, Ctrl+C, job control, exit code, terminal as before")
