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
import signal
import struct
import sys
import termios
import time

LONGEST_S = 120
INTERRUPT, SUSPEND = "\x03", "\x1a"  # Ctrl+C, Ctrl+Z
MARK = "/usr/lib/mark-of-the-caller"
TRIES = 3


class Broken(Exception):
    """The conversation ended where it should have gone on."""


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
            os.kill(self.process, signal.SIGTERM)
            os.waitpid(self.process, 0)
            raise Broken(f"{LONGEST_S} s in vain; said so far:\n{self.said}")
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
                code = os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])
                raise Broken(f"it ended with exit code {code} before \"{pattern}\"; said:\n{self.said}")
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


def converse(terminal):
    settings = termios.tcgetattr(terminal.fd)
    terminal.ask("echo $((40 + 2))=the-answer", "42=the-answer")
    terminal.ask("ip -o link show vcan0 | grep -c UP; echo up-$?", r"up-0")
    terminal.ask('echo "[$PATH]"', re.escape(f":{MARK}]"))
    terminal.ask('echo "<$(stty size)>" "<$TERM>"', "<33 101> <vt100>")

    # Ctrl+C ends what runs in the foreground, and nothing else. What runs says itself that it does; the program that
    # sleeps has been read from the shared files by then.
    terminal.ask("bash -c 'sleep 0; echo begin-$((1 + 1)); sleep 10000'", "begin-2")
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
        raise Broken(f"exit code {code} instead of 7; said:\n{terminal.said}")
    if termios.tcgetattr(terminal.fd) != settings:
        raise Broken("the terminal is not left as it was found")


# An emulated machine now and then stops for reasons of its own, on a busy computer above all: the conversation begins
# anew, and says so. What is wrong with the shell is wrong every time.
for attempt in range(1, TRIES + 1):
    try:
        converse(Terminal(sys.argv[1:]))
        break
    except Broken as broken:
        print(f"again: conversation {attempt} of {TRIES}: {broken}", flush=True)
else:
    sys.exit("FAILED: no conversation came to its end")
print("a shell at a terminal: answers, vcan0, PATH, size, Ctrl+C, job control, exit code, terminal as before")
