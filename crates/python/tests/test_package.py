"""The package itself: stubs and documentation say what is there."""

import ast
import inspect
import pathlib

import selvedge
from selvedge import _native

STUBS = pathlib.Path(selvedge.__file__).with_name("_native.pyi")
# images are attributes by name, which no class lists
BY_NAME = {"colour", "depth", "face", "uv", "normal", "thickness", "edge", "part", "instance"}


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_stubs_name_what_the_native_half_has():
    tree = ast.parse(STUBS.read_text())
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    assert set(classes) | functions == public(vars(_native)) - {"__doc__"}
    for name, node in classes.items():
        stated = public(item.name for item in node.body if isinstance(item, ast.FunctionDef))
        there = public(vars(getattr(_native, name)))
        assert stated - (BY_NAME if name == "Picture" else set()) == there, name


def test_everything_public_is_documented():
    for name in selvedge.__all__:
        thing = getattr(selvedge, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for member in public(vars(thing)):
                assert inspect.getdoc(getattr(thing, member)), f"{name}.{member}"


def test_the_package_is_typed():
    assert STUBS.with_name("py.typed").is_file()
