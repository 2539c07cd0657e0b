"""Malformed mazes, controllers, parameters, messages and stores, made up by the thousand.

    python -m tests.helpers.fuzz 100000        so many cases, and how many of them were accepted and refused

Whatever is passed in is either accepted, and then what comes of it is what it should be, or refused with a ValueError
of one line that names what was wrong. Any other exception or warning is a failure, and so is a case that takes long.
With NUMBA_BOUNDSCHECK=1 in the environment so is an index outside an array.

A target is a strategy that makes up cases, and a function that tries one out.
"""

from __future__ import annotations

import json
import math
import re
import sqlite3
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import closing, suppress
from dataclasses import fields, replace
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import NamedTuple

import hypothesis.extra.numpy as hnp
import numpy as np
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from hypothesis.errors import HypothesisWarning

import safe
from safe import Maze
from safe.algorithms import WEIGHABLE
from safe.companion import notebook
from safe.evolution import Generation, Run
from safe.judges import KINDS, RATINGS, SCALINGS
from safe.maze_files import MAZE_FOLDER, load_mazes, parse_maze
from safe.novelty import ADMISSIONS, METRICS
from safe.operators import JUDGINGS
from safe.repertoire import POOLS
from tests.helpers import maze_texts

LONGEST_MESSAGE = 300
SLOW = 10  # seconds; hundreds of times what a case takes, so that a busy machine fails nothing

TRIED: Counter[tuple[str, str]] = Counter()  # by target and by what came of it: accepted, refused


class Target(NamedTuple):
    cases: st.SearchStrategy
    try_out: Callable[..., None]
    blamed: str  # what a message may begin with, as a regular expression
    share: int  # cases of this target in every hundred of all
    refusal: type[ValueError] = ValueError


def attempt(name: str, case: object) -> None:
    """Try one case of a target out."""
    target = TARGETS[name]
    try:
        target.try_out(case)
    except ValueError as error:
        message = str(error)
        says_what = re.fullmatch(rf"({target.blamed}) must .+; got .*", message)
        if type(error) is not target.refusal or len(message) > LONGEST_MESSAGE or not says_what:
            raise
        TRIED[name, "refused"] += 1
    else:
        TRIED[name, "accepted"] += 1


def fuzz(name: str, cases: int) -> None:
    """Make up cases of a target, and try them out."""

    @settings(
        max_examples=cases,
        deadline=1000 * SLOW,
        phases=[Phase.reuse, Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )
    @given(TARGETS[name].cases)
    def is_accepted_or_refused(case: object) -> None:
        attempt(name, case)

    warm_up()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HypothesisWarning)  # that a case is long to print, in place of what failed
        is_accepted_or_refused()


@cache
def warm_up() -> None:
    """Compile, which takes longer than a case may."""
    for algorithm in safe.ALGORITHMS:
        safe.evolve(MAZE, algorithm, 0, TINY)
    safe.path(MAZE, [0.0] * 16, 1)
    safe.NoveltyArchive(metric="euclidean").score([[0.0]])


# What any argument may be given

