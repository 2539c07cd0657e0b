"""Lines in which a class sends its outcomes: written and read alike by the package and by the page."""

import dataclasses
import json
import subprocess

import numpy as np
import pytest

import safe
from safe.playground import bundle
from safe.playground.lines import Course, Line, Outcome, add_store, pool, read_lines, verify_lines, write_line
from tests.helpers.runs import runs_of_every_kind, runs_with_choices
from tests.helpers.twin import NODE, needs_node

QUICK = safe.Parameters(population=10, objectives=10, generations=3)
MONDAY = Course("monday", ["novelty", "safe"], "maze1", runs=2, seats=5, parameters=QUICK)
OUTCOMES = [[Outcome(True, 2), Outcome(False, 17)], [Outcome(False, 3), Outcome(True, 0)]]
OTHER = [[Outcome(True, 2), Outcome(False, 17)], [Outcome(False, 4), Outcome(True, 0)]]


def line(seat=1, outcomes=OUTCOMES, course=MONDAY, **changes):
    return write_line(dataclasses.replace(course, **changes), seat, outcomes)


def resealed(text, old, new):
    """A line in which somebody has changed a text and made the checksum fit again."""
    body = text.rsplit(";", 2)[0].replace(old, new) + ";"
    return f"{body}{safe.experiments.store.sha256(body)[:8]};"


BROKEN = "\n> ".join(line(2)[at : at + 30] for at in range(0, len(line(2)), 30))
TEXTS = {  # a text: the seats that count, those given again, what is said of others
    "": ([], [], {}),
    "Dear all,\n\nhere is mine.": ([], [], {}),
    f"{line(1)}\n{line(3)}": ([1, 3], [], {}),
    f"Mine: {line(3)} Regards, S.\n\n{line(1)}{line(2)}": ([1, 2, 3], [], {}),
    f"On Monday somebody wrote:\n> {BROKEN}\nSo did I: {line(5)}": ([2, 5], [], {}),
    f"{line(4)}\n{line(1)}\n{line(4)}": ([1, 4], [3], {}),
    f"{line(1)}\n{line(1, OTHER)}\n{line(2)}": (
        [2],
        [],
        {
            1: "disagrees with another line of seat 1",
            2: "disagrees with line 1 about run 0 of safe: failure 4 cells from the goal here, failure 3 cells from "
            "the goal there",
        },
    ),
    f"{line(1)[:-20]}\n{line(2)}": ([2], [], {1: "is cut off before its end"}),
    f"{line(1)[9:]}\n{line(2)}": ([2], [], {1: "is damaged at its beginning"}),
    f"{line(2)}\n{line(1).replace('+2-17', '+1-17')}": ([2], [], {2: "is damaged: its checksum does not fit"}),
    f"{line(2)}\n{line(1).replace('seed=0', 'seed=1')}": ([2], [], {2: "is damaged: its checksum does not fit"}),
    f"{line(2)}\n{line(3)}\n{line(1, name='tuesday')}": ([2, 3], [], {3: "is of the class tuesday"}),
    f"{line(1, seed=1)}\n{line(2)}\n{line(3)}": ([2, 3], [], {1: "is of a class with other settings"}),
    f"{line(1, seats=6)}\n{line(2)}\n{line(3)}": ([2, 3], [], {1: "is of a class with other settings"}),
    resealed(line(), "SAFE-class-1", "SAFE-class-0"): (
        [],
        [],
        {1: "follows the rules of another version: 0 instead of 1"},
    ),
    resealed(line(), "seats=5;1;", "seats=5;6;"): ([], [], {1: "seat must be an integer from 1 to 5; got 6"}),
    resealed(line(), "+2-17,", "+2-17+1,"): ([], [], {1: "must hold 2 outcomes of each of 2 algorithms"}),
    resealed(line(), ",-3+0", ""): ([], [], {1: "must hold 2 outcomes of each of 2 algorithms"}),
    resealed(line(), "+2-17", "+2-1x7"): ([], [], {1: "has an outcome that is none: -1x7"}),
    resealed(line(), "+2", "+3"): ([], [], {1: "the generation of a success must be an integer from 0 to 2; got 3"}),
    resealed(line(), "-17", "-2"): (
        [],
        [],
        {1: "the distance at the end of a failure must be an integer of at least 3; got 2"},
    ),
}


PAGE = """
const { readLines, poolLines, writeLine } = playground();
console.log(JSON.stringify(TEXTS.map((text) => {
  const { course, experiments, seats, repeated, refused } = poolLines(readLines(text));
  const kept = [...seats].map(([seat, { at, settings, outcomes }]) => ({
    seat,
    at,
    outcomes: outcomes.map((list) => list.map(({ success, number }) => [success, number])),
    line: writeLine({ ...course, seat }, settings, outcomes),
  }));
  const digests = experiments?.map(({ digest }) => digest);
  return { course, digests, kept, repeated: repeated.map(({ at }) => at), refused };
})));
"""


