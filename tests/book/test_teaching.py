"""The page for teachers: its links open what they say, and its experiments show what it says of them."""

import html
import re
from functools import cache
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

import safe
from safe.results.statistics import compare_rates, success_interval
from tests.helpers.addresses import algorithm_of, maze_of, values_of
from tests.helpers.browser import needs_browser
from tests.helpers.playground_page import VIEWS, wait_for_view

BOOK = Path(__file__).parents[2] / "book"
LINK = re.compile(r'<a href="playground\.html#([^"]+)">(.*?)</a>', re.DOTALL)
LINKS = [(text, address) for address, text in LINK.findall((BOOK / "teaching.md").read_text(encoding="utf-8"))]
STATE = {"view", "maze", "algorithm", "seed", "generation", "runs", "controller"}  # what else is there are parameters


def pairs_of(address):
    return [tuple(part.split("=", 1)) for part in address.split("&")]


def address_behind(text):
    (address,) = {address for shown, address in LINKS if shown == text}
    return address


def settings(text):
    """The maze, the algorithms, the first seed and the parameters that a link shows."""
    address = address_behind(text)
    values = values_of(address)
    algorithms = [algorithm_of(value) for key, value in pairs_of(address) if key == "algorithm"]
    parameters = {key: int(value) for key, value in values.items() if key not in STATE}
    return maze_of(values["maze"]), algorithms, int(values["seed"]), safe.Parameters(**parameters)


@cache
def runs(text, at_most=100):
    """For each algorithm of a link to many runs, which of them succeed; of a link to one run, that run."""
    maze, algorithms, seed, parameters = settings(text)
    number = min(at_most, int(values_of(address_behind(text)).get("runs", 1)))
    return [[safe.evolve(maze, one, seed + n, parameters).success for n in range(number)] for one in algorithms]


def generations(text, after=0):
    """For each algorithm of a link, the generations up to the one that it opens, and some after it."""
    maze, algorithms, seed, parameters = settings(text)
    number = int(values_of(address_behind(text))["generation"]) + after + 1
    return [list(islice(safe.generations(maze, one, seed, parameters), number)) for one in algorithms]


def walked(text):
    values = values_of(address_behind(text))
    maze = maze_of(values["maze"])
    return maze, safe.path(maze, [float(weight) for weight in values["controller"].split(",")])


def ends_at(text):
    return tuple(walked(text)[1][-1].tolist())


def share_of_closeness(generation, robot):
    components = generation.components if generation.scaled is None else generation.scaled
    parts = generation.objectives[generation.winners[robot]] * components[:, robot]
    return parts[0] / parts.sum()


@needs_browser
def test_every_link_opens_what_it_says(visit):
    page = visit()
    for text, address in LINKS:
        page.evaluate("address => { location.hash = address; }", address)
        view = values_of(address)["view"]
        assert text.split(":")[0] == VIEWS[view], text
        wait_for_view(page, view)
        page.wait_for_function(
            "parts => parts.every((part) => decodeURIComponent(location.hash).slice(1).split('&').includes(part))",
            arg=address.split("&"),
        )
        assert page.get_by_role("alert").count() == 0, text


def test_every_plan_and_every_misconception_has_links(html):
    page = (html / "book" / "teaching.html").read_text(encoding="utf-8")
    tables = dict(re.findall(r'<table class="plan[^>]* id="(.*?)">(.*?)</table>', page, re.DOTALL))
    assert len(links_in(tables["tab-lesson"])) >= 6
    assert len(links_in(tables["tab-ninety"])) >= 12
    rows = re.findall(r"<tr.*?</tr>", tables["tab-misconceptions"], re.DOTALL)[1:]
    assert all(links_in(row) for row in rows)
    assert len(rows) >= 10


def links_in(text):
    return re.findall(r'href="(?:playground|slides)\.html[#?]', html.unescape(text))


def test_plans_take_as_long_as_they_say():
    page = (BOOK / "teaching.md").read_text(encoding="utf-8")
    for name, length in ("tab-lesson", 50), ("tab-ninety", 90):
        plan = page.split(f":name: {name}", 1)[1].split("```", 1)[0]
        spans = [tuple(map(int, span)) for span in re.findall(r"^\* - (\d+)\u2013(\d+)$", plan, re.MULTILINE)]
        assert [start for start, _ in spans] == [0, *(end for _, end in spans[:-1])], name
        assert spans[-1][1] == length


def test_slides_take_as_long_as_the_plan_says():
    slides = (BOOK / "slides.md").read_text(encoding="utf-8")
    spans = [tuple(map(int, span)) for span in re.findall(r"\{dropdown\} Notes: minutes (\d+) to (\d+)", slides)]
    assert [start for start, _ in spans[1:]] == [end for _, end in spans[:-1]]
    assert spans[-1][1] == 90


# What one sees


def test_closeness_does_not_come_nearer_with_time():
    maze, (algorithm,), seed, parameters = settings("Watch: closeness on maze1")
    run = safe.evolve(maze, algorithm, seed, parameters)
    first = next(safe.generations(maze, algorithm, seed, parameters))
    assert not run.success
    assert run.distance == first.distances.min()


