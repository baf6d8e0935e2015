#!/usr/bin/python3
"""Does what a page of the documentation tells its reader to do, word for word, and looks whether it answers as the page says.

    run_docs.py [--needs WORD]... [--list] PAGE...

All ```sh blocks of a page run one after the other, in one shell and in an empty folder that is removed at the end; a command
that fails ends the page. A ```text block behind one of them holds lines that its output must contain, in this order; "…"
stands for anything. A comment before a block says what it needs:

    <!-- needs: vcan0 -->               runs only with --needs vcan0
    <!-- not run: why -->               never runs
    <!-- exit: 2 -->                    its last command must end with this code

--list prints what each page needs. Programs are found by PATH.
"""

import argparse
import contextlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

# Comments, the language and the text of a block; a block that is not for a shell has no comments of ours.
BLOCK = re.compile(r"((?:^<!--[^\n]*-->\n)*)^```(\w*)\n(.*?)^```$", re.M | re.S)
MARK = re.compile(r"<!-- (needs|not run|exit): ([^\n]*?) -->")
LONGEST_S = 600
BETWEEN = "\x1e"  # ASCII record separator: in no output of ours


class Block:
    def __init__(self, text, line, marks):
        self.text, self.line, self.said = text, line, None
        self.needs = [word for kind, word in marks if kind == "needs"]
        self.left_out = any(kind == "not run" for kind, _ in marks)
        self.exit = next((int(word) for kind, word in marks if kind == "exit"), 0)


def blocks_of(page):
    content = page.read_text(encoding="utf-8")
    blocks = []
    for match in BLOCK.finditer(content):
        comments, language, text = match.groups()
        line = content.count("\n", 0, match.start(3)) + 1
        if language == "sh":
            blocks.append(Block(text, line, MARK.findall(comments)))
        elif language == "text" and blocks:
            blocks[-1].said = text.splitlines()
    return blocks


def script_of(blocks):
    """One shell for all of them: variables and background processes last. A failing command ends it."""
    parts = ["set -o pipefail\n"]
    for block in blocks:
        parts.append(f"printf '{BETWEEN}'\n")
        if block.exit == 0:
            parts.append(f"set -e\n{block.text}")
        else:
            parts.append(f"set +e\n{block.text}[ $? = {block.exit} ] || exit 99\n")
    return "".join(parts)


def run_script(script, folder):
    """Output and exit code. What was left running in the background ends with the shell."""
    # A file, not a pipe: a process in the background would hold that open.
    with tempfile.TemporaryFile() as output, subprocess.Popen(
            ["bash", "-c", script], cwd=folder, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
            start_new_session=True) as shell:
        try:
            code = shell.wait(timeout=LONGEST_S)
        except subprocess.TimeoutExpired:
            code = f"no end after {LONGEST_S} s"
        with contextlib.suppress(ProcessLookupError):
            os.killpg(shell.pid, signal.SIGTERM)
        output.seek(0)
        return output.read().decode("utf-8", "replace"), code


def missing_line(said, output):
    """The first line of `said` that the output lacks after those before it."""
    at = 0
    for line in said:
        pattern = ".*?".join(re.escape(part.strip()) for part in line.strip().split("…"))
        found = re.compile(pattern).search(output, at)
        if not found:
            return line
        at = found.end()
    return None


def run_page(page, available):
    """True: everything is as the page says."""
    every = blocks_of(page)
    blocks = [b for b in every if not b.left_out and set(b.needs) <= available]
    if not blocks:
        print(f"{page}: nothing to run")
        return False
    with tempfile.TemporaryDirectory(prefix="volcomp-docs-") as folder:
        output, code = run_script(script_of(blocks), folder)
    parts = output.split(BETWEEN)[1:]
    for block, part in zip(blocks, parts):
        last = block is blocks[len(parts) - 1]
        if last and code != 0:
            print(f"{page}:{block.line}: ends with {code}:\n{block.text}says:\n{part}")
            return False
        lacking = missing_line(block.said or [], part)
        if lacking is not None:
            print(f"{page}:{block.line}: \"{lacking}\" is not in what it says:\n{part}")
            return False
    print(f"{page}: {len(blocks)} of {len(every)} blocks run")
    return len(parts) == len(blocks)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--needs", action="append", default=[])
    parser.add_argument("--list", action="store_true")
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.list:
        for page in arguments.pages:
            print(page, *sorted({word for b in blocks_of(page) if not b.left_out for word in b.needs}))
        return 0
    good = [run_page(page.resolve(), set(arguments.needs)) for page in arguments.pages]
    return 0 if all(good) else 1


sys.exit(main())
