import base64
import io
import json
import re
from xml.etree import ElementTree

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import safe
from safe.companion.paper import reported
from safe.experiments.experiment import WEIGHT_COLUMNS
from safe.maze import ways_to_goal
from safe.results import figures, tables
from safe.results.figures.style import legend_below
from safe.results.statistics import success_interval
from tests.helpers import oracle
from tests.helpers.results import runs

mpl.use("agg")
MAZE = safe.Maze.from_drawing("S..#\n.#..\n...G", name="small")


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def test_a_maze_is_drawn_with_rows_downwards():
    _, axes = plt.subplots()
    figures.draw_maze(axes, MAZE)
    (image,) = axes.get_images()
    assert (image.get_array() == MAZE.walls).all()
    start, goal = axes.get_lines()
    assert start.get_xydata().tolist() == [[0, 0]]
    assert goal.get_xydata().tolist() == [[3, 2]]
    assert axes.yaxis_inverted()


def test_a_path_goes_from_start_to_end():
    _, axes = plt.subplots()
    figures.draw_path(axes, np.array([[0, 0], [1, 0], [2, 1]]))
    path, end = axes.get_lines()
    assert path.get_xydata().tolist() == [[0, 0], [0, 1], [1, 2]]
    assert end.get_xydata().tolist() == [[1, 2]]


def test_one_drawing_for_each_maze_and_path():
    path = safe.path(MAZE, [0.0] * 16, 5)
    figure, grid = figures.plot_paths([[(MAZE, path, "one"), (MAZE, None, "two")], [(MAZE, path, "three")]])
    assert grid.shape == (2, 2)
    assert [axes.get_title() for axes in grid.flat] == ["one", "two", "three", ""]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["start", "goal", "path", "end of the path"]
    figure, grid = figures.plot_mazes([MAZE, MAZE, MAZE])
    assert grid.shape == (1, 3)
    assert grid[0, 2].get_title() == "small"


def test_sensors_are_shown_with_their_readings():
    _, axes = figures.plot_sensors(MAZE, (2, 1))
    texts = {text.get_text() for text in axes.texts}
    assert {"dist_right = 2\ngoal_right = 4", "dist_left = 1", "dist_down = 0", "dist_up = 1\ngoal_up = 3"} <= texts


def story(algorithm):
    return list(safe.Experiment(algorithm, "maze2", parameters=safe.Parameters(generations=5)).replay(0))


@pytest.mark.parametrize(("algorithm", "panels"), [("safe", 2), ("novelty", 2), ("standard", 1), ("random", 1)])
def test_progress(algorithm, panels):
    of_run = story(algorithm)
    _, grid = figures.plot_progress(of_run)
    assert len(grid) == panels
    of_generation, so_far = (line.get_ydata() for line in grid[0].get_lines())
    assert so_far.tolist() == np.minimum.accumulate(of_generation).tolist()
    assert so_far[-1] == of_run[-1].distance


@pytest.mark.parametrize(("algorithm", "panels"), [("safe", 2), ("novelty", 1), ("standard", 1), ("random", 1)])
def test_a_generation_is_shown_with_its_objective_functions(algorithm, panels):
    *_, last = story(algorithm)
    _, grid = figures.plot_generation(safe.load_maze("maze2"), last)
    assert len(grid) == panels
    lines = {line.get_label(): line.get_xydata() for axes in grid for line in axes.get_lines()}
    assert lines["end points"].tolist() == last.endpoints[:, ::-1].tolist()
    assert len(lines["archive"]) == len(last.archive[0])
    if panels == 2:
        assert len(lines["won nowhere"]) + len(lines["gave some solution its fitness"]) == 200
        assert {tuple(point) for point in lines["gave some solution its fitness"]} == {
            tuple(last.objectives[winner]) for winner in last.winners
        }


def test_an_animation_loads_nothing():
    maze = safe.Maze.from_drawing("S#\n.G", name='<b>"mine"')
    of_run = list(
        safe.generations(maze, "random", 0, safe.Parameters(population=4, objectives=4, generations=9, steps=1))
    )
    page = figures.animate(maze, of_run, frames=4)
    assert "://" not in page
    assert "<b>" not in page
    frames = json.loads(re.search(r"const frames = (\[.*?\])", page).group(1))
    assert json.loads(re.search(r"labels = (\[.*?\])", page).group(1)) == [0, 3, 5, 8]
    sizes = {base64.b64decode(frame)[16:24] for frame in frames}  # width and height in the header of a PNG
    assert len(frames) == 4
    assert len(sizes) == 1
    assert figures.animate(maze, of_run[:1]).count("iVBOR") == 1
    drawn = []
    figures.animate(maze, of_run, 4, lambda index: drawn.append(index) or figures.plot_mazes([maze]))
    assert drawn == [0, 3, 5, 8]
    assert plt.get_fignums() == []


