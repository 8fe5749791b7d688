#!/usr/bin/env python3
"""`selvedge draw` beside the hidden line removal of Open CASCADE (HLRBRep_Algo, which cadquery's exportSVG calls).

    compare_hlr.py [--view VIEW] [--limit SECONDS] MODEL.step ...      a Python with cadquery-ocp and numpy

The same file, parallel view and machine, one after the other. A row a file: seconds to read and to draw of each, and
lengths in pixels of a picture of 1920 x 1080. `both`: visible lines of selvedge (sharp, borders, silhouettes) within 0.5 px
of any visible line of the kernel; `ours alone`: the others; `theirs alone`: visible sharp lines and outlines of the kernel
without any visible line of selvedge within 0.5 px, in two columns: along a hidden line of selvedge, or along none.
Smooth edges count as lines nearby, but are themselves not looked for: the programs differ about which edges are smooth.
SELVEDGE names the program; target/release/selvedge without it.
"""
import argparse, json, multiprocessing, os, re, subprocess, sys, tempfile, time
import numpy as np

SIZE = (1920, 1080)
WIDTH_MM = 297.0
# pixels: a line counts as found within this distance
NEAR = 0.5
# pixels between points of lines
STEP = 0.1
# cells of the raster in a pixel
FINE = 4


def sampled(points):
    """Points of polylines, and the length of line that each represents."""
    out, weights = [], []
    for line in points:
        line = np.asarray(line, float)
        if len(line) < 2:
            continue
        lengths = np.hypot(*np.diff(line, axis=0).T)
        at = np.concatenate([[0.0], np.cumsum(lengths)])
        count = max(1, int(np.ceil(at[-1] / STEP)))
        middle = (np.arange(count) + 0.5) * at[-1] / count
        out.append(np.stack([np.interp(middle, at, line[:, k]) for k in (0, 1)], axis=1))
        weights.append(np.full(count, at[-1] / count))
    if not out:
        return np.zeros((0, 2)), np.zeros(0)
    return np.concatenate(out), np.concatenate(weights)


class Raster:
    """Cells near a line."""

    def __init__(self, points):
        self.near = np.zeros((SIZE[1] * FINE, SIZE[0] * FINE), bool)
        reach = int(NEAR * FINE)
        cells = np.floor(points * FINE).astype(int)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                if dx * dx + dy * dy <= reach * reach:
                    x, y = cells[:, 0] + dx, cells[:, 1] + dy
                    good = (x >= 0) & (y >= 0) & (x < self.near.shape[1]) & (y < self.near.shape[0])
                    self.near[y[good], x[good]] = True

    def holds(self, points):
        cells = np.floor(points * FINE).astype(int)
        x = np.clip(cells[:, 0], 0, self.near.shape[1] - 1)
        y = np.clip(cells[:, 1], 0, self.near.shape[0] - 1)
        return self.near[y, x]


def cubic(p, count=24):
    t = np.linspace(0.0, 1.0, count + 1)[:, None]
    s = 1.0 - t
    return p[0] * s ** 3 + p[1] * 3 * s * s * t + p[2] * 3 * s * t * t + p[3] * t ** 3


def ours(model, view, folder):
    """Seconds to read, seconds to draw, lines by kind (visible-sharp, hidden-sharp, …), camera."""
    svg, camera = os.path.join(folder, 'ours.svg'), os.path.join(folder, 'camera.json')
    program = os.environ.get('SELVEDGE', 'target/release/selvedge')
    call = [program, '-v', 'draw', model, '-o', svg, '--view', view, '--camera-out', camera,
            '--size', '%dx%d' % SIZE, '--width', str(WIDTH_MM), '--hidden-lines']
    start = time.time()
    told = subprocess.run(call, capture_output=True, text=True, check=True).stderr
    wall = time.time() - start
    text = open(svg).read()
    lines = {}
    for kind, group in re.findall(r'<g id="([\w-]+)"[^>]*>(.*?)</g>', text, re.S):
        for d in re.findall(r' d="([^"]*)"', group):
            parts = re.findall(r'([MLCZ])([^MLCZ]*)', d)
            line, at, first = [], None, None
            for command, numbers in parts:
                p = np.array(numbers.split(), float).reshape(-1, 2) * (SIZE[0] / WIDTH_MM)
                if command == 'M':
                    line, first = [p[0]], p[0]
                elif command == 'L':
                    line.append(p[0])
                elif command == 'C':
                    line.extend(cubic(np.concatenate([[at], p]))[1:])
                elif not np.array_equal(at, first):
                    line.append(first)
                at = line[-1]
            lines.setdefault(kind, []).append(line)
    drawn = re.search(r'lines in ([\d.]+)(ms|s|µs)', told)
    unit = {'s': 1.0, 'ms': 1e-3, 'µs': 1e-6}
    drawn = float(drawn[1]) * unit[drawn[2]]
    return wall - drawn, drawn, lines, json.load(open(camera))


