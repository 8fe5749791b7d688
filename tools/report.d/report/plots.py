"""Plots as SVG, by matplotlib; the same figures give the same bytes."""


def write(plot, path):
    """Raises ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "selvedge", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.4, 4.2), layout="constrained")
    for line in plot.lines:
        points = sorted((x, y) for x, y in line.points if x > 0 and y > 0)
        if points:
            style = {"linewidth": 2.2, "zorder": 3} if line.ours else {"linewidth": 1.2, "linestyle": "--"}
            axes.plot(*zip(*points), marker="o", markersize=4, label=line.name, **style)
    axes.set(xscale="log", yscale="log", xlabel=plot.x, ylabel=plot.y, title=plot.title)
    axes.grid(True, which="major", alpha=0.3)
    axes.legend(fontsize=8)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)
