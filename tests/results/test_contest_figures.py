import io
from xml.etree import ElementTree

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from safe.results import figures
from safe.results.statistics import mean_over_mazes

mpl.use("agg")
RATES = pd.DataFrame(
    [
        ("one", "slow", 0.1),
        ("two", "slow", 0.3),
        ("three", "slow", 0.3),
        ("four", "slow", 1.0),
        ("one", "quick", 0.6),
        ("two", "quick", 0.5),
        ("three", "quick", 0.5),
        ("four", "quick", 0.9),
        ("one", "other", 0.0),
    ],
    columns=["maze", "algorithm", "rate"],
)


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def test_the_ladder_has_the_best_on_top():
    _, axes = figures.plot_ladder(RATES)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["quick", "slow", "other"]
    assert axes.yaxis_inverted()
    dots = [line for line in axes.get_lines() if line.get_marker() == "."]
    assert [sorted(line.get_xdata()) for line in dots] == [[50, 50, 60, 90], [10, 30, 30, 100], [0]]
    assert all(abs(line.get_ydata() - place).max() < 0.5 for place, line in enumerate(dots))
    for place, (container, name) in enumerate(zip(axes.containers, ("quick", "slow", "other"), strict=True)):
        point, _, (bar,) = container
        mean, low, high = mean_over_mazes(RATES.rate[RATES.algorithm == name])
        assert point.get_xydata()[0] == pytest.approx([100 * mean, place])
        assert bar.get_segments()[0][:, 0] == pytest.approx([100 * low, 100 * high])


def test_pairs_are_those_of_the_same_maze():
    _, axes = figures.plot_pairs(RATES, "slow", "quick")
    (dots,) = axes.collections
    drawn = dict(zip(map(tuple, np.round(dots.get_offsets(), 6).tolist()), dots.get_sizes(), strict=True))
    assert drawn == {(10, 60): 24, (30, 50): 48, (100, 90): 24}
    assert {text.get_text(): tuple(text.get_position()) for text in axes.texts} == {
        "better on 3": (2, 98),
        "better on 1": (98, 2),
    }
    assert axes.get_xlabel().startswith("slow")
    assert axes.get_ylabel().startswith("quick")
    _, axes = figures.plot_pairs(RATES, "other", "quick")
    assert len(axes.collections[0].get_offsets()) == 1, "only one maze has both"


def runs_of(*evaluations):
    """A run for each number of evaluations, on two mazes in turn; of 900, they ended without a success."""
    found = np.array(evaluations)
    return pd.DataFrame({"maze": np.arange(len(found)) % 2, "success": found < 900, "evaluations": found})


def test_curves_are_means_over_mazes():
    runs = {"quick": runs_of(200, 400, 900, 400), "never": runs_of(900, 900)}
    figure, axes = figures.plot_mean_curves(runs)
    quick, never = axes.get_lines()
    assert quick.get_xydata().tolist() == [[0, 0], [200, 25], [400, 75], [900, 75]]
    assert never.get_xydata().tolist() == [[0, 0], [900, 0]]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["quick", "never"]
    assert axes.get_xlim() == (0, 900)


@pytest.mark.parametrize("name", [r"a_$\frac{$", "$x$", "<script>alert(1)</script>", "_hidden"])
def test_names_are_not_read_as_mathematics_or_markup(name):
    rates = RATES.replace("slow", name)
    drawn = (
        figures.plot_ladder(rates),
        figures.plot_pairs(rates, name, "quick"),
        figures.plot_mean_curves({name: runs_of(200, 900)}),
    )
    for figure, _ in drawn:
        with plt.rc_context({"svg.fonttype": "none"}), io.StringIO() as file:
            figure.savefig(file, format="svg")
            svg = ElementTree.fromstring(file.getvalue())
        assert any(text.strip().startswith(name) for text in svg.itertext())
        assert not any(element.tag.endswith("script") for element in svg.iter())