@pytest.mark.parametrize(
    "name", [r"a_$\frac{$", "$x$", r"\$x\$", "<script>alert(1)</script>", "--><script>", "_hidden"]
)
def test_names_are_not_read_as_mathematics_or_markup(name):
    maze = safe.Maze(MAZE.walls, MAZE.start, MAZE.goal, name)
    algorithm = safe.Algorithm(name, objectives=[(0.5, 0.5)])
    results = {safe.Experiment(algorithm, maze): runs(1, 2, [3], a=[0.5, 0.5], b=[0.5, 0.5])}
    evolved_weights = tables.evolved_table(results, ["a", "b"])
    story_of_it = list(safe.generations(maze, algorithm, 0, safe.Parameters(generations=1, population=4)))
    levels = pd.DataFrame({"panel": [name], "level": [name], "colour": [name], "successes": [1], "runs": [2]})
    rates = levels.assign(rate=0.5, low=0.1, high=0.9)
    windows = pd.DataFrame({"run": [0, 0], "window": [0, 1], "novelty": [1.0, 2.0]})
    drawn = [
        figures.plot_mazes([maze]),
        figures.plot_sensors(maze, maze.start),
        figures.plot_success(tables.success_table(results)),
        figures.plot_success_curves(results),
        figures.plot_coefficients(results),
        figures.plot_weights(evolved_weights),
        figures.plot_judging({name: story_of_it[0]}),
        figures.plot_rates(rates, "panel", "level", "colour"),
        figures.plot_levels(rates, "panel", "level", "colour"),
        figures.plot_main_effects(levels, ["level"], "colour"),
        figures.plot_interactions(levels, [("level", "colour")]),
        figures.plot_windows({name: windows}, {"novelty": ["novelty"]}),
    ]
    for figure, _ in drawn:
        with plt.rc_context({"svg.fonttype": "none"}), io.StringIO() as file:
            figure.savefig(file, format="svg")
            svg = ElementTree.fromstring(file.getvalue())
        texts = [text.strip() for text in svg.itertext()]
        assert any(text.startswith(name) for text in texts), texts
        assert not any(element.tag.endswith("script") for element in svg.iter())
    for figure, _ in (drawn[3], *drawn[7:10], drawn[11]):
        assert len(legend(figure)) == 1
    assert "<script>alert" not in figures.animate(maze, story_of_it)


def test_the_landscape_shows_distances_and_ways_of_open_cells():
    _, grid = figures.plot_landscape(MAZE)
    apart, ways = (axes.get_images()[1].get_array() for axes in grid)
    for shown in (apart, ways):
        assert (shown.mask == MAZE.walls).all()
    for cell in map(tuple, np.argwhere(~MAZE.walls)):
        assert apart[cell] == oracle.taxicab(cell, MAZE.goal)
        assert ways[cell] == ways_to_goal(MAZE)[cell]


def test_the_crowd_has_a_line_from_each_point_to_its_neighbours():
    points = np.array([[0, 0], [0, 1], [2, 2]])
    _, axes = figures.plot_crowd(MAZE, points, [((0, 0), points[1:], "one $1")])
    lines = [line.get_xydata().tolist() for line in axes.get_lines() if len(line.get_xdata()) == 2]
    assert lines == [[[0, 0], [1, 0]], [[0, 0], [2, 2]]]
    assert r"one \$1" in [line.get_label() for line in axes.get_lines()]


def test_components_and_objective_functions_of_a_run():
    story = list(safe.generations(MAZE, "safe", 1, safe.Parameters(generations=3, population=6, objectives=8)))
    _, axes = figures.plot_components(story)
    largest, mean, *_ = (line.get_ydata() for line in axes.get_lines())
    assert largest.tolist() == [generation.components[0].max() for generation in story]
    assert mean == pytest.approx([generation.components[0].mean() for generation in story])
    _, grid = figures.plot_objectives(story)
    for panel, generation in zip(grid, story, strict=True):
        others, deciding = (line.get_xydata() for line in panel.get_lines())
        assert {*map(tuple, deciding)} == {tuple(generation.objectives[winner]) for winner in generation.winners}
        assert len(others) + len(deciding) == 8
        assert panel.get_title() == f"generation {generation.generation}"


