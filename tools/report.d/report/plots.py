"""Plots as SVG, by matplotlib; the same figures give the same bytes."""

# a shape for each line: curves that coincide stay apart
MARKERS = "osD^vP"


def write(plot, path):
    """Raises ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "selvedge", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.2, 4.2), layout="constrained")
    for nth, line in enumerate(plot.lines):
        points = sorted((x, y) for x, y in line.points if x > 0 and y > 0)
        if points:
            style = {"linewidth": 2.2, "zorder": 3} if line.ours else {"linewidth": 1.2, "linestyle": "--"}
            marker = MARKERS[nth % len(MARKERS)]
            axes.plot(*zip(*points), marker=marker, markersize=4.5, label=line.name, **style)
    axes.set(xscale="log", yscale="log", xlabel=plot.x, ylabel=plot.y, title=plot.title)
    for axis in (axes.xaxis, axes.yaxis):
        ticks(axis)
    axes.grid(True, which="major", alpha=0.3)
    if len(plot.lines) > 1:
        figure.legend(loc="outside right upper", fontsize=8)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def ticks(axis):
    """Plain numbers at powers of ten; at twice and five times these, too, where the axis spans few of them."""
    import math

    from matplotlib import ticker

    low, high = axis.get_view_interval()
    decades = math.log10(high / low)
    subs = (1, 1.5, 2, 3, 5, 7) if decades < 0.7 else (1, 2, 5) if decades < 2.5 else (1,)
    axis.set_major_locator(ticker.LogLocator(subs=subs, numticks=12))
    axis.set_minor_locator(ticker.NullLocator())
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: plain(value)))


def plain(value):
    """A tick's number: 0.05, 20, 10,000; from a million on and below a thousandth in powers."""
    if 1e-3 <= value < 1e6:
        return f"{value:,.0f}" if value >= 100 else f"{value:.4g}"
    return f"{value:.0e}".replace("e+0", "e").replace("e-0", "e-")
