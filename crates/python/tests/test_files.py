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


def facts(row):
    """A row without its status, so that a picture that was drawn is compared with one that was skipped."""
    return {name: cell for name, cell in row.items() if name != "status"}


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_second_run_keeps_the_facts_of_the_first_one(renderer, files, tmp_path, ending):
    table, output = tmp_path / f"all.{ending}", tmp_path / "{stem}_{view}.png"
    if ending == "parquet":
        pq = needs.package("pyarrow", "pyarrow.parquet")

    def told():
        if ending == "csv":
            return list(csv.DictReader(table.open(newline="")))
        return pq.read_table(table).to_pylist()

    def run(files, **more):
        more = {"manifest": table, "renderer": renderer, "size": SIZE, **more}
        return selvedge.render_files(files, output, VIEWS, **more)

    first, before = run(files), told()
    assert [row["status"] for row in first] == ["drawn", "drawn", "failed", "failed", "drawn", "drawn"]
    # what failed is tried again, and so is a file with a picture that is not there; rows keep the order of the files
    (tmp_path / "c_iso.png").unlink()
    second = run([files[1], files[2], files[0]], skip_existing=True)
    assert [row["status"] for row in second] == ["failed", "failed", "drawn", "drawn", "skipped", "skipped"]
    for k in (0, 1):
        assert first[k]["sha256"] and first[k]["draw_s"] > 0 and first[k]["complete"] is True
        assert facts(second[4 + k]) == facts(first[k])
        assert [facts(row) for row in told() if row["status"] == "skipped"][k] == facts(before[k])
    # facts of a row that was skipped are kept, too; one that failed has none, although its pictures are there
    for word in WORDS:
        (tmp_path / f"b_{word}.png").write_text("mine")
    third = run(files, skip_existing=True)
    assert {row["status"] for row in third} == {"skipped"}
    assert [facts(row) for row in third[:2] + third[4:]] == [facts(row) for row in first[:2] + second[2:4]]
    assert [(row["error"], row["sha256"], row["faces"]) for row in third[2:4]] == [("", "", None)] * 2
    # a run that ends in the middle has the rows of all files that were skipped
    for word in WORDS:
        (tmp_path / f"b_{word}.png").unlink()
    with pytest.raises(selvedge.ReadError, match="b.step"):
        run(files[1:], skip_existing=True, fail_fast=True)
    left = {(row["file"], row["status"]): row for row in told()}
    assert left.keys() == {(str(files[1]), "failed"), (str(files[2]), "skipped")}
    assert left[str(files[2]), "skipped"]["sha256"] == first[5]["sha256"]
    # rows of other pictures are left out, and the call says so
    with pytest.warns(RuntimeWarning, match="2 rows are of pictures that this call does not have"):
        run(files[:1], skip_existing=True)
    assert [row["file"] for row in told()] == [str(files[0])] * 2 and not list(tmp_path.glob(".part-*"))


def test_a_torn_row_is_left_out_and_told(renderer, files, tmp_path):
    table, output = tmp_path / "all.csv", tmp_path / "{stem}_{view}.png"
    both = [files[0], files[2]]
    first = selvedge.render_files(both, output, VIEWS, manifest=table, renderer=renderer, size=SIZE)
    whole = table.read_bytes()
    for torn, kept in [
        (whole[:-2], 3),
        (whole[:-1], 3),
        (whole + b'x.step,,iso,x.png,failed,"one line\n', 4),
        (whole[:10], 0),
    ]:
        table.write_bytes(torn)
        with pytest.warns(RuntimeWarning, match="all.csv: the last row has no end"):
            again = selvedge.render_files(both, output, VIEWS, manifest=table, skip_existing=True, size=SIZE)
        assert [facts(row) for row in again[:kept]] == [facts(row) for row in first[:kept]]
        assert all(row["sha256"] == "" and row["draw_s"] is None for row in again[kept:])
        assert table.read_bytes().count(b"\n") == 1 + len(again)


def test_a_run_that_cannot_begin_leaves_the_old_table(renderer, files, tmp_path, monkeypatch):
    table, output = tmp_path / "all.csv", tmp_path / "{stem}.png"
    selvedge.render_files([files[2]], output, manifest=table, renderer=renderer, size=SIZE)
    before = table.read_bytes()

    def refuses():
        raise selvedge.DeviceError("no device")

    with selvedge.Renderer() as closed:
        pass
    for skip in (False, True):
        with pytest.raises(selvedge.ClosedError):
            selvedge.render_files(files, output, manifest=table, renderer=closed, skip_existing=skip, size=SIZE)
        with monkeypatch.context() as patched, pytest.raises(selvedge.DeviceError, match="no device"):
            patched.setattr(selvedge, "Renderer", refuses)
            selvedge.render_files(files, output, manifest=table, skip_existing=skip, size=SIZE)
        assert table.read_bytes() == before and not list(tmp_path.glob(".part-*"))
    # a table of other columns is refused, and so is a row with other cells
    for other, told in [(b"name,size\nball,3\n", "columns"), (before.replace(b",true,", b",maybe,"), "row 1: .*maybe")]:
        table.write_bytes(other)
        with pytest.raises(ValueError, match=f"all.csv: .*{told}"):
            selvedge.render_files(files, output, manifest=table, renderer=renderer, skip_existing=True, size=SIZE)
        assert table.read_bytes() == other != before


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