def test_rates_of_success_with_the_papers():
    table = tables.success_table(
        {safe.Experiment("safe", "maze1"): runs(3, 4), safe.Experiment("random", "maze1"): runs(0, 4)}, reported
    )
    _, (axes,) = figures.plot_success(table)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["random", "safe"]
    ours, *_, paper = (line for line in axes.get_lines() if len(line.get_xdata()) == 2 and line.get_marker() in "ox")
    assert ours.get_xdata().tolist() == [0, 75]
    assert paper.get_xdata().tolist() == pytest.approx([100 * 9 / 500, 100 * 328 / 500])


def test_success_curves_rise_from_nothing_to_the_share_of_successes():
    results = {safe.Experiment(name, "maze1"): runs(n, 4, range(5, 5 + n)) for name, n in (("safe", 2), ("fixed", 0))}
    _, (axes,) = figures.plot_success_curves(results)
    safe_alone, fixed = axes.get_lines()
    assert safe_alone.get_xydata() == pytest.approx(np.array([[0, 0], [5, 25], [6, 50], [500, 50]]))
    assert fixed.get_xydata().tolist() == [[0, 0], [500, 0]]


def evolved(maze):
    columns = {"a": [0.5, 1.0], "b": [1.0, 0.9]} | {f"p{i}": [i / 20, i / 16] for i in range(1, 17)}
    return {safe.Experiment("safe", maze): runs(2, 2, **columns)}


def test_coefficients_and_weights_beside_the_papers():
    results = evolved("maze2")
    _, (axes,) = figures.plot_coefficients(results, reported)
    points, paper, *_ = axes.get_lines()
    assert points.get_xydata().tolist() == [[0.5, 1.0], [1.0, 0.9]]
    assert paper.get_xydata().tolist() == [[0.83, 0.98]]

    _, (axes,) = figures.plot_weights(tables.evolved_table(results, WEIGHT_COLUMNS, reported))
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert (labels[0], labels[-1]) == ("p16: goal_up in v", "p1: dist_right in h")
    ours, paper = (line for line in axes.get_lines() if line.get_marker() in ("o", "x") and len(line.get_xdata()) == 16)
    assert ours.get_xdata()[-1] == pytest.approx((1 / 20 + 1 / 16) / 2)
    assert paper.get_xdata()[-1] == -0.27


def test_neighbours_are_joined_along_rows_and_columns():
    _, axes = figures.plot_neighbours([[0, 0], [2, 1], [5, 5]], [[1], [0], [1]])
    *joins, points = axes.get_lines()
    assert joins[0].get_xydata().tolist() == [[0, 0], [1, 0], [1, 2]]
    assert points.get_xydata().tolist() == [[0, 0], [1, 2], [5, 5]]
    assert [text.get_text() for text in axes.texts] == ["A", "B", "C"]
    assert axes.yaxis_inverted()


def test_who_judges_whom():
    small = safe.Parameters(population=4, objectives=2, elites=0, generations=1, k=2)
    judged = {name: next(safe.generations("maze1", name, 1, small)) for name in ("standard", "safe")}
    _, (standard, coevolving) = figures.plot_judging(judged)
    for axes, generation in ((standard, judged["standard"]), (coevolving, judged["safe"])):
        texts = [text.get_text() for text in axes.texts]
        for fitness in generation.fitness:
            assert texts.count(f"{fitness:.3g}") >= 2, "the best score, and the fitness"
    assert "The objective\nfunction stays\nas it is." in [text.get_text() for text in standard.texts]
    novelties = {f"{novelty:.3f}" for novelty in judged["safe"].objective_fitness}
    assert novelties <= {text.get_text() for text in coevolving.texts}


def rates_of(rows):
    """Rates of success, in percent, by panel, place and colour; intervals reach from 10 points below to 20 above."""
    table = pd.DataFrame(rows, columns=["panel", "place", "colour", "percent"])
    return table.assign(rate=table.percent / 100, low=table.percent / 100 - 0.1, high=table.percent / 100 + 0.2)


RATES = rates_of(
    [
        ("one", "here", "red", 10),
        ("one", "here", "blue", 20),
        ("one", "there", "blue", 30),
        ("two", "there", "red", 40),
        ("two", "here", "red", 50),
        ("three", "far", "blue", 60),
    ]
)