ODD_NUMBERS = st.sampled_from(
    [
        *(None, True, -1, 2**31, 2**63, 2**64, 1_000_000, 1_000_001),
        *(0.5, -0.0, math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, 1j, Fraction(1, 3), Decimal("0.5")),
        *(np.int8(3), np.uint64(2**64 - 1), np.float16(0.5), np.finfo(np.longdouble).max, np.complex128(1j)),
        *(
            np.True_,
            np.timedelta64(3, "s"),
            np.timedelta64("NaT", "s"),
            np.datetime64("NaT", "s"),
            np.array(3),
            np.array([3]),
        ),
    ]
) | st.just(5000).map(lambda digits: 10**digits)  # of more digits than Python writes, in a repr as well
ODD_TEXTS = st.sampled_from(
    ["", " ", "\0", "a\nb", "\udcff", "x" * 10_000, "$x$", r"$\frac{", "<script>alert(1)</script>", "1", "nan", "é"]
)
# Never a text of any characters where files are made or read by that name.
ANYTHING = st.recursive(
    ODD_NUMBERS
    | ODD_TEXTS
    | st.integers()
    | st.floats()
    | st.binary(max_size=20)
    | hnp.arrays(hnp.scalar_dtypes(), hnp.array_shapes(min_dims=0, min_side=0, max_side=17))
    | st.sampled_from(
        [
            object(),
            np.array([1j, "1", None, 10**30], object),
            int,
            print,
            range(3),
            {1, 2},
            np.random.SeedSequence(1),
            Path("none"),
            MAZE_FOLDER,
        ]
    ),
    lambda inner: (
        st.lists(inner, max_size=17) | st.tuples(inner, inner) | st.dictionaries(st.integers(), inner, max_size=3)
    ),
    max_leaves=20,
)


def mostly(usual: st.SearchStrategy, odd: st.SearchStrategy = ODD_NUMBERS | ANYTHING) -> st.SearchStrategy:
    """Something usual, and one time in eight something odd: or else hardly any case got past the first check."""
    return st.integers(0, 7).flatmap(lambda die: usual if die else odd)


@st.composite
def mutated(draw: st.DrawFn, originals: list[bytes], bits: st.SearchStrategy[bytes]) -> bytes:
    """One of the originals, with pieces of it removed, repeated, or overwritten by some of the bits."""
    data = draw(st.sampled_from(originals))
    for _ in range(draw(st.integers(0, 4))):
        start = draw(st.integers(0, len(data)))
        length = draw(st.sampled_from([0, 1, 1, 1, 1, 1, 2, 8, 100, len(data)]))
        piece = data[start : start + length]
        change = draw(st.sampled_from([*["overwrite"] * 6, "insert", "remove", "repeat"]))
        if change == "overwrite":
            piece = draw(bits)
            data = data[:start] + piece + data[start + len(piece) :]
        else:
            piece = {"insert": draw(bits) + piece, "remove": b"", "repeat": 2 * piece}[change]
            data = data[:start] + piece + data[start + length :]
    return data


# Mazes

DRAWING = "S..#\n.#..\n...G"
MAZE = Maze.from_drawing(DRAWING)
MAZE_TEXTS = [
    *(path.read_bytes() for path in sorted(MAZE_FOLDER.glob("*.maze"))),
    *(DRAWING.encode(), b"  2 0\n\n  0 3\n", b"S.\n#G", b"SG"),
    b"size 1,2\nstart 0,0\ngoal 0,1",
    *(text.encode() for text, _ in maze_texts.SAME),
    *maze_texts.SAME_FILES,
]
MAZE_WORDS = st.sampled_from(
    [
        *(
            ".",
            "#",
            "S",
            "G",
            "0",
            "1",
            "2",
            "3",
            "s",
            " ",
            "\t",
            "\n",
            "\r",
            "\x0c",
            "\u2028",
            "\ufeff",
            "\0",
            "\x1a",
            "\x1f",
            "\xa0",
            "\u3000",
            "é",
            "٣",
            *"gEeXx+-|█┌",
        ),
        *("size", "start ", "goal ", "wall ", "door ", "size 2,2\n", "start 0,0\n", "goal 1,1\n", "wall 0,0 9,9\n"),
        *(
            ",",
            "-",
            "-1",
            "1,1",
            "1,1 1,3",
            "1, 1",
            "2 2",
            "0 0 9 9\n",
            "-1.5e1",
            "0.",
            "2048",
            "2049,1",
            "1e3",
            "0x1",
            "9" * 9,
            "9" * 10,
            "9" * 5000,
            "\U000e0001" * 50,
        ),
    ]
).map(lambda word: word.encode()) | st.binary(max_size=4)
DRAWINGS = st.text("SsGgEe23 .0#1Xx+-|█\t\n\n\r\u3000\xa0\x1f\x85\ufeff", max_size=30).map(str.encode)
MAZE_FILES = mutated(MAZE_TEXTS, MAZE_WORDS) | DRAWINGS | st.binary()
WALLS = hnp.arrays(
    bool, hnp.array_shapes(min_dims=2, max_dims=2, max_side=9), elements=st.sampled_from([*[False] * 7, True])
)
CELLS = st.tuples(st.integers(0, 3), st.integers(0, 3))


