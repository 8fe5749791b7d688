"""A Python with Open CASCADE (cadquery-ocp) and numpy, for the tools that compare with that kernel."""
import os, pathlib, subprocess, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def python():
    """Its path: SELVEDGE_OCC where that is set, else .venv, into which the packages are installed. Ends the program
    with a sentence where there is none."""
    named = os.environ.get('SELVEDGE_OCC')
    own = pathlib.Path(named) if named else ROOT / '.venv/bin/python'
    has = lambda: subprocess.run([own, '-c', 'import OCP, numpy'], capture_output=True).returncode == 0
    try:
        if not named and not own.exists():
            subprocess.run([sys.executable, '-m', 'venv', str(ROOT / '.venv')], check=True)
        if not has() and not named:
            subprocess.run([own, '-m', 'pip', 'install', '-q', 'cadquery-ocp', 'numpy'], check=True)
        if has():
            return str(own)
    except (OSError, subprocess.CalledProcessError) as error:
        print(error, file=sys.stderr)
    sys.exit(f'{own} has no cadquery-ocp and numpy: SELVEDGE_OCC names a Python that has them')
