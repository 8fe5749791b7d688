"""The cameras of all competitors: eye, target, up (mm), fovy (degrees from top to bottom) and size (pixels)."""

import math

FOV_DEG, ELEVATION_DEG, STEP_DEG = 35.0, 30.0, 3.0


def turned(bounds, size, step, fov=FOV_DEG):
    """The whole model from 30 degrees above its front, turned by steps, as `selvedge bench --motion turn` does."""
    low, high = bounds
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    around, up = math.radians(STEP_DEG * step), math.radians(ELEVATION_DEG)
    towards = (math.sin(around) * math.cos(up), -math.cos(around) * math.cos(up), math.sin(up))
    half = math.atan(math.tan(math.radians(fov) / 2) * min(size[0] / size[1], 1))
    distance = math.dist(low, high) / 2 / math.sin(half)
    eye = [c + distance * t for c, t in zip(centre, towards)]
    return {"eye": eye, "target": centre, "up": [0.0, 0.0, 1.0], "fovy": fov, "size": list(size)}


def turn(bounds, size, frames):
    return [turned(bounds, size, step) for step in range(frames)]


def pixel_mm(camera):
    """Side of a pixel at the camera's target."""
    return (
        2 * math.tan(math.radians(camera["fovy"]) / 2) * math.dist(camera["eye"], camera["target"]) / camera["size"][1]
    )
