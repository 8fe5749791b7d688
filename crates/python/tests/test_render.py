"""Models to arrays."""

import math
import pathlib
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import selvedge

SAMPLES = pathlib.Path(__file__).parents[3] / "samples"
SIZE = (96, 64)
# pictures that take long enough to be in flight together
LARGE = (320, 240)
TURN = [f"{azimuth},20" for azimuth in range(0, 360, 36)]
SHAPES = {
    "colour": (np.uint8, (64, 96, 4)),
    "depth": (np.float32, (64, 96)),
    "face": (np.uint32, (64, 96)),
    "uv": (np.float32, (64, 96, 2)),
    "normal": (np.float32, (64, 96, 3)),
    "thickness": (np.float32, (64, 96)),
    "part": (np.uint32, (64, 96)),
    "instance": (np.uint32, (64, 96)),
    "edge": (np.uint32, (64, 96)),
}
# x, y, z of the block; names of the views and the axis that they look along
SIDES = (2.0, 3.0, 5.0)
CORNERS = [(x, y, z) for x in (0, SIDES[0]) for y in (0, SIDES[1]) for z in (0, SIDES[2])]
QUADS = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]


@pytest.fixture(scope="module")
def renderer():
    with selvedge.Renderer() as renderer:
        yield renderer


@pytest.fixture(scope="module")
def bracket():
    return selvedge.open(SAMPLES / "bracket.step")


@pytest.fixture(scope="module")
def block():
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) + "".join(f"f {quad}\n" for quad in QUADS)
    return selvedge.open(text.encode(), name="block.obj")


def test_every_output_has_its_shape_and_dtype(renderer, bracket):
    picture = renderer.render(bracket, "iso", SIZE, ["depth", "face", "uv", "normal"])
    have_shapes(picture, ["colour", "depth", "face", "uv", "normal"])
    seen = picture.face != 0
    assert 0.1 < seen.mean() < 0.95
    assert set(np.unique(picture.face[seen])) <= {face.number for face in bracket.faces}
    np.testing.assert_array_equal(np.isfinite(picture.depth), seen)
    np.testing.assert_array_equal(np.isnan(picture.uv[..., 0]), ~seen)
    np.testing.assert_allclose(np.linalg.norm(picture.normal[seen], axis=-1), 1.0, atol=1e-5)


def test_numbers_name_parts_instances_and_edges(renderer, block):
    # 4 mm high where the top is, 15 mm away; the top hides everything else
    fov = math.degrees(2 * math.atan(2 / 15))
    camera = selvedge.Camera.look_at((1, 1.5, 20), (1, 1.5, 0), up=(0, 1, 0), fov=fov)
    picture = renderer.render(block, size=SIZE, outputs=["part", "instance", "edge", "thickness"], camera=camera)
    have_shapes(picture, ["colour", "part", "instance", "edge", "thickness"])
    seen = picture.part != 0
    # 2 of 6 by 3 of 4 millimetres
    assert seen.mean() == pytest.approx(1 / 3 * 3 / 4, abs=0.03)
    assert set(picture.part[seen]) == set(picture.instance[seen]) == {1}
    # rays that end on the ground, by the cosine longer; at the border they leave through a side
    inside = picture.thickness[seen] > SIDES[2] * 0.9999
    assert inside.mean() > 0.4 and picture.thickness.max() < SIDES[2] * 1.02
    assert (picture.thickness[~seen] == 0).all()
    top = {edge.number for edge in block.edges if (edge.ends[:, 2] == SIDES[2]).all()}
    assert set(np.unique(picture.edge)) == top | {0}
    assert picture.edge[32, 48] == 0


def have_shapes(picture, names):
    assert set(picture.images) == set(names)
    for name in names:
        array = getattr(picture, name)
        assert (array.dtype, array.shape) == SHAPES[name], name
        assert array is picture.images[name] and array.flags.writeable and array.flags.c_contiguous


def test_arrays_are_no_copies(renderer, bracket):
    """NumPy has the picture's own memory: it belongs to a holder of Rust's, and each read gives the same."""
    picture = renderer.render(bracket, "iso", SIZE, ["depth", "face", "uv", "normal", "part"])
    for name in ("colour", "depth", "face", "uv", "normal", "part"):
        array, again = getattr(picture, name), getattr(picture, name)
        assert array.base is not None and not array.flags.owndata, name
        assert not isinstance(array.base, np.ndarray), name
        start, again_start = (a.__array_interface__["data"][0] for a in (array, again))
        assert start == again_start and np.shares_memory(array, again), name
        # what is written is there on the next read
        array.flat[0] = 7
        assert getattr(picture, name).flat[0] == 7, name


