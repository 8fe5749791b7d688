"""The conditions of a run: the processor, its load, the commit, and the commands."""

import datetime
import os
import platform
import re
import shlex
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def processor():
    name = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        found = re.search(r"^model name\s*:\s*(.+)$", info.read_text(), re.M)
        name = found.group(1) if found else name
    return f"{name}, {os.cpu_count()} cores"


def load():
    """Load of the last minute: processes that ran or waited for a core."""
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def commit():
    """The commit, with a plus if tracked files differ from it.

    The report's own files do not count: runs of single sections that follow each other measure the same engine.
    """
    git = lambda *words: subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":(exclude)docs/benchmarks*")
    return (git("rev-parse", "--short", "HEAD") or "unknown") + ("+" if changed else "")


def date():
    return datetime.date.today().isoformat()


def shown(command, folders=()):
    """A command as a reader can run it: the program's name, no folders of this machine.

    `folders` are pairs of a path and what stands for it.
    """
    words = [str(word) for word in command]
    words[0] = Path(words[0]).name
    for path, name in folders:
        words = [word.replace(str(path), name) for word in words]
    return " ".join(word if word.startswith("$") else shlex.quote(word) for word in words)