def behaves(maze: Maze) -> None:
    """Is a maze that was accepted one that can be drawn, walked and equalled?"""
    assert Maze.from_drawing(maze.drawing()) == maze
    assert all(maze.readings(cell) for cell in (maze.start, maze.goal))
    controllers = [[0.0] * 16, [-1.0] * 16, [1.0, -1.0] * 8, [-1.0, 0.5] * 4 + [0.25, -0.75] * 4]
    for row, column in safe.endpoints(maze, controllers, 20):
        assert 0 <= row < maze.shape[0]
        assert 0 <= column < maze.shape[1]
        assert not maze.walls[row, column]


def try_maze_text(data: bytes) -> None:
    behaves(parse_maze(data.decode("utf-8", "surrogateescape")))


def try_maze_file(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mine"
        path.write_bytes(data)
        behaves(safe.load_maze(path))


def try_maze(case: tuple) -> None:
    walls, start, goal, name, cell = case
    maze = Maze(walls, start, goal, name)
    behaves(maze)
    maze.readings(cell)


def try_maze_name(case: object) -> None:
    if isinstance(case, str | list | tuple):
        assert load_mazes(case)
    Maze.from_drawing(case) if isinstance(case, str) else parse_maze(case)


# Controllers, points


@st.composite
def tables(draw: st.DrawFn, columns: st.SearchStrategy[int], numbers: st.SearchStrategy[float]) -> object:
    """Rows of numbers in one of the many forms in which they might be given, with or without something wrong."""
    shape = draw(st.integers(0, 5)), draw(columns)
    table = draw(hnp.arrays(np.float64, shape, elements=numbers))
    if table.size and not draw(st.integers(0, 3)):
        table.flat[draw(st.integers(0, table.size - 1))] = draw(st.floats())
    form = draw(
        st.sampled_from(["f8", "f8", "f8", ">f8", "f4", "f2", "i1", "?", "c16", "O", "U", "S", "g", "M8[s]", "list"])
    )
    with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
        form, table = (form, table) if form == "list" else ("array", table.astype(form))
    if form == "list":
        rows = table.tolist()
        if rows and not draw(st.integers(0, 3)):
            row = draw(st.sampled_from(rows))
            row[:1] = [draw(ANYTHING)]
        return rows
    return draw(
        st.sampled_from([table, table, np.asfortranarray(table), table[::-1], table.T, np.repeat(table, 2, 0)[::2]])
    )


UNIT = st.sampled_from([-1.0, -0.5, 0.0, 0.25, 1.0]) | st.floats(-1, 1)
CONTROLLERS = tables(st.sampled_from([16] * 9 + [0, 1, 15, 17]), UNIT)
STEPS = st.integers(0, 400) | st.sampled_from([0, 1, *[2000] * 20, 1_000_000])
COORDINATES = st.integers(-9, 9).map(float) | st.floats(-100, 100) | st.sampled_from([1e-320, 1e100, -1e100])
COUNTS = st.integers(0, 20) | st.just(1_000_000)


def try_controllers(case: tuple) -> None:
    controllers, steps = case
    ends = safe.endpoints(MAZE, controllers, steps)
    assert ends.shape == (len(controllers), 2)
    assert not MAZE.walls[ends[:, 0], ends[:, 1]].any()
    for controller, end in zip(controllers, ends.tolist(), strict=True):
        path = safe.path(MAZE, controller, steps)
        assert path.shape == (steps + 1, 2)
        assert path[-1].tolist() == end


def try_controller(case: tuple) -> None:
    controller, steps = case
    path = safe.path(MAZE, controller, steps)
    assert path[0].tolist() == list(MAZE.start)
    assert not MAZE.walls[path[:, 0], path[:, 1]].any()


def try_archive(case: tuple) -> None:
    capacity, k, metric, batches = case
    archive = safe.NoveltyArchive(capacity, k, metric)
    for points in batches:
        before = archive.points
        try:
            scores = archive.score(points)
        except ValueError:
            assert np.array_equal(archive.points, before), "what is refused leaves no trace"
            raise
        assert scores.shape == (len(points),)
        assert np.isfinite(scores).all()
        assert (scores >= 0).all()
        assert len(archive) == len(archive.points) == len(archive.scores) <= capacity
        assert np.isfinite(archive.points).all()


# Runs

TINY = safe.Parameters(population=4, objectives=4, generations=2, tournament=2, elites=2, k=2, archive=5, steps=9)
SMALL = {
    "population": st.sampled_from([2, 3, 4, 6, 20]),
    "objectives": st.sampled_from([2, 4, 5, 6, 20]),
    "generations": st.integers(0, 5),
    "tournament": st.integers(0, 9),
    "elites": st.sampled_from([0, 0, 1, 2, 4]),
    "crossover": st.sampled_from([0, 1, 0.5, -0.1]),
    "mutation": st.sampled_from([0, 1, 0.5, 1.1]),
    "k": COUNTS,
    "archive": COUNTS,
    "steps": STEPS,
    "success_distance": st.integers(-1, 9),
    "admission": st.sampled_from([*ADMISSIONS, "none"]),
    "admitted": st.integers(0, 9),
    "threshold": st.floats(-1, 9) | st.integers(0, 9),
    "patience": st.integers(0, 9),
}
PARAMETERS = st.fixed_dictionaries({}, optional={name: mostly(values) for name, values in SMALL.items()})
WEIGHTS = st.floats(-1e100, 1e100) | st.sampled_from([0.0, 1.0, 0.5, 1e308])
OBJECTIVES = st.none() | st.lists(st.lists(WEIGHTS | st.floats(0, 1), min_size=2, max_size=2), max_size=5)
ALGORITHMS = st.fixed_dictionaries(
    {"name": mostly(st.just("mine"))},
    optional={
        "objectives": mostly(OBJECTIVES, tables(st.integers(0, 3), WEIGHTS) | ANYTHING),
        "rating": mostly(st.sampled_from(RATINGS)),
        "scaling": mostly(st.sampled_from(SCALINGS)),
        "judging": mostly(st.sampled_from(JUDGINGS)),
        "kind": mostly(st.sampled_from(KINDS)),
        "components": mostly(st.lists(st.sampled_from(WEIGHABLE), max_size=4)),
        "pool": mostly(st.sampled_from(POOLS)),
    },
)
SEEDS = mostly(st.integers(0) | st.lists(st.integers(-1), max_size=3) | st.just(np.random.SeedSequence(1)))


def is_small(parameters: safe.Parameters) -> bool:
    sizes = (
        parameters.population,
        parameters.objectives,
        parameters.generations,
        parameters.tournament,
        parameters.admitted,
    )
    return max(sizes) <= 20


def try_run(case: tuple) -> None:
    algorithm, seed, parameters = case
    parameters = safe.Parameters(**parameters)
    algorithm = safe.Algorithm(**algorithm)
    if not is_small(parameters):
        return
    *_, last = safe.generations(MAZE, algorithm, seed, parameters)
    run = safe.evolve(MAZE, algorithm, seed, parameters)
    assert last.run == run
    assert isinstance(last, Generation)
    assert np.isfinite([run.distance, run.evaluations, *run.controller, *run.coefficients]).all()
    assert run.success == (run.distance <= parameters.success_distance)
    for scores in (last.components, last.scaled, last.fitness, last.objective_fitness):
        assert scores is None or np.isfinite(scores).all()


def try_arguments(case: tuple) -> None:
    """Arguments of a run that are none at all."""
    maze, algorithm, seed, parameters = case
    safe.evolve(maze, algorithm, seed, parameters)


def try_experiment(case: tuple) -> None:
    algorithm, maze, runs, seed, parameters, run = case
    experiment = safe.Experiment(algorithm, maze, runs, seed, parameters)
    assert re.fullmatch("[0-9a-f]{64}", experiment.digest)
    assert experiment.seed_sequence(run).generate_state(1).size == 1
    if experiment.parameters == TINY:
        assert next(experiment.replay(run)).evaluations == TINY.population


PLACES = st.integers(-99, 99) | st.sampled_from([1_000_000, 1_000_001, 2**63, 2**64])


def try_points(text: object) -> None:
    points = notebook.read_points(text)
    assert points.dtype.kind == "i"
    assert points.shape == (len(text.split()), 2)


TRAITS = ["maze", "controller", "seed", "result"]
SAID = st.recursive(  # by a page, and read as JSON
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text()
    | st.text("0123456789,/x", max_size=9)
    | st.text("SG.#\n", max_size=9)
    | st.sampled_from([MAZE.drawing(), [0.5] * 16]),
    lambda inner: st.lists(inner, max_size=17) | st.dictionaries(st.sampled_from([f.name for f in fields(Run)]), inner),
    max_leaves=20,
)
RUNS = st.fixed_dictionaries(
    {
        "success": mostly(st.booleans(), SAID),
        "generation": mostly(st.integers(0), SAID),
        "distance": mostly(st.integers(0), SAID),
        "controller": mostly(st.lists(UNIT, min_size=16, max_size=16), SAID),
        "coefficients": mostly(st.lists(UNIT, max_size=2), SAID),
        "evaluations": mostly(st.integers(1), SAID),
    }
)


def try_playground(case: tuple) -> None:
    is_from_page, name, value = case
    with closing(safe.Playground(MAZE)) as playground:
        if is_from_page:
            playground.set_state({name: value})
        else:
            setattr(playground, name, value)
        state = json.dumps(playground.get_state(TRAITS), allow_nan=False)
        playground.set_state(json.loads(state))
        assert json.dumps(playground.get_state(TRAITS)) == state
        safe.path(playground.maze, playground.controller, 1)
        safe.evolve(MAZE, "random", playground.seed, TINY)


class Here(Executor):
    """Computes in the calling thread, since a thread for every case would cost more than the case."""

    def submit(self, function: Callable, /, *args: object) -> Future:
        future = Future()
        future.set_result(function(*args))
        return future


# Stores

EXPERIMENT = safe.Experiment("safe", MAZE, runs=4, seed=1, parameters=TINY)


def table_of(store: object):
    return safe.run(EXPERIMENT, store, executor=Here(), progress=False).drop(columns="seconds")


@cache
def expected():
    return table_of(None)


@cache
def stores() -> list[tuple[bytes, bytes]]:
    """Stores as the bytes of a file and of its write-ahead log: one complete and closed, one written only in part."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        path, log = Path(folder) / "s.sqlite", Path(folder) / "s.sqlite-wal"
        table_of(path)
        found.append((path.read_bytes(), b""))
        path.unlink()
        with closing(sqlite3.connect(path)) as reader:  # as long as it is open, the log is not written back
            for runs in (1, 3):
                safe.run(replace(EXPERIMENT, runs=runs), path, executor=Here(), progress=False)
                reader.execute("SELECT count(*) FROM runs").fetchall()
            found.append((path.read_bytes(), log.read_bytes()))
    return found


BITS = st.binary(min_size=1, max_size=64) | st.sampled_from(
    [bytes(4096), b"\xff" * 100, b"\x01", b"[]", b"NaN", b"1e9"]
)


@st.composite
def damaged_stores(draw: st.DrawFn) -> tuple[bytes, bytes]:
    file, log = draw(st.sampled_from(stores()))
    if draw(st.booleans()) or not log:
        file = draw(mostly(mutated([file], BITS), st.binary().map(lambda noise: b"SQLite format 3\0" + noise)))
    else:
        log = draw(mutated([log], BITS))
    return file, log


def try_damaged_store(case: tuple[bytes, bytes]) -> None:
    file, log = case
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.sqlite"
        path.write_bytes(file)
        if log:
            path.with_name("s.sqlite-wal").write_bytes(log)
        assert table_of(path).equals(expected())


CELL_VALUES = (
    st.none() | st.integers(-(2**63), 2**63 - 1) | st.floats() | st.text(max_size=9) | st.binary(max_size=9)
) | st.sampled_from(["[]", "[NaN]", "null", "{}", "[1, 2", "7", 0, 1, 2, 3, -1, "0", 1e308])


@st.composite
def edits(draw: st.DrawFn) -> list[tuple]:
    """Which cells of a valid store are changed, rows deleted or columns renamed, counted over all there are."""
    kind = st.sampled_from(["change", "change", "change", "change", "delete", "rename"])
    return draw(st.lists(st.tuples(kind, st.integers(0, 10**6), CELL_VALUES), min_size=1, max_size=3))


def try_edited_store(case: list[tuple]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.sqlite"
        path.write_bytes(stores()[0][0])
        with closing(sqlite3.connect(path, isolation_level=None)) as connection:
            for kind, place, value in case:
                with suppress(sqlite3.Error):  # the tables refuse some changes themselves
                    _edit(connection, kind, place, value)
        assert table_of(path).equals(expected())


def _edit(connection: sqlite3.Connection, kind: str, place: int, value: object) -> None:
    columns = connection.execute(
        "SELECT t.name, c.name FROM sqlite_master t, pragma_table_info(t.name) c WHERE t.type = 'table' ORDER BY 1, 2"
    ).fetchall()
    table, column = columns[place % len(columns)]
    key = "run" if table == "runs" else "id"
    rows = connection.execute(f'SELECT {key} FROM "{table}"').fetchall()
    if not rows:
        return
    (row,) = rows[place // len(columns) % len(rows)]
    if kind == "change":
        connection.execute(f'UPDATE "{table}" SET "{column}" = ? WHERE {key} = ?', (value, row))
    elif kind == "delete":
        connection.execute(f'DELETE FROM "{table}" WHERE {key} = ?', (row,))
    else:
        connection.execute(f'ALTER TABLE "{table}" RENAME COLUMN "{column}" TO other')


def try_store_path(case: object) -> None:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "text").write_text("run,success\n")
        (Path(folder) / "empty").write_bytes(b"")
        table_of(Path(folder) / case if isinstance(case, str) else case)


# All of them

FORMAT = "a maze|the drawing of a maze|line segments|a line of a maze file|a maze file|size|start|goal|wall"
SETTINGS = "|".join(SMALL)
TARGETS = {
    "maze texts": Target(MAZE_FILES, try_maze_text, FORMAT, 20),
    "maze files": Target(MAZE_FILES, try_maze_file, FORMAT + "|maze", 10),
    "mazes": Target(
        st.tuples(mostly(WALLS), mostly(CELLS), mostly(CELLS), mostly(st.just("mine")), mostly(CELLS)),
        try_maze,
        "walls|start|goal|name|cell",
        10,
    ),
    "maze names": Target(ANYTHING, try_maze_name, FORMAT + "|maze|text", 3),
    "controllers": Target(
        st.tuples(mostly(CONTROLLERS), mostly(STEPS)), try_controllers, "controllers|controller|steps", 10
    ),
    "a controller": Target(
        st.tuples(mostly(hnp.arrays(np.float64, 16, elements=UNIT)), mostly(STEPS)),
        try_controller,
        "controller|steps",
        5,
    ),
    "archives": Target(
        st.tuples(
            mostly(COUNTS),
            mostly(COUNTS),
            mostly(st.sampled_from(METRICS)),
            st.lists(tables(st.just(2), COORDINATES) | mostly(tables(st.integers(0, 3), COORDINATES)), max_size=4),
        ),
        try_archive,
        "capacity|k|metric|points|the columns of points",
        12,
    ),
    "runs": Target(
        st.tuples(ALGORITHMS, SEEDS, PARAMETERS),
        try_run,
        SETTINGS + "|name|objectives|rating|scaling|judging|kind|components|pool|seed|parameters",
        13,
    ),
    "arguments": Target(
        st.tuples(
            mostly(st.just(MAZE)), mostly(st.sampled_from(sorted(safe.ALGORITHMS))), SEEDS, mostly(st.just(TINY))
        ),
        try_arguments,
        "maze|algorithm|seed|parameters",
        4,
    ),
    "experiments": Target(
        st.tuples(
            mostly(st.sampled_from(sorted(safe.ALGORITHMS))),
            mostly(st.just(MAZE)),
            mostly(st.integers(1, 4)),
            mostly(st.integers(0)),
            mostly(st.just(TINY)),
            mostly(st.integers(0)),
        ),
        try_experiment,
        "algorithm|maze|runs|seed|parameters|run",
        4,
    ),
    "points": Target(
        mostly(st.lists(st.tuples(PLACES, PLACES), min_size=2).map(lambda p: " ".join(f"{r},{c}" for r, c in p)))
        | st.text("0123456789, -_x\n", max_size=40),
        try_points,
        "points",
        3,
    ),
    "playground": Target(
        st.tuples(st.just(True), st.sampled_from(TRAITS), SAID)
        | st.tuples(st.just(True), st.just("result"), RUNS)
        | st.tuples(st.just(False), st.sampled_from(TRAITS), ANYTHING)
        | st.tuples(st.just(False), st.just("seed"), SEEDS)
        | st.tuples(st.just(False), st.just("controller"), mostly(hnp.arrays(np.float64, 16, elements=UNIT))),
        try_playground,
        FORMAT + "|maze|text|controller|seed|result|generation|distance|coefficients|evaluations",
        5,
    ),
    "damaged stores": Target(damaged_stores(), try_damaged_store, "store", 3, safe.StoreError),
    "edited stores": Target(edits(), try_edited_store, "store", 2, safe.StoreError),
    "store paths": Target(
        ANYTHING.filter(lambda value: not isinstance(value, str | Path) and value is not None)
        | st.sampled_from(["", ".", "text", "empty", "text/below", "new/folder/s", "a\0b", "\udcff", "x" * 300]),
        try_store_path,
        "store",
        1,
        safe.StoreError,
    ),
}


def share_of(name: str, total: int) -> int:
    """How many of so many cases are of this target."""
    return math.ceil(total * TARGETS[name].share / sum(target.share for target in TARGETS.values()))


def report(name: str, *more: object) -> None:
    """Say how many cases of a target were tried out, and how many of them accepted and refused."""
    accepted, refused = TRIED[name, "accepted"], TRIED[name, "refused"]
    print(f"{name:16}{accepted + refused:9}{accepted:9} accepted{refused:9} refused", *more, flush=True)


def main() -> None:
    warnings.simplefilter("error")
    total = int(sys.argv[1])
    failures = []
    for name in TARGETS:
        started = time.perf_counter()
        try:
            fuzz(name, share_of(name, total))
        except Exception as error:
            failures.append(error)
        report(name, f"{time.perf_counter() - started:6.0f} s")
    print(f"{'all':16}{TRIED.total():9}")
    if failures:
        raise ExceptionGroup("what was neither accepted nor refused", failures)


if __name__ == "__main__":
    main()
