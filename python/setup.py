# SPDX-License-Identifier: BSD-3-Clause
from setuptools import setup

setup(cffi_modules=["build_se3d.py:builder"])
