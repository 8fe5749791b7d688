"""Many files to pictures and a manifest."""

import csv
import hashlib
import json
import pathlib
import re
import sys

import needs
import numpy as np
import pytest
import selvedge

ROOT = pathlib.Path(__file__).parents[3]
SIZE = (48, 32)
VIEWS = ["iso", "30,20"]
WORDS = ["iso", "30_20"]


@pytest.fixture(scope="module")
def renderer():
    with selvedge.Renderer() as renderer:
        yield renderer


@pytest.fixture
def files(tmp_path):
    """A whole file, an invalid one, and another whole one, in this order."""
    paths = [tmp_path / name for name in ("a.step", "b.step", "c.csg")]
    paths[0].write_bytes((ROOT / "samples/bracket.step").read_bytes())
    paths[1].write_text("ISO-10303-21;\nHEADER;\n")
    paths[2].write_text("sphere(4);\n")
    return paths


def test_columns_are_those_of_the_program():
    source = (ROOT / "crates/cli/src/render/manifest.rs").read_text()
    fields = re.search(r"struct Row<'a> \{\n(.*?)\n\}", source, re.DOTALL)[1]
    assert list(selvedge._files.COLUMNS) == re.findall(r"^    (\w+):", fields, re.MULTILINE)


def test_a_file_that_fails_costs_itself_only(renderer, files, tmp_path):
    table = tmp_path / "all.csv"
    arrays = {"depth": tmp_path / "{stem}_{view}.npy", "face": tmp_path / "{stem}_{view}_face.npy"}
    output = tmp_path / "{stem}_{view}.png"
    rows = selvedge.render_files(files, output, VIEWS, arrays=arrays, manifest=table, renderer=renderer, size=SIZE)
    assert [row["status"] for row in rows] == ["drawn", "drawn", "failed", "failed", "drawn", "drawn"]
    assert [row["view"] for row in rows] == WORDS * 3
    assert [row["file"] for row in rows] == [str(file) for file in files for _ in VIEWS]
    assert "b.step" in rows[2]["error"] and rows[2]["faces"] is None and rows[0]["error"] == ""
    assert not list(tmp_path.glob("b_*")) and not list(tmp_path.glob(".part-*"))

    # each is what render draws
    for row, view in zip([rows[k] for k in (0, 1, 4, 5)], VIEWS * 2):
        model = selvedge.open(row["file"])
        picture = renderer.render(model, view, SIZE, ["depth", "face"])
        assert pathlib.Path(row["output"]).read_bytes() == picture._repr_png_()
        stem = row["output"][: -len(".png")]
        assert np.load(f"{stem}.npy").tobytes() == picture.depth.tobytes()
        assert np.load(f"{stem}_face.npy").tobytes() == picture.face.tobytes()
        assert json.loads(row["camera"]) == picture.camera
        assert row["sha256"] == hashlib.sha256(pathlib.Path(row["file"]).read_bytes()).hexdigest()
        assert (row["faces"], row["instances"], row["complete"]) == (len(model.faces), len(model.instances), True)
        assert row["clamps"] == 0 and min(row["read_s"], row["upload_s"], row["draw_s"]) > 0

    # the table says the same
    with open(table, newline="") as source:
        assert list(csv.reader(source))[0] == list(rows[0])
    told = list(csv.DictReader(table.open(newline="")))
    assert [row["error"] for row in told] == [row["error"] for row in rows]
    assert told[0]["complete"] == "true" and told[2]["complete"] == "" and told[2]["draw_s"] == ""
    assert [float(told[k]["draw_s"]) for k in (0, 5)] == [rows[k]["draw_s"] for k in (0, 5)]
    assert told[0]["camera"] == rows[0]["camera"]


