"""examples/ray_dataset.py with local Ray: two workers, forty files, one worker killed in the middle."""

import importlib.util
import os
import pathlib
import signal
import sys

import needs
import pytest

EXAMPLE = pathlib.Path(__file__).parents[3] / "examples/ray_dataset.py"
FILES, VIEWS, SIZE = 40, ["iso", "top"], (48, 32)


def block(k):
    """A box whose size no other box has."""
    x, y, z = 1.0 + 0.1 * k, 2.0 + 0.05 * k, 3.0
    corner = [(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0), (0, 0, z), (x, 0, z), (x, y, z), (0, y, z)]
    sides = ["1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]
    return "".join(f"v {a} {b} {c}\n" for a, b, c in corner) + "".join(f"f {side}\n" for side in sides)


@pytest.fixture(scope="module")
def example():
    ray = needs.package("ray", "ray")
    needs.package("pyarrow", "pyarrow")
    spec = importlib.util.spec_from_file_location("ray_dataset", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    sys.modules["ray_dataset"] = module
    spec.loader.exec_module(module)
    ray.cloudpickle.register_pickle_by_value(module)
    ray.cloudpickle.register_pickle_by_value(sys.modules[__name__])
    ray.init(num_cpus=3, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": dict(os.environ)})
    yield module
    ray.shutdown()


def test_a_worker_dies_and_every_file_is_there_once(example, tmp_path):
    pq = example.pq
    source = tmp_path / "models"
    source.mkdir()
    files = [source / f"block{k:02}.obj" for k in range(FILES)]
    for k, file in enumerate(files):
        file.write_text(block(k) if k != 7 else "nothing of a model\n")
    died = tmp_path / "died"

    class Mortal(example.Draw):
        def one(self, file):
            if file.stem == "block20" and not died.exists():
                died.write_text(str(os.getpid()))
                os.kill(os.getpid(), signal.SIGKILL)
            return super().one(file)

    manifest = example.run(files, tmp_path / "out", VIEWS, SIZE, 2, draw=Mortal).to_pylist()
    assert died.exists(), "no worker was killed"
    assert [row["file"] for row in manifest] == [str(file) for file in files]
    assert [row["file"] for row in manifest if row["status"] == "failed"] == [str(files[7])]
    assert "block07" in manifest[7]["error"]
    shards = sorted(path.name for path in (tmp_path / "out/shards").iterdir())
    assert shards == sorted(row["shard"] for row in manifest if row["shard"]) and len(shards) == FILES - 1

    # one process draws the same
    (tmp_path / "alone/shards").mkdir(parents=True)
    alone = example.Draw(tmp_path / "alone", VIEWS, SIZE)
    for row in manifest:
        again = alone.one(pathlib.Path(row["file"]))
        assert {**again, "seconds": 0} == {**row, "seconds": 0}
        if row["shard"]:
            drawn = [pq.read_table(tmp_path / folder / "shards" / row["shard"]) for folder in ("out", "alone")]
            assert drawn[0].equals(drawn[1]) and drawn[0].num_rows == len(VIEWS)
    seen = {pq.read_table(tmp_path / "out/shards" / shard).column("depth")[0].as_py() for shard in shards}
    assert len(seen) == FILES - 1, "each block has a depth image of its own"
