"""Files to models, and what models tell."""

import math
import pathlib
import sys
import types

import needs
import numpy as np
import pytest
import selvedge

SAMPLES = pathlib.Path(__file__).parents[3] / "samples"
BRACKET = SAMPLES / "bracket.step"


@pytest.fixture(scope="module")
def bracket():
    return selvedge.open(BRACKET)


def test_a_path_and_bytes_hold_the_same(bracket):
    for source in (str(BRACKET), BRACKET.read_bytes(), bytearray(BRACKET.read_bytes())):
        other = selvedge.open(source)
        assert [face.number for face in other.faces] == [face.number for face in bracket.faces]
        np.testing.assert_array_equal(other.bounds, bracket.bounds)
    assert bracket.bounds.shape == (2, 3) and bracket.bounds.dtype == np.float64
    assert (bracket.bounds[1] > bracket.bounds[0]).all()


def test_faces_have_the_measures_that_the_file_states(bracket):
    text = BRACKET.read_text()
    round_ones = [face for face in bracket.faces if face.kind == "cylinder"]
    assert round_ones and len(bracket.faces) == text.count("ADVANCED_FACE(")
    stated = {float(line.split(",")[-1].strip(" ).;")) for line in text.split(";") if "CYLINDRICAL_SURFACE(" in line}
    for face in round_ones:
        assert min(abs(face.radius - radius) for radius in stated) < 1e-6 * face.radius
        assert face.area > 0.0
    assert all(face.radius is None for face in bracket.faces if face.kind == "plane")


