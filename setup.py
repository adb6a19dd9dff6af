# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Packs python/bbsim, its compiled part, and the libraries that it needs into a wheel: pip wheel .

CMake builds in build/wheel. BBSIM_BUILD names an existing build to pack instead, as for scripts/package --wheel.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
TARGETS = ("bbsim_python", "bbsim_hdf5")


def pybind11_folder():
    """Tells CMake about pybind11 in pip's own environment, if it is there; CMake finds the system's itself."""
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


class Build(build_ext):
    def run(self):
        build = os.environ.get("BBSIM_BUILD")
        if not build:
            build = ROOT / "build" / "wheel"
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DBBSIM_TESTS=OFF",
                            "-DBBSIM_PYTHON_PACKAGE=ON", f"-DPYTHON_EXECUTABLE={sys.executable}",
                            *pybind11_folder()], check=True)
            subprocess.run(["cmake", "--build", build, "--target", *TARGETS], check=True)
        build = pathlib.Path(build).resolve()
        into = pathlib.Path(self.build_lib, "bbsim").resolve()
        into.mkdir(parents=True, exist_ok=True)
        built = [build / "python/bbsim" / self.get_ext_filename("_bbsim"),
                 build / "lib/bbsim/libbbsim_hdf5.so"]
        copies = [shutil.copy2(file, into) for file in built]
        subprocess.run(["strip", "--strip-unneeded", *copies], check=True)
        (into / "examples").mkdir(exist_ok=True)
        for file in [*(ROOT / "configs").glob("*.yaml"), *(ROOT / "configs").glob("*.csv")]:
            shutil.copy2(file, into / "examples")
        # The module looks for the HDF5 module beside itself, and for templates of pages in share/bbsim.
        (into / "share/bbsim").mkdir(parents=True, exist_ok=True)
        for file in (build / "share/bbsim").glob("*.html"):
            shutil.copy2(file, into / "share/bbsim")
        subprocess.run([ROOT / "scripts/bundle", into / "libraries", *copies], check=True)


version = re.search(r"project\(bbsim VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
setuptools.setup(
    version=version,
    ext_modules=[setuptools.Extension("bbsim._bbsim", sources=[])],  # so that the wheel is for this Python and machine
    cmdclass={"build_ext": Build},
)
