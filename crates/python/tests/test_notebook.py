"""The notebook in examples/ runs from its first cell to its last."""

import ast
import json
import pathlib

import selvedge

ROOT = pathlib.Path(__file__).parents[3]


def test_the_notebook_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    notebook = json.loads((ROOT / "examples/arrays.ipynb").read_text())
    names, values = {}, []
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        body = ast.parse("".join(cell["source"])).body
        last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), "notebook", "exec"), names)
        if last is not None:
            values.append(eval(compile(ast.Expression(last.value), "notebook", "eval"), names))
    picture = next(value for value in values if isinstance(value, selvedge.Picture))
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert True in values  # the judge's verdict
    assert "radius" in capsys.readouterr().out