def test_an_image_that_was_not_asked_for_says_so(renderer, block):
    picture = renderer.render(block, size=SIZE)
    with pytest.raises(AttributeError, match='outputs=."depth".'):
        picture.depth
    with pytest.raises(AttributeError, match="no attribute"):
        picture.colours


def test_arrays_outlive_everything(bracket):
    renderer = selvedge.Renderer()
    depth = renderer.render(bracket, size=SIZE, outputs=["depth"]).depth
    copy = depth.copy()
    renderer.close()
    np.testing.assert_array_equal(depth, copy)


def test_runs_are_the_same_bytes(renderer, bracket):
    first = renderer.render(bracket, "iso", SIZE, ["depth", "normal"])
    with selvedge.Renderer() as other:
        again = other.render(bracket, "iso", SIZE, ["depth", "normal"])
    for name in first.images:
        assert first.images[name].tobytes() == again.images[name].tobytes(), name


@pytest.mark.parametrize(("view", "axis", "sign"), [("front", 1, -1), ("right", 0, 1), ("top", 2, 1), ("back", 1, 1)])
def test_a_view_sees_the_side_that_it_names(renderer, block, view, axis, sign):
    picture = renderer.render(block, view, SIZE, ["normal", "depth"])
    seen = np.isfinite(picture.depth)
    expected = np.zeros(3)
    expected[axis] = sign
    np.testing.assert_allclose(picture.normal[seen], np.broadcast_to(expected, picture.normal[seen].shape), atol=1e-6)


def opencv(width, height, focal, eye):
    """K, R and t of a camera at eye that looks along -z of the model, x to the right."""
    K = np.array([[focal, 0, (width - 1) / 2 + 7.25], [0, focal * 1.1, (height - 1) / 2 - 4.5], [0, 0, 1.0]])
    R = np.diag([1.0, -1.0, -1.0])
    return K, R, -R @ np.asarray(eye, float)


def test_a_calibrated_camera_sees_points_where_opencv_projects_them(renderer, block):
    width, height = 120, 100
    K, R, t = opencv(width, height, 160.0, (1.0, 1.4, 12.0))
    camera = selvedge.Camera.opencv(K, R, t.reshape(3, 1))
    picture = renderer.render(block, size=(width, height), outputs=["depth", "face"], camera=camera)
    top = np.array([(x, y, SIDES[2]) for x in (0.0, SIDES[0]) for y in (0.0, SIDES[1])])
    seen = (R @ top.T).T + t
    pixels = seen @ K.T
    pixels = pixels[:, :2] / pixels[:, 2:]
    rows, columns = np.nonzero(picture.face)
    # the top is nearest: its corners bound what is seen; a pixel is seen if its centre is inside
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    assert (columns.min(), rows.min()) == tuple(np.ceil(low).astype(int))
    assert (columns.max(), rows.max()) == tuple(np.floor(high).astype(int))
    np.testing.assert_allclose(picture.depth[rows, columns], 12.0 - SIDES[2], rtol=1e-6)


def test_cameras_that_show_nothing_are_refused(renderer, block):
    K, R, t = opencv(*SIZE, 100.0, (0, 0, 9))
    beside = K + np.array([[0, 0, 2e4], [0, 0, 0], [0, 0, 0]])
    oblong = K * np.array([[3.0], [1.0], [1.0]])
    skewed = K + np.array([[0, 2.0, 0], [0, 0, 0], [0, 0, 0]])
    cases = [
        (beside, R, "principal point"),
        (oblong, R, "focal lengths"),
        (skewed, R, "K must"),
        (K, R * 2, "no rotation"),
    ]
    for matrix, rotation, told in cases:
        with pytest.raises(ValueError, match=told):
            renderer.render(block, size=SIZE, camera=selvedge.Camera.opencv(matrix, rotation, t))
    with pytest.raises(ValueError):
        selvedge.Camera.opencv(K[:2], R, t)
    with pytest.raises(ValueError, match="coincide"):
        renderer.render(block, size=SIZE, camera=selvedge.Camera.look_at((1, 2, 3), (1, 2, 3)))
    with pytest.raises(ValueError, match="exclude"):
        selvedge.Camera.look_at((1, 2, 3), (0, 0, 0), fov=30, ortho=2)
    with pytest.raises(TypeError):
        selvedge.Camera.look_at("eye", (0, 0, 0))


