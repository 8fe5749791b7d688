"""Open CASCADE reads files: job {models}, results {model, read_s}; read and transferred to shapes, without a mesh."""

from . import job, shapes, tell


def main():
    for model in job()["models"]:
        tell({"model": model, "read_s": shapes.read(model)[1]})


if __name__ == "__main__":
    main()
