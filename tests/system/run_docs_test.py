#!/usr/bin/python3
"""run_docs.py notices when a page is wrong: otherwise a page that passes says nothing."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

RUN_DOCS = pathlib.Path(__file__).with_name("run_docs.py")


def run(text, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "page.md"
        page.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, RUN_DOCS, *arguments, page], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


def block(commands, language="sh"):
    return f"```{language}\n{commands}\n```\n"


class Page(unittest.TestCase):
    def refused(self, text, wanted, *arguments):
        code, said = run(text, *arguments)
        self.assertEqual(code, 1, said)
        self.assertIn(wanted, said)

    def accepted(self, text, wanted, *arguments):
        code, said = run(text, *arguments)
        self.assertEqual(code, 0, said)
        self.assertIn(wanted, said)

    def test_commands_share_shell_and_folder(self):
        self.accepted(block("x=3; echo a > file") + "words\n" + block("test $x = 3 && test -s file"), "2 of 2 blocks")

    def test_a_failing_command_is_found_wherever_it_is(self):
        self.refused("title\n\n" + block("false\ntrue"), "page.md:4: ends with 1")
        self.refused(block("true") + block("false | true"), "ends with 1")
        self.refused(block("true") + block("no-such-command"), "ends with 127")

    def test_an_expected_failure_must_happen(self):
        self.accepted("<!-- exit: 2 -->\n" + block("(exit 2)") + block("true"), "2 of 2")
        self.refused("<!-- exit: 2 -->\n" + block("true") + block("true"), "ends with 99")
        self.refused("<!-- exit: 2 -->\n" + block("(exit 2)") + block("false"), "ends with 1")

    def test_output(self):
        says = block("echo one 2 three; echo four >&2")
        self.accepted(says + block("one … three\nfour", "text"), "1 of 1")
        self.refused(says + block("four\none", "text"), "\"one\" is not in what it says")
        self.refused(says + block("one … five", "text"), "\"one … five\"")
        self.refused(block("true") + says + block("six", "text") + block("true"), "\"six\"")

    def test_needs(self):
        page = block("true") + "<!-- needs: bus -->\n" + block("false") + "<!-- not run: why -->\n" + block("false")
        self.accepted(page, "1 of 3 blocks")
        self.refused(page, "ends with 1", "--needs", "bus")
        self.refused("no block\n", "nothing to run")

    def test_background_processes_end_with_the_page(self):
        self.accepted(block("sleep 1000 &") + block("echo done") + block("done", "text"), "2 of 2")


if __name__ == "__main__":
    unittest.main()