def test_novelty_search_is_not_random_search():
    novelty, random = runs("Many runs: novelty and chance")
    assert sum(novelty) >= 5
    assert sum(random) == 0


def test_the_most_novel_robot_is_far_from_the_goal():
    maze, *_ = settings("Watch: novelty search")
    generation = generations("Watch: novelty search")[0][-1]
    assert generation.novelty.argmax() == 160
    assert generation.distances[160] > maze.distance(maze.start)


def test_other_weights_can_take_the_same_path():
    paths = [walked(text)[1] for text in ("Drive: all weights 0", "Drive: all weights 1")]
    assert np.array_equal(*paths)


def test_a_small_change_of_a_weight_can_change_the_path():
    maze, path = walked("Drive: all weights 0")
    slightly = ends_at("Drive: *p*₁₆ = −0.05")
    assert abs(np.subtract(slightly, path[-1])).sum() > 5
    controller = np.zeros(16)
    controller[11] = -1
    assert np.array_equal(safe.path(maze, controller)[-1], path[-1])


def test_a_robot_walks_over_the_goal_and_fails():
    maze, path = walked("Drive: across the goal")
    distances = [maze.distance(cell) for cell in path]
    assert min(distances) == 0
    assert distances[-1] > 20


def test_novelty_search_loses_the_robot_that_came_closest():
    story = generations("Watch: novelty search on maze2", after=4)[0]
    nearest = [generation.distances.min() for generation in story]
    assert nearest[-1] > 2 * nearest[-5]


def test_few_objective_functions_judge_and_they_need_not_evolve():
    text = "Watch: SAFE, and SAFE that cannot learn"
    assert all(len(set(story[-1].winners.tolist())) <= 5 for story in generations(text))
    assert runs(text) == [[True], [True]]


def test_the_units_decide_what_a_coefficient_means():
    shares = []
    for text in "Watch: components as they are", "Watch: components as ranks":
        generation = generations(text)[0][-1]
        assert generation.objectives[generation.winners[5]].min() > 0.8
        shares.append(share_of_closeness(generation, 5))
    assert shares[0] < 0.05
    assert shares[1] > 0.5


def test_more_places_in_the_archive_can_be_worse():
    texts = "Many runs: with 1000 places", "Many runs: without an archive"
    (with_archive,), (without,) = (runs(text, at_most=10) for text in texts)
    assert sum(with_archive) <= 1
    assert sum(without) >= 4


def test_one_run_and_a_hundred_can_disagree():
    assert runs("Watch: one run of each") == [[True], [False]]
    closeness, novelty = (sum(of) for of in runs("Many runs: the same search"))
    assert novelty > 2 * closeness


def test_intervals_can_overlap_where_a_difference_is_detected():
    text = "Many runs: 20 of each"
    closeness, novelty = (sum(of) for of in runs(text))
    assert success_interval(closeness, 20)[1] > success_interval(novelty, 20)[0]
    assert compare_rates(novelty, 20, closeness, 20).p_value < 0.05
    later = [sum(of) for of in runs("Many runs: the same search")]
    assert pairs_of(address_behind(text))[:-1] == pairs_of(address_behind("Many runs: the same search"))[:-1]
    assert success_interval(later[0], 100)[1] < success_interval(later[1], 100)[0]


def test_mutualism_can_be_worst():
    assert runs("Watch: three kinds of coevolution") == [[False], [True], [True]]


def test_the_mean_of_good_solutions_can_be_bad():
    maze, path = walked("Drive: the paper's mean controller")
    assert maze.distance(path[-1]) > 2


# Quizzes


QUESTION = re.compile(
    r"```\{exercise\} Question (\d+)\n:label: quiz-(first|last)-(\d+)\n:nonumber:\n(.*?)^```$", re.S | re.M
)
KEY = re.compile(r"^(`{3,4})\{solution\} quiz-(first|last)-(\d+)\n:class: dropdown\n\n(.*?)^\1$", re.S | re.M)


@pytest.mark.parametrize("quiz", ["first", "last"])
def test_a_quiz_has_ten_questions_with_one_right_answer_each(quiz):
    page = (BOOK / "quizzes.md").read_text(encoding="utf-8")
    questions = {
        int(label): text
        for number, name, label, text in QUESTION.findall(page)
        if name == quiz == name and number == label
    }
    keys = {int(number): text for _, name, number, text in KEY.findall(page) if name == quiz}
    assert list(questions) == list(keys) == list(range(1, 11))
    right = []
    for number, text in questions.items():
        answers = re.findall(r"^- \*\*([A-Z])\*\* (.+)$", text, re.MULTILINE)
        assert [letter for letter, _ in answers] == list("ABCD"), number
        assert len({answer for _, answer in answers}) == 4
        assert len(re.findall(r"\*\*[A-Z]\b", keys[number])) == 1
        right.append(re.match(r"\*\*([A-D])\.\*\* ", keys[number]).group(1))
    assert all(1 <= right.count(letter) <= 4 for letter in "ABCD"), right
