"""Programs that run in processes of their own, by the packages of others. Each takes a file with its job, and prints
results as lines that begin with `RESULT`, one as soon as it is known, so that a limit of time keeps what came before
it.
"""

import json
import sys


def job():
    """What the caller wants, as it wrote it."""
    with open(sys.argv[1]) as text:
        return json.load(text)


def tell(result):
    print("RESULT " + json.dumps(result), flush=True)