@pytest.mark.parametrize(
    ("arguments", "error", "told"),
    [
        ({"size": (0, 64)}, ValueError, "1 to 16384"),
        ({"size": (64, -1)}, ValueError, "1 to 16384"),
        ({"size": (16385, 64)}, ValueError, "1 to 16384"),
        ({"size": (64.5, 64)}, TypeError, "size"),
        ({"size": 64}, TypeError, "size"),
        ({"outputs": "depth"}, TypeError, "outputs"),
        ({"outputs": ["depths"]}, ValueError, "depth, face"),
        ({"view": "side"}, ValueError, "iso, front"),
        ({"view": "iso,front"}, ValueError, "one view"),
        ({"view": 3}, TypeError, "view"),
        ({"style": "toon"}, ValueError, "clay"),
        ({"background": "whitish"}, ValueError, "CSS colour"),
        ({"edges": "some"}, ValueError, "sharp"),
        ({"edges": "all", "line_width": -1.0}, ValueError, "width"),
        ({"samples": 3}, ValueError, "1, 4 or 8"),
        ({"tolerance": 0.0}, ValueError, "0.1"),
        ({"tolerance": float("nan")}, ValueError, "0.1"),
        ({"camera": "iso"}, TypeError, "camera"),
        ({"sun": (0.0, 0.0, 0.0)}, ValueError, "sun must"),
        ({"sun": (0.0, float("nan"), 1.0)}, ValueError, "sun must"),
        ({"sun": "up"}, TypeError, "sun"),
        ({"ao": "some"}, ValueError, "no radius"),
        ({"ao": -1.0}, ValueError, "no radius"),
        ({"style": "mean-curvature", "curvature_range": 0.0}, ValueError, "above 0"),
    ],
)
def test_wrong_arguments_are_typed_errors(renderer, block, arguments, error, told):
    with pytest.raises(error, match=told):
        renderer.render(block, **{"size": SIZE, **arguments})


def test_what_is_no_model_is_a_type_error(renderer):
    with pytest.raises(TypeError):
        renderer.render("part.step")


def test_what_the_renderer_refuses_is_a_render_error(renderer, block):
    with pytest.raises(selvedge.RenderError):
        renderer.render(block, size=SIZE, samples=4, smooth="trims")
    assert renderer.render(block, size=SIZE).size == SIZE


def test_the_validation_layer_has_nothing_to_say(block):
    with selvedge.Renderer(validation=True) as watched:
        picture = watched.render(block, size=SIZE, outputs=["depth", "part"])
    assert np.isfinite(picture.depth).any()


def test_a_picture_beyond_the_devices_memory(block):
    """Its colour alone takes 549 MiB."""
    with selvedge.Renderer(limit_mib=256) as little:
        with pytest.raises(selvedge.RenderError, match="are left of"):
            little.render(block, size=(12000, 12000))
        assert little.render(block, size=SIZE).size == SIZE
    for wrong in (0, -1.0, float("nan")):
        with pytest.raises(ValueError, match="limit_mib must be above 0"):
            selvedge.Renderer(limit_mib=wrong)


def test_a_model_outlives_the_renderers_that_drew_it(block):
    drawn = []
    for _ in range(2):
        with selvedge.Renderer() as renderer:
            drawn.append(renderer.render(block, size=SIZE, outputs=["depth"]))
    assert drawn[0].depth.tobytes() == drawn[1].depth.tobytes()
    for call in (
        lambda: renderer.render(block, size=SIZE),
        lambda: list(renderer.render_many([{"model": block, "size": SIZE}])),
        lambda: selvedge.check(block, size=SIZE, renderer=renderer),
    ):
        with pytest.raises(selvedge.ClosedError):
            call()
    with pytest.raises(ValueError, match="judged"):
        selvedge.check(block, size=SIZE, judged=0)


