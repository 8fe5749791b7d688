"""Programs that run in separate processes and use the peers' packages. Each takes a file with its job, and prints
results as lines that begin with `RESULT`, each as soon as it is known, so that the results before a limit of time are
kept.
"""

import json
import sys


def job():
    """The job that the caller wrote."""
    with open(sys.argv[1]) as text:
        return json.load(text)


def tell(result):
    print("RESULT " + json.dumps(result), flush=True)