def intervals(axes, along):
    """The points of a panel by label, and the ends of their intervals along an axis: 0, horizontal, or 1."""
    drawn = {}
    for container in axes.containers:
        points, _, (bars,) = container
        drawn[container.get_label()] = points.get_xydata().tolist()
        for point, ends in zip(points.get_xydata(), bars.get_segments(), strict=True):
            assert ends[:, 1 - along].tolist() == [point[1 - along]] * 2
            assert ends[:, along] == pytest.approx([point[along] - 10, point[along] + 20])
    return {label: points for label, points in drawn.items() if points}


def has_numbers(axes):
    """Are there labels at the ticks of the horizontal axis?"""
    return any(label.get_visible() and label.get_text() for label in axes.get_xticklabels())


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def assert_all_panels_are_labelled(grid, label):
    """Three panels in two columns, each of which may be shown alone."""
    grid[0, 0].figure.canvas.draw()
    assert [axes.get_xlabel() for axes in grid.flat] == [label, label, label, ""]
    assert [has_numbers(axes) for axes in grid.flat[:3]] == [True, True, True]
    assert [axes.axison for axes in grid.flat] == [True, True, True, False]


def test_rates_stand_beside_each_other():
    figure, grid = figures.plot_rates(RATES, "panel", "place", "colour")
    assert grid.shape == (2, 2)
    assert [axes.get_title() for axes in grid.flat] == ["one", "two", "three", ""]
    above, below = -0.15, 0.15  # of the line of a place: one colour, and the other
    drawn = [intervals(axes, 0) for axes in grid.flat]
    assert drawn[0]["red"] == [[10, above]]
    assert drawn[0]["blue"] == pytest.approx(np.array([[20, below], [30, 1 + below]]))
    assert drawn[1]["red"] == pytest.approx(np.array([[40, 1 + above], [50, above]]))
    assert drawn[2]["blue"] == pytest.approx(np.array([[60, 2 + below]]))
    assert [[*of_panel] for of_panel in drawn] == [["red", "blue"], ["red"], ["blue"], []]
    for axes in grid[:, 0]:
        assert axes.get_yticks().tolist() == [0, 1, 2]
        assert [label.get_text() for label in axes.get_yticklabels()] == ["here", "there", "far"]
        assert axes.yaxis_inverted()
    assert legend(figure) == ["red", "blue"]
    assert_all_panels_are_labelled(grid, "runs that succeed, %")


def test_rates_along_numbers_are_in_their_order():
    places = {"here": 1000, "there": 100, "far": 10_000}
    rates = RATES.assign(place=RATES.place.map(places))
    figure, grid = figures.plot_levels(rates, "panel", "place", "colour", xlabel="places")
    assert [axes.get_title() for axes in grid.flat] == ["one", "two", "three", ""]
    drawn = [intervals(axes, 1) for axes in grid.flat]
    assert drawn == [
        {"red": [[1, 10]], "blue": [[0, 30], [1, 20]]},
        {"red": [[0, 40], [1, 50]]},
        {"blue": [[2, 60]]},
        {},
    ]
    for axes in (grid[0, 1], grid[1, 0]):
        assert axes.get_xticks().tolist() == [0, 1, 2]
        assert [label.get_text() for label in axes.get_xticklabels()] == ["100", "1,000", "10,000"]
    assert [axes.get_ylabel() for axes in grid.flat] == ["runs that succeed, %", "", "runs that succeed, %", ""]
    assert legend(figure) == ["red", "blue"]
    assert_all_panels_are_labelled(grid, "places")


def test_rates_along_words_are_in_the_order_of_the_table():
    _, grid = figures.plot_levels(RATES, "panel", "place", "colour", columns=3)
    assert grid.shape == (1, 3)
    assert intervals(grid[0, 1], 1) == {"red": [[0, 50], [1, 40]]}
    assert [label.get_text() for label in grid[0, 2].get_xticklabels()] == ["here", "there", "far"]
    assert [axes.get_xlabel() for axes in grid[0]] == ["place"] * 3


def test_a_factor_of_one_colour_has_one_line_of_points_for_each_place():
    _, ((axes,),) = figures.plot_rates(RATES[RATES.panel == "two"].replace("two", "$1$"), "panel", "place", "colour", 1)
    assert intervals(axes, 0) == {"red": [[40, 0], [50, 1]]}


