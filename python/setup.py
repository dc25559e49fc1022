"""Builds the compiled part with CMake; see CMakeLists.txt beside this file. Options go into the environment variable
CMAKE_ARGS, e.g. -DENDOVASCULAR_FIND_CORE=OFF."""

import os
import pathlib
import re
import shlex
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
CORE = HERE.parent


def version():
    text = (CORE / "package.xml").read_text(encoding="utf-8")
    return re.search(r"<version>(.*)</version>", text).group(1)


class CMakeBuild(build_ext):
    """Configures, builds and installs the module into the folder of the package."""

    def build_extension(self, ext):
        package = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent
        folder = (HERE / "build" / ("cmake-%d.%d" % sys.version_info[:2])).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DENDOVASCULAR_PACKAGE=%s" % package,
                   "-DPython3_EXECUTABLE=" + sys.executable, "-DPYTHON_EXECUTABLE=" + sys.executable]
        try:
            import pybind11
            options.append("-Dpybind11_DIR=" + pybind11.get_cmake_dir())
        except ImportError:
            pass  # CMake finds Debian's pybind11-dev
        options += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(len(os.sched_getaffinity(0))))
        for command in (["cmake", "-S", str(HERE), "-B", str(folder), *options],
                        ["cmake", "--build", str(folder), "-j", jobs, "--target", "endovascular_sim_python"],
                        ["cmake", "--install", str(folder), "--component", "python"]):
            subprocess.run(command, check=True)


setup(version=version(), ext_modules=[Extension("endovascular_sim._core", sources=[])],
      cmdclass={"build_ext": CMakeBuild})