def test_a_block_has_the_area_and_the_edges_of_a_block():
    corner = [(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0), (0, 0, 5), (2, 0, 5), (2, 3, 5), (0, 3, 5)]
    sides = ["1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corner) + "".join(f"f {side}\n" for side in sides)
    block = selvedge.open(text.encode(), name="block.obj")
    assert len(block.edges) == 12
    lengths = sorted(edge.length for edge in block.edges)
    assert lengths == pytest.approx([2.0] * 4 + [3.0] * 4 + [5.0] * 4)
    assert [edge.number for edge in block.edges] == list(range(1, 13))
    assert {edge.kind for edge in block.edges} == {"sharp"}
    assert block.parts[0].closed and block.parts[0].meshes == 1


def test_edges_join_two_faces_each(bracket):
    joined = [edge for edge in bracket.edges if edge.kind in ("sharp", "smooth")]
    numbers = {face.number for face in bracket.faces}
    assert joined and all(len(edge.faces) == 2 and set(edge.faces) <= numbers for edge in joined)
    circles = [edge for edge in joined if np.array_equal(edge.ends[0], edge.ends[1])]
    radii = {face.number: face.radius for face in bracket.faces if face.kind == "cylinder"}
    rims = [(edge, radii[n]) for edge in circles for n in edge.faces if n in radii]
    assert rims and all(edge.length == pytest.approx(2 * math.pi * radius, rel=1e-6) for edge, radius in rims)


def test_an_assembly_is_a_tree_of_placed_parts():
    model = selvedge.open(SAMPLES / "assembly.step")

    def bodies(node):
        inner = (len(child["names"]) * bodies(child) for child in node["children"])
        return sum(body["count"] for body in node["bodies"]) + sum(inner)

    assert bodies(model.tree) == len(model.instances)
    for instance in model.instances:
        assert 0 <= instance.part < len(model.parts)
        assert instance.transform.shape == (4, 4) and instance.transform[3].tolist() == [0, 0, 0, 1]
    assert len({tuple(i.transform[:3, 3]) for i in model.instances}) > 1


def test_what_is_left_out_has_file_line_and_entity():
    text = BRACKET.read_text()
    start = text.index("CYLINDRICAL_SURFACE(")
    end = text.index(";", start)
    radius = text[start:end].split(",")[-1]
    damaged = text[:start] + text[start:end].replace("," + radius, ",0.)") + text[end:]
    model = selvedge.open(damaged.encode(), name="damaged.step")
    assert not model.complete and "left out" in model.summary
    told = [w for w in model.warnings if "left out" in w.message]
    assert told and told[0].file == "damaged.step" and told[0].line > 0 and told[0].entity > 0
    with pytest.raises(selvedge.ReadError) as refused:
        selvedge.open(damaged.encode(), name="damaged.step", strict=True)
    error = refused.value
    assert (error.file, error.line, error.entity) == ("damaged.step", told[0].line, told[0].entity)


def test_bad_input_is_a_typed_error(tmp_path):
    with pytest.raises(selvedge.MissingFileError) as missing:
        selvedge.open(tmp_path / "none.step")
    assert isinstance(missing.value, (selvedge.ReadError, FileNotFoundError)) and "none.step" in missing.value.file
    with pytest.raises(selvedge.ReadError) as no_step:
        selvedge.open(b"ISO-10303-21;\nHEADER;\n", name="cut.step")
    assert no_step.value.file == "cut.step" and no_step.value.line is not None
    with pytest.raises(selvedge.ReadError, match="nothing of it can be drawn"):
        selvedge.open(b"group();", name="none.csg")
    with pytest.raises(selvedge.ReadError):
        selvedge.open(BRACKET, limit_mib=0.001)
    for wrong in (12, None, 1.5, ["a.step"]):
        with pytest.raises(TypeError, match="a path, bytes or a shape"):
            selvedge.open(wrong)
    with pytest.raises(ValueError, match="limit_mib"):
        selvedge.open(BRACKET, limit_mib=-1)
    with pytest.raises(selvedge.ReadError, match="bracket.step: .*longer than the limit") as late:
        selvedge.open(BRACKET, limit_s=1e-9)
    assert late.value.file == str(BRACKET)
    with pytest.raises(ValueError, match="limit_s"):
        selvedge.open(BRACKET, limit_s=0)
    assert len(selvedge.open(BRACKET, limit_s=1e300).faces) > 0


@pytest.mark.parametrize("package", ["OCP", "OCC.Core"])
def test_shapes_of_open_cascade_go_through_step(package, monkeypatch):
    """The calls of both bindings, with a writer in place of the kernel's that writes the bracket."""

    class Writer:
        def Transfer(self, shape, kind):
            assert type(shape).__name__ == "TopoDS_Solid" and kind == "as is"
            return "done"

        def Write(self, path):
            pathlib.Path(path).write_bytes(BRACKET.read_bytes())
            return "done"

    step, select = types.ModuleType(f"{package}.STEPControl"), types.ModuleType(f"{package}.IFSelect")
    step.STEPControl_Writer, step.STEPControl_AsIs, select.IFSelect_RetDone = Writer, "as is", "done"
    for module in (step, select):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    parent = package.split(".")
    for depth in range(len(parent)):
        name = ".".join(parent[: depth + 1])
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    shape = type("TopoDS_Solid", (), {"__module__": f"{package}.TopoDS"})()
    wrapping = types.SimpleNamespace(wrapped=shape)
    for source in (shape, wrapping):
        assert len(selvedge.open(source).faces) == len(selvedge.open(BRACKET).faces)


def test_a_shape_of_the_real_kernel_is_read():
    """As pythonocc holds it, as build123d does, and on the stack of a cadquery Workplane."""
    shape = needs.package("ocp", "OCP.BRepPrimAPI").BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape()
    wrapping = types.SimpleNamespace(wrapped=shape)
    for source in (shape, wrapping, types.SimpleNamespace(val=lambda: wrapping)):
        assert sorted(face.area for face in selvedge.open(source).faces) == pytest.approx([2, 2, 3, 3, 6, 6])


def test_a_view_snaps_to_vertices_centres_and_edges(bracket):
    camera = selvedge.Camera.look_at((60.0, -90.0, 70.0), tuple(bracket.bounds.mean(axis=0)), fov=40.0)
    size = (320, 240)
    seen = [bracket.snap((x, y), 3.0, size=size, camera=camera) for x in range(4, 320, 8) for y in range(4, 240, 8)]
    kinds = {found["kind"] for found in seen if found}
    assert kinds == {"vertex", "centre", "edge"} and None in seen
    low, high = bracket.bounds
    for found in filter(None, seen):
        assert found["distance_px"] <= 3.0 and 1 <= found["edge"] <= len(bracket.edges)
        if found["kind"] != "centre":
            assert (np.array(found["point"]) >= low - 1e-6).all() and (np.array(found["point"]) <= high + 1e-6).all()
        if found["kind"] == "vertex":
            ends = bracket.edges[found["edge"] - 1].ends
            assert min(np.linalg.norm(ends - found["point"], axis=1)) < 1e-9
            # from the point's own pixel the same point is found
            again = bracket.snap(found["pixel"], 1.0, size=size, camera=camera, kinds=["vertex"])
            assert again["point"] == found["point"] and again["distance_px"] < 1e-9
    for arguments, told in (
        ({"radius": 0.0}, "radius"),
        ({"radius": math.nan}, "radius"),
        ({"kinds": ["face"]}, "vertex, centre and edge"),
        ({"size": (0, 5)}, "no pixels"),
    ):
        with pytest.raises(ValueError, match=told):
            bracket.snap((5.0, 5.0), **arguments)
    with pytest.raises(TypeError):
        bracket.snap(5.0)
    with pytest.raises(ValueError, match="length 2"):
        bracket.snap("here")
