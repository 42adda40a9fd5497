"""A balloon: why it is hard to blow up at first, then easy, then hard again.

The pressure of a Mooney-Rivlin balloon rises to a limit point, falls, and rises again past a second one. At
held pressure the falling part is unstable (dashed): a balloon that reaches the first limit point jumps. The
larger the constant alpha = C2/C1, the closer the two points; at the cusp they merge, and a stiffer balloon
has none. Run: ``./run shell -c "python3 examples/gallery/balloon.py balloon.svg"``.
"""

import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import weakforms
from weakforms.results import SpecialPoint


def number(point: SpecialPoint, name: str) -> weakforms.Quantity:
    """A value of a special point with its uncertainty."""
    return weakforms.Quantity(point.values[name], point.uncertainty[name])


# %%
figure = FigureCanvasAgg(Figure(figsize=(8, 3.6), layout="constrained")).figure
curves, folds = figure.subplots(1, 2)
for alpha in (0.05, 0.1, 0.3):
    result = weakforms.solve("sphere", alpha=alpha, lam_end=6)
    branch = result.branch()
    unstable = branch["n_negative"] > 0
    (line,) = curves.plot(branch["lam"], branch["P"], lw=0.8, alpha=0.4)
    for part, style in ((~unstable, "-"), (unstable, "--")):
        values = branch["P"].copy()
        values[~part] = float("nan")
        curves.plot(branch["lam"], values, style, color=line.get_color(), lw=2)
    end = branch["lam"][-1], branch["P"][-1]
    curves.annotate(f"alpha = {alpha}", end, (-9, 1), textcoords="offset points", ha="right", va="bottom")
    for k, point in enumerate(result.points("limit_point"), 1):
        curves.plot(point.values["lam"], point.values["P"], "ko", ms=4)
        print(f"alpha = {alpha}: limit point {k} at P = {number(point, 'P')}")

# %%
fold = weakforms.solve("sphere", vary="alpha", vary_end=0.3, alpha=0.05)
(cusp,) = fold.points("cusp_point")
line = fold.branch("fold")
folds.plot(line["alpha"], line["P"])
folds.plot(cusp.values["alpha"], cusp.values["P"], "k*", ms=9)
place = cusp.values["alpha"], cusp.values["P"]
folds.annotate("cusp", place, (-9, 0), textcoords="offset points", ha="right")
print(f"the limit points merge at alpha = {number(cusp, 'alpha')}")

# %%
curves.margins(y=0.08)
curves.set(xlabel="stretch", ylabel="pressure p r/(C1 h)", title="dashed: unstable at held pressure")
folds.set(xlabel="alpha = C2/C1", ylabel="pressure of the limit points", title="where limit points exist")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "balloon.svg")