def test_a_device_is_chosen_by_name_and_number(block):
    for wrong in ("no such device", "#99"):
        with pytest.raises(selvedge.DeviceError, match=f"named like `{wrong}`"):
            selvedge.Renderer(wrong)
    pictures = []
    for device in (None, "#0"):
        with selvedge.Renderer(device) as one:
            pictures.append(one.render(block, size=SIZE))
    assert pictures[0].stats["device"] == pictures[1].stats["device"]
    assert pictures[0].colour.tobytes() == pictures[1].colour.tobytes()


def test_a_closed_renderer_says_so(block):
    renderer = selvedge.Renderer()
    renderer.close()
    renderer.close()
    assert renderer.closed
    with pytest.raises(selvedge.ClosedError):
        renderer.render(block, size=SIZE)


CLOSED = """
import selvedge, sys, threading

model = selvedge.open(b"v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n", name="triangle.obj")
renderer = selvedge.Renderer()
renderer.close()
sys.setswitchinterval(1e-6)

def close():
    for _ in range(1000):
        renderer.close()

def draw():
    for _ in range(1000):
        try:
            renderer.render(model, size=(16, 16))
        except selvedge.ClosedError:
            continue
        raise AssertionError("it is closed")

threads = [threading.Thread(target=work) for work in (close, draw, close, draw)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print("done")
"""


def test_threads_close_a_renderer_while_others_are_refused():
    """While an exception is made, another thread runs: it must not wait for a lock of the first one."""
    child = [sys.executable, "-c", CLOSED]
    assert subprocess.run(child, capture_output=True, text=True, timeout=300, check=True).stdout == "done\n"


def test_many_pictures_come_in_order_from_a_generator(renderer, block):
    views = ["front", "right", "top", "front", "iso"]
    opened = []

    def jobs():
        for view in views:
            opened.append(view)
            yield {"model": block, "view": view, "size": SIZE, "outputs": ["depth"]}

    pictures = list(renderer.render_many(jobs()))
    assert opened == views
    for view, picture in zip(views, pictures):
        np.testing.assert_array_equal(picture.depth, renderer.render(block, view, SIZE, ["depth"]).depth)
    with pytest.raises(ValueError, match="ahead"):
        renderer.render_many([], ahead=0)


def device_bytes(picture):
    """Device memory of images and of what a view needs, when the picture was there."""
    return {pool["name"]: pool["bytes"] for pool in picture.stats["pools"]}["transient"]


def at_rest(renderer, model, outputs):
    """The same with room for every view, after the last picture twice: the second frees what the first replaced."""
    pictures = [renderer.render(model, view, LARGE, outputs) for view in [*TURN, TURN[-1]]]
    return device_bytes(pictures[-1])


def test_pictures_in_flight_have_the_bytes_of_one_by_one(renderer, bracket, block):
    outputs = ["depth", "face", "uv", "normal", "part"]
    alone = [renderer.render(bracket, view, LARGE, outputs) for view in TURN]
    rest = at_rest(renderer, bracket, outputs)
    jobs = [{"model": bracket, "view": view, "size": LARGE, "outputs": outputs} for view in TURN]
    for ahead in (1, 2, 3, 8):
        many = list(renderer.render_many(jobs, ahead))
        assert len(many) == len(alone)
        for view, one, other in zip(TURN, alone, many):
            assert one.camera == other.camera
            for name in one.images:
                assert one.images[name].tobytes() == other.images[name].tobytes(), (ahead, view, name)
        if ahead > 1:  # a picture in flight has a colour image of its own
            assert max(map(device_bytes, many)) >= rest + 4 * LARGE[0] * LARGE[1]
        assert all(picture.stats["draw_s"] > 0 and picture.stats["upload_s"] > 0 for picture in many)
    # other sizes together, other models one after the other
    sizes = [{**job, "size": size} for job in jobs[:3] for size in (SIZE, LARGE)]
    mixed = [{**job, "model": model} for model in (bracket, block, bracket) for job in sizes]
    for job, picture in zip(mixed, list(renderer.render_many(mixed))):
        assert picture.colour.tobytes() == renderer.render(**job).colour.tobytes()


def test_closing_early_frees_what_was_in_flight(renderer, bracket):
    rest = at_rest(renderer, bracket, ["depth"])
    begun = []

    def jobs():
        for view in TURN * 10:
            begun.append(view)
            yield {"model": bracket, "view": view, "size": LARGE, "outputs": ["depth"]}

    many = renderer.render_many(jobs(), ahead=3)
    first = [device_bytes(next(many)) for _ in range(6)]
    many.close()
    assert len(begun) == 6 + 3
    assert max(first) > rest
    assert at_rest(renderer, bracket, ["depth"]) == rest


