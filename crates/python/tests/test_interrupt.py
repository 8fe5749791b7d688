"""Ctrl-C."""

import pathlib
import signal
import subprocess
import sys

import pytest

SAMPLES = pathlib.Path(__file__).parents[3] / "samples"

INTERRUPTED = """
import selvedge, signal, sys, threading, time
# a shell's background jobs ignore it, and so do their children
signal.signal(signal.SIGINT, signal.default_int_handler)
spheres = "".join(f"v {i % 100} {i // 100} {(i * 7919) % 97 / 9}\\n" for i in range(100 * 100))
quads = "".join(f"f {a+1} {a+2} {a+102} {a+101}\\n" for a in range(9800) if a % 100 < 99)
model = selvedge.open((spheres + quads).encode(), name="sheet.obj")
renderer = selvedge.Renderer()
if sys.argv[1] == "render":
    work = lambda: [renderer.render(model, size=(4000, 4000), samples=8, outputs=["depth"]) for _ in range(50)]
elif sys.argv[1] == "many":
    job = {"model": model, "size": (2000, 2000), "samples": 8, "outputs": ["depth"]}
    work = lambda: [picture.size for picture in renderer.render_many([job] * 200)]
else:
    work = lambda: [selvedge.open(sys.argv[1]) for _ in range(1000)]
print("ready", flush=True)
begun = time.monotonic()
try:
    work()
except KeyboardInterrupt:
    print("interrupted", flush=True)
    import os
    os._exit(0)
"""


@pytest.mark.parametrize("work", ["render", "many", str(SAMPLES / "assembly.step")])
def test_control_c_ends_it(work):
    child = subprocess.Popen([sys.executable, "-c", INTERRUPTED, work], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    with pytest.raises(subprocess.TimeoutExpired):  # it is at work
        child.wait(0.5)
    child.send_signal(signal.SIGINT)
    assert child.communicate(timeout=10)[0] == "interrupted\n"
