# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Packs what build-wheel.sh has built, for the version of VTK that the environment names."""

import os
import pathlib
import re

from setuptools import Distribution, setup


class BuiltDistribution(Distribution):
    def has_ext_modules(self):
        return True  # so that the wheel's name says for which Python and machine it is


vtk_version = os.environ["VTK_VERSION"]
package = pathlib.Path("vtksplattingmip", "__init__.py").read_text()
setup(
    name="vtksplattingmip",
    version=re.search(r'^__version__ = "(.+)"', package, re.M).group(1),
    description="Maximum intensity projections by splatting in sheared object space, for VTK",
    license="BSD-3-Clause",
    license_files=["LICENSE"],
    packages=["vtksplattingmip"],
    package_data={"vtksplattingmip": ["*.so"]},
    install_requires=[f"vtk=={vtk_version}"],
    distclass=BuiltDistribution,
)
