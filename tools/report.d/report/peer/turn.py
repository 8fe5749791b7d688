"""Times of a viewer's turn."""

import time


def turned(look, turn):
    """Milliseconds of a frame of a turn, after two that are not measured; None without a turn."""
    if not turn:
        return None
    for camera in turn[:2]:
        look(camera)
    start = time.perf_counter()
    for camera in turn:
        look(camera)
    return (time.perf_counter() - start) * 1e3 / len(turn)