def theirs(model, camera, answer):
    """The same for the kernel, in a separate process."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.BRepLib import BRepLib
    from OCP.GCPnts import GCPnts_QuasiUniformDeflection
    from OCP.HLRAlgo import HLRAlgo_Projector
    from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_EDGE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    start = time.time()
    reader = STEPControl_Reader()
    reader.ReadFile(model)
    reader.TransferRoots()
    shape = reader.OneShape()
    read = time.time() - start
    eye, target, up = (np.array(camera[k]) for k in ('eye', 'target', 'up'))
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    start = time.time()
    BRepLib.EncodeRegularity_s(shape)
    hlr = HLRBRep_Algo()
    hlr.Add(shape)
    hlr.Projector(HLRAlgo_Projector(gp_Ax2(gp_Pnt(*target), gp_Dir(*back), gp_Dir(*right))))
    hlr.Update()
    hlr.Hide()
    found = HLRBRep_HLRToShape(hlr)
    kinds = {'sharp': found.VCompound(), 'smooth': found.Rg1LineVCompound(), 'sewn': found.RgNLineVCompound(),
             'outline': found.OutLineVCompound()}
    scale = SIZE[1] / (2.0 * camera['ortho'])
    lines = {}
    for kind, compound in kinds.items():
        if compound is None or compound.IsNull():
            continue
        BRepLib.BuildCurves3d_s(compound)
        explorer = TopExp_Explorer(compound, TopAbs_EDGE)
        while explorer.More():
            curve = BRepAdaptor_Curve(TopoDS.Edge(explorer.Current()) if hasattr(TopoDS, 'Edge') else TopoDS.Edge_s(explorer.Current()))
            points = GCPnts_QuasiUniformDeflection(curve, 0.02 / scale)
            line = [points.Value(k) for k in range(1, points.NbPoints() + 1)] if points.IsDone() else []
            lines.setdefault(kind, []).append([(p.X() * scale + SIZE[0] / 2, SIZE[1] / 2 - p.Y() * scale) for p in line])
            explorer.Next()
    answer.put((read, time.time() - start, lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--view', default='iso')
    parser.add_argument('--limit', type=float, default=600.0, help='seconds for the kernel, a file')
    parser.add_argument('models', nargs='+')
    args = parser.parse_args()
    print('| file | selvedge: read, s | draw, s | kernel: read, s | draw, s | both, px | ours alone | theirs alone: hidden, none |')
    print('|---|---|---|---|---|---|---|---|')
    for model in args.models:
        with tempfile.TemporaryDirectory() as folder:
            read, drawn, lines, camera = ours(model, args.view, folder)
        answer = multiprocessing.Queue()
        process = multiprocessing.Process(target=theirs, args=(model, camera, answer))
        process.start()
        start = time.time()
        result = None
        while result is None and time.time() - start < args.limit and (process.is_alive() or not answer.empty()):
            try:
                result = answer.get(timeout=1.0)
            except Exception:
                pass
        process.kill()
        name = os.path.basename(model)
        row = '| %s | %.2f | %.2f |' % (name, read, drawn)
        if result is None:
            why = 'failed' if time.time() - start < args.limit else 'not done after %d s' % args.limit
            print(row, '%s | | | | |' % why, flush=True)
            continue
        flat = lambda d, kinds: sampled([line for kind in kinds for line in d.get(kind, [])])
        mine, mine_length = flat(lines, ('visible-sharp', 'visible-border', 'visible-silhouette'))
        near_mine, near_hidden = (Raster(flat(lines, [k for k in lines if k.startswith(of)])[0]) for of in ('visible', 'hidden'))
        other, other_length = flat(result[2], ('sharp', 'outline'))
        near_other = Raster(flat(result[2], result[2])[0])
        common = near_other.holds(mine)
        theirs_too, hidden = near_mine.holds(other), near_hidden.holds(other)
        print(row, '%.2f | %.2f | %.0f | %.0f | %.0f, %.0f |' % (result[0], result[1], mine_length[common].sum(),
              mine_length[~common].sum(), other_length[~theirs_too & hidden].sum(), other_length[~theirs_too & ~hidden].sum()), flush=True)


if __name__ == '__main__':
    main()