def read_by_page(texts):
    """What the JavaScript reads in texts."""
    modules = bundle.script(("class_pool.js", "class_lines.js"))
    script = f"{modules}const TEXTS = {json.dumps(list(texts))};\n{PAGE}"
    return json.loads(subprocess.run([NODE, "-"], input=script, capture_output=True, text=True, check=True).stdout)


@pytest.mark.parametrize(("text", "expected"), TEXTS.items(), ids=range(len(TEXTS)))
def test_what_counts_in_a_text(text, expected):
    pooled = pool(read_lines(text))
    seats, repeated, refused = expected
    assert list(pooled.seats) == seats
    assert [line.at for line in pooled.repeated] == repeated
    assert dict(pooled.refused) == refused


@needs_node
def test_the_page_reads_the_same():
    for text, page in zip(TEXTS, read_by_page(TEXTS), strict=True):
        pooled = pool(read_lines(text))
        assert [one["seat"] for one in page["kept"]] == list(pooled.seats)
        assert [one["at"] for one in page["kept"]] == [line.at for line in pooled.seats.values()]
        assert page["repeated"] == [line.at for line in pooled.repeated]
        assert [(one["at"], one["reason"]) for one in page["refused"]] == pooled.refused
        for one, kept in zip(page["kept"], pooled.seats.values(), strict=True):
            assert [list(map(tuple, those)) for those in one["outcomes"]] == kept.outcomes
            assert one["line"] == write_line(kept.course, kept.seat, kept.outcomes)


@needs_node
def test_a_line_of_every_kind_of_experiment_is_read_alike():
    """The settings come back, and with them the experiments, since page and package compute the same digests."""
    rng = np.random.default_rng(7)
    texts, courses = [], []
    for maze, algorithm, _, parameters in [*runs_of_every_kind()[::10], *runs_with_choices()[::4]]:
        course = Course("a ½ & b", [algorithm], maze, 1, 3, int(rng.integers(2**63)) ** 2, parameters)
        courses.append(course)
        texts.append(write_line(course, 3, [[Outcome(True, 0)]]))
    for course, text, page in zip(courses, texts, read_by_page(texts), strict=True):
        (read,) = read_lines(text)
        assert isinstance(read, Line), read
        assert read.course.key == course.key
        assert page["refused"] == []
        assert page["course"] == {"name": "a ½ & b", "seats": 3, "seat": 3}
        assert page["digests"] == [experiment.digest for experiment in course.experiments]


def test_a_line_is_short():
    outcomes = [[Outcome(False, 100)] * 10 + [Outcome(True, 499)] * 10] * 2
    assert len(write_line(Course("monday", ["novelty", "safe"], "maze1", runs=20), 30, outcomes)) <= 300


def test_a_class_makes_the_runs_of_its_experiments(tmp_path):
    lines = [write_line(MONDAY, seat, MONDAY.make(seat)) for seat in (1, 2, 4)]
    pooled = pool(read_lines("\n".join(lines)), MONDAY)
    assert pooled.missing == [3, 5]
    for experiment, table in pooled.results.items():
        runs = safe.run(experiment, tmp_path / "store", progress=False)
        assert table.run.tolist() == [0, 1, 2, 3, 6, 7]
        made = runs.loc[table.run]
        assert table.success.tolist() == made.success.tolist()
        assert table.number.tolist() == made.generation.where(made.success, made.distance).tolist()
    checked = verify_lines(pooled, sample=100)
    assert len(checked) == 12
    both = add_store(pooled.results, tmp_path / "store")
    assert [table.run.tolist() for table in both.values()] == [list(range(10))] * 2

    seat, (first, second) = 2, MONDAY.make(2)
    wrong = Outcome(True, 1) if not first[0].success else Outcome(False, 90)
    pooled = pool(read_lines(write_line(MONDAY, seat, [[wrong, first[1]], second])))
    with pytest.raises(ValueError, match=r"line 1, of seat 2, where run 2 of novelty is: "):
        verify_lines(pooled, sample=4)
    with pytest.raises(ValueError, match=r"store must agree with the lines; .* where run 2 of novelty is: "):
        add_store(pooled.results, tmp_path / "store")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"name": " "}, "class must have a name of 1 to 40 characters; got ' '"),
        ({"name": "x" * 41}, "class must have a name of 1 to 40 characters; got 'xxx"),
        ({"seats": 0}, "seats must be an integer from 1 to 1000; got 0"),
        ({"seats": 1000, "runs": 1001}, "seats times runs must be an integer from 1 to 1000000; got 1001000"),
        ({"seed": -1}, "seed must be an integer from 0 to"),
    ],
)
def test_a_class_that_is_none(changes, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        dataclasses.replace(MONDAY, **changes)
