"""The package itself: stubs and documentation say what is there."""

import ast
import inspect
import pathlib
import re

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


def stated():
    """Each class and function of the stubs, with what stands for it at runtime, and the class that it belongs to."""
    for node in ast.parse(STUBS.read_text()).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            yield node, getattr(_native, node.name), None
        if isinstance(node, ast.ClassDef):
            for item in node.body:
                is_image = node.name == "Picture" and getattr(item, "name", "") in BY_NAME
                if isinstance(item, ast.FunctionDef) and not item.name.startswith("__") and not is_image:
                    yield item, getattr(getattr(_native, node.name), item.name), node.name


def test_editors_show_the_documentation_that_there_is_at_runtime():
    """Editors read the stubs alone."""
    for node, thing, owner in stated():
        assert ast.get_docstring(node) == inspect.getdoc(thing), f"{owner}.{node.name}"
    picture = next(node for node, _, _ in stated() if node.name == "Picture")
    images = {item.name: ast.get_docstring(item) for item in picture.body if getattr(item, "name", "") in BY_NAME}
    line = re.compile(r"^ +(\w+) +(u?(?:int|float)\d+) +(\(H, W[^)]*\)) +(.+)$", re.MULTILINE)
    table = line.findall(selvedge.Renderer.render.__doc__)
    listed = {name: f"{dtype} {shape}: {text}" for name, dtype, shape, text in table}
    assert images == listed and set(listed) == BY_NAME


def test_stubs_have_the_parameters_that_there_are_at_runtime():
    seen = 0
    for node, thing, owner in stated():
        if isinstance(node, ast.ClassDef) or inspect.isdatadescriptor(thing):
            continue
        there = inspect.signature(thing).parameters
        wanted = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
        assert [one.arg for one in wanted] == list(there), f"{owner}.{node.name}"
        positional = node.args.args[len(node.args.args) - len(node.args.defaults) :]
        defaults = [*zip(positional, node.args.defaults), *zip(node.args.kwonlyargs, node.args.kw_defaults)]
        for one, default in defaults:
            known = there[one.arg].default
            # a tuple has no text in a native signature
            assert default is None or known is ... or ast.literal_eval(default) == known, f"{node.name}: {one.arg}"
        seen += len(defaults)
    assert seen > 8, "signatures are not read"


def test_everything_public_is_documented():
    for name in selvedge.__all__:
        thing = getattr(selvedge, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for member in public(vars(thing)):
                assert inspect.getdoc(getattr(thing, member)), f"{name}.{member}"


def test_the_package_is_typed():
    assert STUBS.with_name("py.typed").is_file()