def traces(*values):
    """Measures of runs, each from generation 0, 10 and 100 on, if it lasts as long."""
    return pd.concat(
        [
            pd.DataFrame(
                {"run": run, "window": [0, 10, 100][: len(of_run)], "high": of_run, "low": 0.0, "none": np.nan}
            )
            for run, of_run in enumerate(values)
        ]
    )


def test_windows_show_medians_and_the_middle_half():
    of_runs = {"mine": traces([1, 1, 9], [2, 4], [3, 9], [4, 10], [9, 11]), "yours": traces([5, 5])}
    panels = {"both": ["high", "low"], "one": ["low"], "nothing": ["none"]}
    figure, grid = figures.plot_windows(of_runs, panels)
    high, low, other, other_low = grid[0, 0].get_lines()
    assert high.get_xydata().tolist() == [[1, 3], [11, 9], [101, 9]], "generation 0 stands at 1 on a logarithmic axis"
    assert low.get_xydata().tolist() == [[1, 0], [11, 0], [101, 0]]
    assert other.get_xydata().tolist() == [[1, 5], [11, 5]]
    assert [line.get_linestyle() for line in (high, low, other, other_low)] == ["-", "--", "-", "--"]
    assert high.get_color() == low.get_color() != other.get_color() == other_low.get_color()
    middle_half, *_ = grid[0, 0].collections
    outline = {tuple(corner) for corner in middle_half.get_paths()[0].vertices.tolist()}
    assert outline == {(1, 2), (1, 4), (11, 4), (11, 10), (101, 9)}
    assert [len(axes.get_lines()) for axes in grid.flat] == [4, 2, 2, 0]
    assert [axes.get_ylabel() for axes in grid.flat] == [*panels, ""]
    assert legend(figure) == ["mine", "yours"]
    for axes in (grid[0, 1], grid[1, 0]):
        assert axes.get_xscale() == "log"
        assert axes.get_xticks().tolist() == [1, 2, 4, 11, 31, 101]
        assert [label.get_text() for label in axes.get_xticklabels()] == ["0", "1", "3", "10", "30", "100"]
    assert_all_panels_are_labelled(grid, "generation")


def rates_of_factors():
    rows = [("EA", 15, "none", 2), ("SAFE", 50, "none", 6), ("SAFE", 1, "full", 0), ("SAFE", 50, "full", 10)]
    return pd.DataFrame(rows, columns=["algorithm", "k", "archive", "successes"]).assign(runs=10)


def test_main_effects_take_the_cells_of_a_level_together():
    figure, (of_k, of_archive) = figures.plot_main_effects(rates_of_factors(), ["k", "archive"], "algorithm")
    drawn = [
        {container.get_label(): container[0].get_xydata().tolist() for container in axes.containers}
        for axes in (of_k, of_archive)
    ]
    assert drawn == [{"EA": [[1, 20]], "SAFE": [[0, 0], [2, 80]]}, {"EA": [[0, 20]], "SAFE": [[0, 60], [1, 50]]}]
    *_, (bars,) = of_archive.containers[1]
    ends = [segment[:, 1] for segment in bars.get_segments()]
    expected = [100 * np.array(success_interval(count, n)) for count, n in ((6, 10), (10, 20))]
    assert np.array(ends) == pytest.approx(np.array(expected))
    assert [label.get_text() for label in of_k.get_xticklabels()] == ["1", "15", "50"]
    assert [axes.get_title() for axes in (of_k, of_archive)] == ["k", "archive"]
    assert legend(figure) == ["EA", "SAFE"]


