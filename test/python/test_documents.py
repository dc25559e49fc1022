"""The snippets of the documents and the examples run as they stand."""

import contextlib
import io
import os
import re
import runpy
import tempfile
import unittest

from support import REPOSITORY

DOCUMENTS = ("docs/PYTHON.md", "docs/LEARNING.md")


class Documents(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)

    def test_have_snippets_that_run_in_their_order(self):
        for document in DOCUMENTS:
            path = REPOSITORY / document
            if not path.exists():
                continue
            snippets = re.findall(r"^```python\n(.*?)^```", path.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
            self.assertGreater(len(snippets), 0)
            names = {}
            for number, snippet in enumerate(snippets, 1):
                with self.subTest(document=document, snippet=number), contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(snippet, "%s, snippet %d" % (document, number), "exec"), names)

    def test_have_first_steps_that_run(self):
        with contextlib.redirect_stdout(io.StringIO()) as output:
            runpy.run_path(str(REPOSITORY / "examples/python/first_steps.py"), run_name="__main__")
        self.assertIn("again at 2.0 s", output.getvalue())

    def test_have_an_example_of_steering_with_a_limited_force(self):
        with contextlib.redirect_stdout(io.StringIO()) as output:
            runpy.run_path(str(REPOSITORY / "examples/python/force_limited_steering.py"), run_name="__main__")
        without, limited = (float(line.split()[-2]) for line in output.getvalue().splitlines())
        self.assertLess(limited, without)


if __name__ == "__main__":
    unittest.main()
