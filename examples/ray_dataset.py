"""Renders a folder of CAD files with Ray Data: depth, normals and face numbers into Parquet shards, and a manifest.

    tools/wheel && pip install "ray[data]" out/selvedge-*.whl
    python examples/ray_dataset.py FOLDER OUT --views iso front top --size 256 256 --workers 2 [--gpus]

Each worker has a renderer of its own, on the CPU or, with --gpus, on a GPU that no other worker has. Each file becomes
one shard, OUT/shards/NAME-HASH.parquet, with a row for each view. A shard appears whole or not at all. If a worker dies,
another one draws its file again, so every file has one shard. OUT/manifest.parquet has a row for each file: SHA-256,
shard, status, error, counts, seconds.
"""

import argparse
import hashlib
import os
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import selvedge

OUTPUTS = ["depth", "normal", "face"]


class Draw:
    """A worker: draws files one after another with its own renderer."""

    def __init__(self, out, views, size, gpus=False):
        self.out, self.views, self.size = Path(out), views, size
        device = None
        if gpus:
            import ray

            device = f"#{ray.get_gpu_ids()[0]}"
        self.renderer = selvedge.Renderer(device)

    def __call__(self, batch):
        rows = [self.one(Path(str(file))) for file in batch["file"]]
        return {key: [row[key] for row in rows] for key in rows[0]}

    def one(self, file):
        """Draws a file, writes its shard, and returns its row of the manifest."""
        start = time.perf_counter()
        row = {"file": str(file), "sha256": "", "shard": "", "status": "drawn", "error": ""}
        row |= {"faces": 0, "warnings": 0, "complete": False, "clamps": 0}
        try:
            content = file.read_bytes()
            row["sha256"] = hashlib.sha256(content).hexdigest()
            model = selvedge.open(file)
            row |= {"faces": len(model.faces), "warnings": len(model.warnings), "complete": model.complete}
            pictures = [self.renderer.render(model, view, self.size, OUTPUTS) for view in self.views]
            row["clamps"] = sum(picture.stats["clamps"] for picture in pictures)
            row["shard"] = self.write(file, row["sha256"], pictures)
        except (OSError, selvedge.Error) as error:
            row |= {"status": "failed", "error": str(error)}
        return row | {"seconds": time.perf_counter() - start}

    def write(self, file, digest, pictures):
        """One row a view; arrays as the bytes of their numbers, little-endian, row by row."""
        columns = {"view": self.views, "width": [self.size[0]] * len(pictures), "height": [self.size[1]] * len(pictures)}
        for name in OUTPUTS:
            columns[name] = [getattr(picture, name).tobytes() for picture in pictures]
        # the hash includes the path: files of one name and content in several folders get a shard each
        place = hashlib.sha256(f"{file}\0{digest}".encode()).hexdigest()[:16]
        shard = self.out / "shards" / f"{file.stem}-{place}.parquet"
        beside = shard.with_suffix(f".{os.getpid()}.part")
        pq.write_table(pa.table(columns), beside, compression="zstd")
        os.replace(beside, shard)
        return shard.name


def run(files, out, views, size, workers, draw=Draw, gpus=False):
    """Draws the files with `workers` workers; returns the manifest."""
    import ray

    out = Path(out)
    (out / "shards").mkdir(parents=True, exist_ok=True)
    jobs = ray.data.from_items([{"file": str(file)} for file in files], override_num_blocks=len(files))
    settings = {"fn_constructor_args": (str(out), list(views), tuple(size), gpus), "num_cpus": 1, "num_gpus": int(gpus)}
    pool = ray.data.ActorPoolStrategy(size=workers)
    rows = jobs.map_batches(draw, batch_size=1, compute=pool, **settings).take_all()
    for left in (out / "shards").glob("*.part"):  # workers that died leave these behind
        left.unlink()
    manifest = pa.Table.from_pylist(sorted(rows, key=lambda row: row["file"]))
    pq.write_table(manifest, out / "manifest.parquet")
    return manifest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--views", nargs="+", default=["iso", "front", "top"])
    parser.add_argument("--size", nargs=2, type=int, default=[256, 256])
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--gpus", action="store_true", help="a GPU for each worker")
    asked = parser.parse_args()
    endings = {".step", ".stp", ".iges", ".igs", ".obj", ".stl", ".3mf", ".3dm", ".csg"}
    files = sorted(path for path in asked.folder.rglob("*") if path.suffix.lower() in endings)
    if not files:
        parser.error(f"{asked.folder} holds no CAD file")
    manifest = run(files, asked.out, asked.views, asked.size, asked.workers, gpus=asked.gpus)
    failed = manifest.column("status").to_pylist().count("failed")
    print(f"{len(files) - failed} of {len(files)} files are drawn: {asked.out / 'manifest.parquet'}")
    raise SystemExit(failed > 0)


if __name__ == "__main__":
    main()
