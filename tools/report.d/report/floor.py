"""The floor under every first picture of ours: a process that draws one plane."""

from .noise import FEWEST_ROUNDS, median

PLANE = '[surface.plane]\nshape = "plane"\nu = [-20, 20]\nv = [-15, 15]\n'
CAMERA = {"eye": [50.0, -80.0, 55.0], "target": [0.0, 0.0, 0.0], "up": [0.0, 0.0, 1.0], "fovy": 35.0}


def floor_s(context, size):
    """Seconds of the whole process at a size, a median; measured once a size."""
    size = tuple(size)
    if size not in context.floors:
        path = context.program.folder() / "plane.toml"
        path.write_text(f"selvedge = 1\n{PLANE}")
        camera = {**CAMERA, "size": list(size)}
        seconds = [context.program.render(path, camera, stats=False)["seconds"] for _ in range(FEWEST_ROUNDS)]
        context.floors[size] = median(seconds)
    return context.floors[size]


def cause(context, size):
    """The floor as the cause of a first picture's time."""
    seconds = floor_s(context, size)
    return f"a process of ours that draws one plane takes {seconds:.2f} s at {size[0]}x{size[1]}"