def test_what_is_there_is_left_alone(files, tmp_path, monkeypatch):
    output = tmp_path / "{stem}_{view}.png"
    for word in WORDS:
        (tmp_path / f"a_{word}.png").write_text("mine")
    (tmp_path / "c_iso.png").write_text("half")
    rows = selvedge.render_files([files[0], files[2]], output, VIEWS, skip_existing=True, size=SIZE)
    assert [row["status"] for row in rows] == ["skipped", "skipped", "drawn", "drawn"]
    assert (tmp_path / "a_iso.png").read_text() == "mine"
    assert (tmp_path / "c_iso.png").read_bytes()[:4] == b"\x89PNG"
    # all of them are there now: no device is opened
    monkeypatch.setattr(selvedge, "Renderer", None)
    again = selvedge.render_files([files[0], files[2]], output, VIEWS, skip_existing=True, size=SIZE)
    assert {row["status"] for row in again} == {"skipped"}


def test_the_first_failure_ends_it_where_that_is_wanted(renderer, files, tmp_path):
    table = tmp_path / "all.csv"
    with pytest.raises(selvedge.ReadError, match="b.step"):
        selvedge.render_files(
            files, tmp_path / "{stem}.png", manifest=table, fail_fast=True, renderer=renderer, size=SIZE
        )
    told = list(csv.DictReader(table.open(newline="")))
    assert [row["status"] for row in told] == ["drawn", "failed"]
    assert not renderer.closed and not (tmp_path / "c.png").exists()


def test_a_picture_that_cannot_be_drawn_or_written_is_told(renderer, files, tmp_path):
    smooth = {"samples": 4, "smooth": "trims", "size": SIZE, "renderer": renderer}
    rows = selvedge.render_files([files[0]], tmp_path / "{stem}.png", **smooth)
    assert rows[0]["status"] == "failed" and "smooth trims" in rows[0]["error"] and rows[0]["sha256"] == ""
    (tmp_path / "c.png").mkdir()
    rows = selvedge.render_files([files[2]], tmp_path / "{stem}.png", renderer=renderer, size=SIZE)
    assert rows[0]["status"] == "failed" and "c.png" in rows[0]["error"]
    assert not list(tmp_path.glob(".part-*"))
    for limit in ({"limit_mib": 0.001}, {"limit_s": 1e-9}):
        rows = selvedge.render_files([files[0]], tmp_path / "{stem}.png", renderer=renderer, size=SIZE, **limit)
        assert rows[0]["status"] == "failed" and "a.step" in rows[0]["error"]


def test_a_file_has_its_time_to_be_drawn(renderer, files, tmp_path, monkeypatch):
    """The time in which a file was read is taken from that of its pictures."""
    clock = iter(range(0, 10**6, 1000))
    with monkeypatch.context() as patched:
        patched.setattr(selvedge._files.time, "perf_counter", lambda: float(next(clock)))
        out = tmp_path / "{stem}_{view}.png"
        rows = selvedge.render_files([files[0], files[2]], out, VIEWS, renderer=renderer, size=SIZE, limit_s=999)
    assert [row["status"] for row in rows] == ["failed"] * 4
    for row in rows:
        assert row["error"] == f"{row['file']}: reading and preparing it take longer than the limit of 999s"
    # jobs that share a limit are drawn until it is spent
    model = selvedge.open(files[2])
    settings = {**selvedge._DEFAULTS, "size": SIZE}
    plenty = selvedge._native.Limits("c.csg", 3600.0, 0.0)
    assert [renderer._native.submit(model, settings, plenty).result().size for _ in range(2)] == [SIZE] * 2
    spent = selvedge._native.Limits("c.csg", 3600.0, 3600.5)
    with pytest.raises(selvedge.RenderError, match="c.csg: reading, preparing and drawing it take longer"):
        renderer._native.submit(model, settings, spent).result()
    endless = selvedge._native.Limits("c.csg", None, 1e300)
    assert renderer._native.submit(model, settings, endless).result().size == SIZE


