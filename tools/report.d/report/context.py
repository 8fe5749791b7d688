"""The context of all sections: options, the program, the peers, files, a scratch folder, and the time."""

import os
import sys
from dataclasses import dataclass, field
from pathlib import Path

from .budget import Budget
from .machine import ROOT, shown
from .peers import Peers
from .program import Program
from .rows import Missing


@dataclass
class Context:
    quick: bool
    program: Program
    peers: Peers
    scratch: Path
    models: Path | None
    # of the section that is measured
    budget: Budget | None = None
    # seconds of `floor.floor_s` by size
    floors: dict = field(default_factory=dict)

    def give(self, budget):
        """Time for the next section: its processes end with it."""
        self.budget = self.program.budget = self.peers.budget = budget

    def pick(self, quick, whole):
        return quick if self.quick else whole

    def model(self, name):
        """A file of `samples`, or of the folder that SELVEDGE_MODELS names; None where it is not there."""
        path = ROOT / name if name.startswith("samples/") else self.models and self.models / name
        return path if path and path.exists() else None

    def absent(self, name):
        return Missing(
            f"{name} is not in the folder that SELVEDGE_MODELS names"
            if self.models
            else "SELVEDGE_MODELS names no folder"
        )

    def shown(self, *words, program="selvedge"):
        """A command of the program, or of another one, as it stands in the document."""
        folders = [(self.models, "$SELVEDGE_MODELS")] if self.models else []
        return shown([program, *words], [*folders, (f"{ROOT}/", "")])

    def say(self, text):
        print(f"   {text}", file=sys.stderr, flush=True)


def models():
    folder = os.environ.get("SELVEDGE_MODELS")
    return Path(folder).resolve() if folder else None
