"""Packages beside numpy that some tests need. `tools/python tests` installs them."""

import importlib
import os

import pytest

# by the word with which SELVEDGE_WITHOUT leaves their tests out
PACKAGES = {"ray": "ray[data]", "pyarrow": "pyarrow", "ocp": "cadquery-ocp-novtk"}


def package(word, module):
    """The module. A test without it fails, unless SELVEDGE_WITHOUT has the word: then pytest lists it as skipped."""
    if word in os.environ.get("SELVEDGE_WITHOUT", "").split(","):
        pytest.skip(f"SELVEDGE_WITHOUT={word}")
    try:
        return importlib.import_module(module)
    except ImportError as why:
        pytest.fail(
            f"{why}: `tools/python tests` installs {PACKAGES[word]}, SELVEDGE_WITHOUT={word} leaves the test out",
            pytrace=False,
        )