def test_a_job_that_fails_is_named_after_the_pictures_before_it(renderer, block):
    good = {"model": block, "size": SIZE}
    cases = [
        ({**good, "view": "side"}, ValueError, "block.obj.*iso, front"),
        ({**good, "samples": 4, "smooth": "trims"}, selvedge.RenderError, "block.obj.*smooth trims"),
        ({**good, "sizes": SIZE}, TypeError, "block.obj.*no argument sizes"),
        ({**good, "model": "block.obj"}, TypeError, "job 2: "),
        ({"size": SIZE}, TypeError, "needs a model"),
        (7, TypeError, "mapping"),
    ]
    for bad, kind, told in cases:
        taken = []
        with pytest.raises(kind, match=told) as failed:
            for picture in renderer.render_many([good, {**good, "view": "top"}, bad, good, good]):
                taken.append(picture)
        assert str(failed.value).startswith("job 2") and failed.value.job == 2
        assert len(taken) == 2, "the pictures before it"
        assert taken[0].colour.tobytes() == renderer.render(**good).colour.tobytes()


def test_an_exception_of_the_generator_comes_after_the_pictures_before_it(renderer, block):
    class Mine(Exception):
        pass

    def jobs():
        yield {"model": block, "size": SIZE}
        yield {"model": block, "size": SIZE, "view": "top"}
        raise Mine("of my own")

    taken = []
    with pytest.raises(Mine, match="^of my own$") as failed:
        for picture in renderer.render_many(jobs()):
            taken.append(picture)
    assert len(taken) == 2 and not hasattr(failed.value, "job")


def test_pictures_that_wait_when_the_renderer_closes_are_drawn(block):
    renderer = selvedge.Renderer()
    many = renderer.render_many([{"model": block, "size": SIZE, "view": view} for view in TURN], ahead=3)
    first = next(many)
    renderer.close()
    rest = []
    with pytest.raises(selvedge.ClosedError, match="job 4") as failed:
        for picture in many:
            rest.append(picture)
    assert failed.value.job == 4 and len(rest) == 3 and first.size == SIZE


def test_other_threads_run_while_pictures_are_drawn(renderer, bracket):
    ticks, done = [], threading.Event()

    def tick():
        while not done.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.monotonic()
    jobs = ({"model": bracket, "view": view, "size": LARGE, "samples": 8} for view in TURN)
    assert len(list(renderer.render_many(jobs))) == len(TURN)
    ended = time.monotonic()
    done.set()
    thread.join()
    # of the ticks that an idle machine has, one in twenty; none where the interpreter is locked
    assert sum(begun < tick < ended for tick in ticks) > (ended - begun) / 0.005 / 20


def test_threads_share_a_renderer(renderer, block, bracket):
    expected = {id(model): renderer.render(model, size=SIZE).colour for model in (block, bracket)}
    wrong = []

    def draw(model):
        for _ in range(2):
            if not np.array_equal(renderer.render(model, size=SIZE).colour, expected[id(model)]):
                wrong.append(model)

    threads = [threading.Thread(target=draw, args=(model,)) for model in (block, bracket)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_a_picture_saves_and_shows_itself(renderer, block, tmp_path):
    picture = renderer.render(block, size=SIZE)
    picture.save(tmp_path / "block.png")
    saved = (tmp_path / "block.png").read_bytes()
    assert saved[:8] == b"\x89PNG\r\n\x1a\n" and saved == picture._repr_png_()
    assert (int.from_bytes(saved[16:20], "big"), int.from_bytes(saved[20:24], "big")) == SIZE
    with pytest.raises(ValueError, match=".png"):
        picture.save(tmp_path / "block.jpg")
    with pytest.raises(OSError, match="cannot write"):
        picture.save(tmp_path / "none" / "block.png")


def test_the_judge_finds_the_promise_kept(renderer, bracket):
    verdict = selvedge.check(bracket, "iso", (160, 120), judged=2000, renderer=renderer)
    assert verdict["kept"] and verdict["seen"] and verdict["wrong"] == 0
    assert verdict["judged"] >= 2000 and verdict["worst_shift_px"] <= 0.5
    assert verdict["judgement"]["agree"] > 0 and verdict["camera"]["size"] == [160, 120]