def test_interactions_are_rates_of_pairs_of_levels():
    _, (axes,) = figures.plot_interactions(rates_of_factors(), [("k", "archive")])
    (image,) = axes.get_images()
    expected = [[np.nan, 20, 60], [0, np.nan, 100]]  # down: none, full; across: 1, 15, 50
    assert np.ma.filled(image.get_array(), np.nan) == pytest.approx(np.array(expected), nan_ok=True)
    texts = {text.get_position(): text.get_text() for text in axes.texts if text.get_text()}
    assert texts == {(1, 0): "20 %", (2, 0): "60 %", (0, 1): "0 %", (2, 1): "100 %"}
    assert [label.get_text() for label in axes.get_xticklabels()] == ["1", "15", "50"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["none", "full"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("k", "archive")


def test_matplotlib_knows_the_style():
    with plt.rc_context():
        figures.use_style()
        assert plt.rcParams["axes.prop_cycle"].by_key()["color"][0] == "#0072B2"


def test_each_experiment_is_drawn_if_names_coincide():
    """Regression: curves were kept by names, and those of a second seed replaced those of the first."""
    seeds = {safe.Experiment("safe", "maze1", seed=seed): runs(n, 4, range(n)) for seed, n in ((0, 1), (1, 3))}
    _, (axes,) = figures.plot_success_curves(seeds)
    assert [line.get_label() for line in axes.get_lines()] == ["safe (seed 0)", "safe (seed 1)"]
    assert [line.get_ydata()[-1] for line in axes.get_lines()] == pytest.approx([25, 75])

    mazes = [safe.Maze.from_drawing(drawing, "mine") for drawing in ("S.G", "G.S")]
    results = {
        safe.Experiment("safe", maze): runs(1, 1, a=[a], b=[1.0]) for maze, a in zip(mazes, (0.25, 0.5), strict=True)
    }
    _, panels = figures.plot_coefficients(results)
    assert [axes.get_lines()[0].get_xdata().tolist() for axes in panels] == [[0.25], [0.5]]
    _, success_panels = figures.plot_success(tables.success_table(results))
    _, (maze_panels,) = figures.plot_mazes(mazes)
    for drawn in (panels, success_panels, maze_panels):
        titles = [axes.get_title() for axes in drawn]
        assert len(set(titles)) == 2
        assert all(title.startswith("mine (digest ") for title in titles)


def boxes_of(figure):
    """Left, top, right and bottom of every box of the panels of a figure, in fractions of its image."""
    return [
        [(left, top, left + width, top + height) for left, top, width, height in boxes]
        for boxes in figures.layout(figure, figures.image_box(figure))["panels"]
    ]


def test_panels_side_by_side_share_no_part_of_the_image():
    figure, grid = plt.subplots(1, 2, figsize=(8, 3), layout="constrained")
    for axes in grid:
        axes.set(title="a title", xlabel="steps")
    (first,), (second,) = boxes_of(figure)
    assert 0 <= first[0] < first[2] <= second[0] < second[2] <= 1
    assert all(0 <= top < bottom <= 1 for _, top, _, bottom in (first, second))


def test_a_panel_without_numbers_of_its_own_is_shown_with_those_of_the_first():
    figure, _ = plt.subplots(1, 2, sharey=True)
    (first,), (numbers, second) = boxes_of(figure)
    assert numbers[0] == pytest.approx(first[0], abs=0.01)
    assert numbers[2] < first[2] < second[0]
    assert numbers[1::2] == pytest.approx(second[1::2])


def test_a_colour_bar_belongs_to_its_panel():
    figure, (axes, other) = plt.subplots(1, 2)
    bar = figure.colorbar(axes.imshow([[0, 1]]), ax=axes, orientation="horizontal")
    other.plot([1, 2])
    (first,), _ = boxes_of(figure)
    image = figures.image_box(figure)
    left, top, width, height = figures.fractions(figure, image, bar.ax.get_window_extent())
    assert first[0] <= left < left + width <= first[2]
    assert first[1] <= top < top + height <= first[3]


def test_panels_that_overlap_are_one_and_empty_places_are_none():
    figure, grid = plt.subplots(1, 3, figsize=(12, 3), layout="constrained")
    grid[0].twinx()
    grid[2].set_axis_off()
    assert len(boxes_of(figure)) == 2


def test_every_entry_of_the_legend_has_a_box_with_its_handle():
    figure, axes = plt.subplots()
    for name in ("one", "another"):
        axes.plot([1, 2], label=name)
    legend_below(figure)
    image = figures.image_box(figure)
    layout = figures.layout(figure, image)
    (_, _, width, _), (_, _, wider, _) = layout["entries"]
    assert 0 < width < wider
    for text, (left, top, width, height) in zip(figure.legends[0].get_texts(), layout["entries"], strict=True):
        box = figures.fractions(figure, image, text.get_window_extent())
        assert left < box[0]
        assert left + width >= box[0] + box[2]
        assert top <= box[1] <= box[1] + box[3] <= top + height


def test_a_legend_is_no_wider_than_its_figure():
    figure, axes = plt.subplots(figsize=(4, 3))
    for number in range(6):
        axes.plot([1, 2], label=f"the algorithm of number {number}")
    legend_below(figure)
    assert figure.legends[0].get_window_extent().width <= figure.bbox.width
