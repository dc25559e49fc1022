"""Import: another Python, missing parts, messages without the compiled part."""

import pathlib
import shutil
import sys
import sysconfig
import tempfile
import unittest

import endovascular_sim
from support import run_python

SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.package = pathlib.Path(folder.name) / "endovascular_sim"
        self.package.mkdir()
        for file in pathlib.Path(endovascular_sim.__file__).parent.glob("*.py"):
            shutil.copy(file, self.package)

    def run_here(self, code):
        return run_python("import sys; sys.path.insert(0, %r)\n%s" % (str(self.package.parent), code))

    def test_for_another_python_names_the_one_it_was_built_for(self):
        (self.package / ("_core" + SUFFIX.replace("cpython-3%d" % sys.version_info[1], "cpython-39"))).touch()
        done = self.run_here("from endovascular_sim import World")
        self.assertEqual(done.returncode, 1)
        self.assertIn("was built for Python 3.9, but this is 3.%d" % sys.version_info[1], done.stderr)

    def test_without_the_compiled_part_says_how_to_build_it(self):
        done = self.run_here("import endovascular_sim; endovascular_sim.rollout")
        self.assertIn("pip install ./python", done.stderr.splitlines()[-1])

    def test_without_numpy_names_it(self):
        (self.package / ("_core" + SUFFIX)).touch()
        done = self.run_here("import importlib.util\nfind = importlib.util.find_spec\n"
                             "importlib.util.find_spec = lambda name: None if name == 'numpy' else find(name)\n"
                             "import endovascular_sim; endovascular_sim.World")
        self.assertIn("needs numpy", done.stderr.splitlines()[-1])

    def test_of_the_package_alone_loads_no_compiled_part(self):
        done = run_python("import endovascular_sim, sys; print('endovascular_sim._core' in sys.modules, "
                          "'World' in dir(endovascular_sim))")
        self.assertEqual(done.stdout, "False True\n", done.stderr)

    def test_knows_version_commit_and_physics_number(self):
        self.assertRegex(endovascular_sim.__version__, r"^\d+\.\d+\.\d+$")
        self.assertRegex(endovascular_sim.__commit__, r"^[0-9a-f]{12}(-dirty)?$|^unknown$")
        self.assertGreater(endovascular_sim.physics_number, 0)
        with self.assertRaises(AttributeError):
            endovascular_sim.nothing  # noqa: B018

    def test_has_stubs_for_every_public_name(self):
        stubs = (pathlib.Path(endovascular_sim.__file__).parent / "__init__.pyi").read_text(encoding="utf-8")
        core = (pathlib.Path(endovascular_sim.__file__).parent / "_core.pyi").read_text(encoding="utf-8")
        for name in endovascular_sim.__all__:
            self.assertRegex(stubs, r"\b%s as %s\b" % (name, name))
        for kind in (endovascular_sim.World, endovascular_sim.Session, endovascular_sim.Observation,
                     endovascular_sim.Rollout, endovascular_sim.Branch):
            body = core.split("\nclass %s" % kind.__name__)[1].split("\nclass ")[0]
            for name in vars(kind):
                if not name.startswith("_"):
                    self.assertRegex(body, r"\b%s\b" % name)
                    self.assertTrue(getattr(kind, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