def test_wrong_arguments_are_refused_before_anything_is_drawn(renderer, files, tmp_path):
    one, both = [files[0]], [files[0], files[2]]
    out = tmp_path / "{stem}_{view}.png"
    cases = [
        (lambda: selvedge.render_files(both, tmp_path / "one.png"), ValueError, "have one place"),
        (lambda: selvedge.render_files(one, tmp_path / "{stem}.png", VIEWS), ValueError, "have one place"),
        (lambda: selvedge.render_files([files[0], str(files[0])], out), ValueError, "named twice"),
        (lambda: selvedge.render_files(one, tmp_path / "{stem}.jpg"), ValueError, "ends in .png"),
        (lambda: selvedge.render_files(one, out, arrays={"depth": tmp_path / "d.txt"}), ValueError, "ends in .npy"),
        (lambda: selvedge.render_files(one, out, arrays={"depths": tmp_path / "d.npy"}), ValueError, "depth, face"),
        (lambda: selvedge.render_files(one, tmp_path / "none/{stem}.png"), FileNotFoundError, "no folder"),
        (lambda: selvedge.render_files(one, out, ["side"]), ValueError, "iso, front"),
        (lambda: selvedge.render_files(one, out, "iso"), TypeError, "lists"),
        (lambda: selvedge.render_files(files[0], out), TypeError, "lists"),
        (lambda: selvedge.render_files(one, out, manifest=tmp_path / "all.txt"), ValueError, ".csv or .parquet"),
        (lambda: selvedge.render_files(one, out, manifest=files[0]), ValueError, "which is read"),
        (lambda: selvedge.render_files(one, out, size=(0, 64)), ValueError, "1 to 16384"),
        (lambda: selvedge.render_files(one, out, style="toon"), ValueError, "clay"),
        (lambda: selvedge.render_files(one, out, outputs=["depth"]), TypeError, "no argument outputs"),
        (lambda: selvedge.render_files(one, out, ahead=0), ValueError, "ahead"),
        (lambda: selvedge.render_files(one, out, limit_s=-1), ValueError, "limit_s"),
    ]
    before = sorted(tmp_path.iterdir())
    for call, error, told in cases:
        with pytest.raises(error, match=told):
            call()
    assert sorted(tmp_path.iterdir()) == before
    with selvedge.Renderer() as closed:
        pass
    with pytest.raises(selvedge.ClosedError):
        selvedge.render_files(one, out, renderer=closed, size=SIZE)


def test_a_parquet_manifest_without_pyarrow_names_the_package(files, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)  # as if it were not installed
    with pytest.raises(ImportError, match="pip install pyarrow") as missing:
        selvedge.render_files([files[2]], tmp_path / "{stem}.png", manifest=tmp_path / "all.parquet", size=SIZE)
    assert missing.value.name == "pyarrow" and not (tmp_path / "c.png").exists()


def test_a_parquet_manifest_has_the_rows_with_their_types(renderer, files, tmp_path):
    pq = needs.package("pyarrow", "pyarrow.parquet")
    path = tmp_path / "all.parquet"
    rows = selvedge.render_files(files, tmp_path / "{stem}.png", manifest=path, renderer=renderer, size=SIZE)
    table = pq.read_table(path)
    assert table.to_pylist() == rows and not list(tmp_path.glob(".part-*"))
    kinds = {field.name: str(field.type) for field in table.schema}
    assert kinds == selvedge._files.COLUMNS
    # after the first failure, too
    with pytest.raises(selvedge.ReadError):
        selvedge.render_files(
            files, tmp_path / "{stem}.png", manifest=path, renderer=renderer, size=SIZE, fail_fast=True
        )
    assert pq.read_table(path).column("status").to_pylist() == ["drawn", "failed"]


def test_a_picture_of_nothing_is_no_success(renderer, tmp_path):
    nothing, ball = tmp_path / "nothing.csg", tmp_path / "ball.csg"
    nothing.write_text("difference() { sphere(1); cube([9, 9, 9], center = true); }\n")
    ball.write_text("sphere(1);\n")
    rows = selvedge.render_files([nothing, ball], tmp_path / "{stem}.png", renderer=renderer, size=SIZE)
    assert [row["status"] for row in rows] == ["failed", "drawn"]
    assert "nothing.csg: nothing is seen" in rows[0]["error"] and not (tmp_path / "nothing.png").exists()
    model = selvedge.open(nothing)
    for outputs, background, blank in [([], "none", True), (["face"], "white", True), ([], "white", False)]:
        assert renderer.render(model, "iso", SIZE, outputs, background=background).stats["blank"] is blank
    assert renderer.render(selvedge.open(ball), "iso", SIZE).stats["blank"] is False
