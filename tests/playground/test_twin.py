"""The engine of the playground gives what the package gives, bit for bit. Skipped without Node and Chromium."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import safe
from safe import Algorithm, Maze, NoveltyArchive, Parameters, checks, load_maze
from safe.algorithms import WEIGHABLE
from safe.maze import ways_to_goal
from safe.maze_files import MAZE_FOLDER, parse_maze, text_of
from safe.novelty import ADMISSIONS, METRICS
from safe.operators import JUDGINGS
from tests.helpers import fuzz, golden, maze_texts, oracle, record
from tests.helpers.reference import reference_endpoints
from tests.helpers.runs import runs_of_every_kind, runs_with_choices
from tests.helpers.strategies import controllers, generations_of_points, mazes
from tests.helpers.twin import TWINS, as_in_engine, in_node, needs_node, run_of

DATA = Path(__file__).parents[1] / "data"


@pytest.fixture(scope="module", params=TWINS)
def twin(request):
    with request.param() as twin:
        yield twin


# The maze and the robot


def described(maze):
    """A maze in the form of the engine."""
    return {
        "name": maze.name,
        "height": maze.shape[0],
        "width": maze.shape[1],
        "walls": maze.walls.astype(int).ravel().tolist(),
        "start": list(maze.start),
        "goal": list(maze.goal),
        "sensors": maze.sensors.ravel().tolist(),
    }


def parsed(text):
    """The answer that the twin must give to a text: its maze, or the complaint."""
    try:
        return {"result": described(parse_maze(text))}
    except ValueError as error:
        return {"error": str(error)}


def assert_parsed_alike(twin, texts):
    calls = [{"function": "parseMaze", "maze": text} for text in texts]
    for text, answer in zip(texts, twin.answers(calls), strict=True):
        answer.pop("stack", None)
        assert answer == parsed(text), repr(text)


def assert_read_alike(twin, files):
    calls = [{"function": "readMaze", "bytes": list(data)} for data in files]
    for data, answer in zip(files, twin.answers(calls), strict=True):
        answer.pop("stack", None)
        assert answer == parsed(text_of(data)), data


def test_mazes_from_their_files(twin):
    files = [*MAZE_FOLDER.glob("*.maze"), *DATA.glob("*_maze.txt")]
    assert len(files) == 6
    assert_read_alike(twin, [file.read_bytes() for file in files])


def test_a_maze_has_its_name(twin):
    (maze,) = twin.results([{"function": "parseMaze", "maze": "S.G", "name": "mine"}])
    assert maze["name"] == "mine"


def test_a_text_that_is_no_maze_is_refused_in_the_same_words(twin):
    assert_parsed_alike(twin, [text for text, _ in maze_texts.BAD])
    assert_read_alike(twin, [data for data, _ in maze_texts.BAD_FILES])


def test_texts_of_the_same_maze(twin):
    assert_parsed_alike(twin, [text for text, _ in maze_texts.SAME])
    assert_read_alike(twin, maze_texts.SAME_FILES)


@given(texts=st.lists(fuzz.MAZE_FILES.map(lambda data: data.decode("utf-8", "surrogateescape")), max_size=20))
def test_whatever_the_text_it_is_the_same_maze_or_the_same_words(twin, texts):
    assert_parsed_alike(twin, texts)


@settings(max_examples=30)
@given(files=st.lists(fuzz.MAZE_FILES, max_size=20))
def test_whatever_the_file_it_is_the_same_maze_or_the_same_words(twin, files):
    assert_read_alike(twin, files)


# only characters that every version of Unicode has: Python and a browser may know different versions
@given(
    texts=st.lists(st.text(st.characters(codec="latin-1") | st.sampled_from("٣\u2028\u3000\ud800\ue000😀\U000e0001")))
)
def test_a_text_is_shown_as_by_python(twin, texts):
    calls = [{"function": "shown", "value": text} for text in texts]
    assert twin.results(calls) == [checks.shown(text) for text in texts]


@given(maze=mazes(), batch=controllers(count=5), steps=st.integers(0, 400))
def test_mazes_paths_and_endpoints(twin, maze, batch, steps):
    at = {"maze": maze.drawing(), "steps": steps}
    paths = [{"function": "path", "controller": controller, **at} for controller in batch.tolist()]
    endpoints = {"function": "endpoints", "controllers": batch.tolist(), **at}
    *walked, ended = twin.results([*paths, endpoints])
    assert walked == [safe.path(maze, controller, steps).tolist() for controller in batch]
    assert ended == safe.endpoints(maze, batch, steps).tolist()
    assert_parsed_alike(twin, [maze.drawing()])


@given(maze=mazes())
def test_a_maze_is_written_as_a_drawing_and_as_a_list(twin, maze):
    (written,) = twin.results([{"function": "writtenMaze", "maze": maze.drawing()}])
    assert written["drawing"] == maze.drawing()
    assert parse_maze(written["list"]) == maze
    assert written["list"].startswith("size ")
    assert written["ways"] == ways_to_goal(maze).ravel().tolist()


def test_every_reference_end_point(twin):
    rows = list(reference_endpoints())
    assert len(rows) == 320
    calls, expected = [], []
    for maze, steps in sorted({row[:2] for row in rows}):
        walks = [row[2:] for row in rows if row[:2] == (maze, steps)]
        at = {"maze": load_maze(maze).drawing(), "steps": steps}
        calls.append({"function": "endpoints", "controllers": [controller for controller, _ in walks], **at})
        expected.append([list(end) for _, end in walks])
        calls.append({"function": "path", "controller": walks[0][0], **at})
        expected.append(safe.path(maze, walks[0][0], steps).tolist())
    assert twin.results(calls) == expected


# Novelty


def archived(generations, **arguments):
    """The package's archive after each generation, in the form of the engine."""
    archive = NoveltyArchive(**arguments)
    for points in generations:
        novelty = archive.score(points).tolist()
        listed = {"points": archive.points.tolist(), "scores": archive.scores.tolist()}
        yield {"novelty": novelty, **listed, "length": len(archive)}


@pytest.mark.parametrize(
    ("points", "scores", "metric"),
    [("endpoints", "endpoint_novelty", "taxicab"), ("objectives", "objective_novelty", "euclidean")],
)
def test_every_reference_score(twin, points, scores, metric):
    with np.load(DATA / "novelty.npz") as reference:
        generations, expected = reference[points].tolist(), reference[scores]
    (found,) = twin.results([{"function": "NoveltyArchive", "metric": metric, "generations": generations}])
    np.testing.assert_allclose([after["novelty"] for after in found], expected, rtol=0, atol=1e-12)
    assert found == list(archived(generations, metric=metric))


@given(
    generations=generations_of_points().map(
        lambda generations: [points.tolist() for points in generations if len(points)]
    ),
    capacity=st.integers(0, 12),
    k=st.integers(1, 20),
    metric=st.sampled_from(METRICS),
)
def test_scores_and_archives_of_any_points(twin, generations, capacity, k, metric):
    settings = {"capacity": capacity, "k": k, "metric": metric}
    (found,) = twin.results([{"function": "NoveltyArchive", "generations": generations, **settings}])
    assert found == list(archived(generations, **settings))


# Runs


def test_runs_of_every_kind(twin):
    runs = runs_of_every_kind()
    found = twin.results(run_of("evolve", *run) for run in runs)
    for run, got in zip(runs, found, strict=True):
        assert got == as_in_engine(safe.evolve(*run)), run
    assert {got["success"] for got in found} == {False, True}


def test_every_generation_of_some_of_them(twin):
    for run in runs_of_every_kind()[::4]:
        (found,) = twin.results([run_of("generations", *run)])
        assert found == [as_in_engine(generation) for generation in safe.generations(*run)], run


@pytest.mark.parametrize("maze", ["maze1", "maze2"])
@pytest.mark.parametrize("algorithm", safe.ALGORITHMS)
def test_every_generation_until_the_archives_are_full_and_beyond(twin, algorithm, maze):
    run = load_maze(maze), algorithm, 7, Parameters(generations=9, success_distance=0)
    (found,) = twin.results([run_of("generations", *run)])
    assert found == [as_in_engine(generation) for generation in safe.generations(*run)]


def test_every_generation_with_each_combination_of_choices(twin):
    runs = runs_with_choices()
    found = twin.results(run_of("generations", *run) for run in runs)
    for run, got in zip(runs, found, strict=True):
        assert got == [as_in_engine(generation) for generation in safe.generations(*run)], run
    assert {len(got) > 1 for got in found} == {False, True}


CHOICES = [
    {"scaling": "maximum"},
    {"scaling": "rank"},
    {"judging": "drawn judge"},
    {"judging": "favourite"},
    *({"rating": rating} for rating in ("mutualism", "competition", "discovery", "shuffled", "redrawn")),
    {"components": WEIGHABLE},
    {"rating": "pearson", "judging": "drawn judge"},
    {"rating": "spearman", "judging": "drawn judge"},
    *({"admission": admission} for admission in ADMISSIONS[1:]),
]


@pytest.mark.parametrize("maze", ["maze1", "maze2"])
@pytest.mark.parametrize("choice", CHOICES, ids=lambda choice: ", ".join(map(str, choice.values())))
def test_every_generation_with_a_choice_until_the_archive_is_full_and_beyond(twin, choice, maze):
    choice = {"rating": "genotypic novelty"} | choice
    rules = {"admission": choice.pop("admission")} if "admission" in choice else {}
    parameters = Parameters(generations=7, success_distance=0, archive=25, threshold=3, **rules)
    run = load_maze(maze), Algorithm("mine", **choice), 7, parameters
    (found,) = twin.results([run_of("generations", *run)])
    assert found == [as_in_engine(generation) for generation in safe.generations(*run)]
    assert len(found[-1]["archive"]["points"]) == 25


GOALS = [
    {"rating": rating, "judging": judging, "kind": "goal", "pool": pool}
    for rating in ("none", "mutualism", "competition", "discovery", "patience", "redrawn")
    for judging, pool in (("favourite", "generation"), ("favourite", "repertoire"), ("drawn judge", "repertoire"))
]
MIXED = {"rating": "redrawn", "judging": "favourite", "kind": "mixed", "pool": "repertoire"}
NOBODY = {"objectives": [], "pool": "repertoire"}


@pytest.mark.parametrize("choice", [*GOALS, MIXED, NOBODY], ids=lambda choice: ", ".join(map(str, choice.values())))
def test_every_generation_with_goals_and_a_repertoire_of_many_cells(twin, choice):
    parameters = Parameters(generations=25, success_distance=0, patience=3)
    run = load_maze("maze2"), Algorithm("mine", **choice), 7, parameters
    (found,) = twin.results([run_of("generations", *run)])
    assert found == [as_in_engine(generation) for generation in safe.generations(*run)]
    if choice.get("pool") == "repertoire":
        assert len(found[-1]["repertoire"]["endpoints"]) > 200


@settings(max_examples=30)
@given(
    first=st.floats(0, 9),
    generations=st.lists(st.tuples(st.sampled_from([100, 1249, 1250, 2500]), st.sampled_from([0, 0, 0, 1, 4, 5]))),
)
def test_the_threshold_of_admission_rises_and_falls(twin, first, generations):
    threshold, archive, scores, expected = oracle.Threshold(first), oracle.Archive(5), [], []
    for others, entering in generations:
        scores.append([threshold.value] * others + [np.nextafter(threshold.value, np.inf)] * entering)
        threshold.admit([None] * len(scores[-1]), scores[-1], archive)
        entered = [score for score, _, _ in archive.members]
        expected.append({"value": threshold.value, "idle": threshold.idle, "entered": entered})
    assert twin.results([{"function": "admitAbove", "threshold": first, "scores": scores}]) == [expected]


@pytest.mark.parametrize(
    ("archive", "admission"),
    [
        (0, "lowest replaced"),
        (300, "lowest replaced"),
        (1000, "lowest replaced"),
        (1000, "random"),
        (1000, "threshold"),
        *((50, admission) for admission in ADMISSIONS[3:]),
    ],
)
def test_neighbours_are_those_that_make_the_novelty(twin, archive, admission):
    parameters = Parameters(generations=4, archive=archive, admission=admission, admitted=30, threshold=2)
    run = load_maze("maze2"), "novelty", 3, parameters
    (neighbours,) = twin.results([run_of("neighbours", *run)])
    *_, before, last = safe.generations(*run)
    archived = [*before.archive[0].tolist(), *last.endpoints.tolist()]
    for found, point, novelty in zip(neighbours, last.endpoints, last.novelty, strict=True):
        distances = [neighbour["distance"] for neighbour in found]
        assert distances == sorted(distances)
        assert len(distances) == 15
        assert sum(distances) / 15 == novelty
        for neighbour in found:
            assert np.abs(point - neighbour["point"]).sum() == neighbour["distance"]
            assert neighbour["point"] in (last.endpoints.tolist() if neighbour["from"] == "population" else archived)
    assert any(neighbour["from"] == "archive" for found in neighbours for neighbour in found) == (archive > 0)
    assert archive == 1000 or len(before.archive[0]) == archive  # so that points have left it


BAD_ARGUMENTS = [
    *({"algorithm": name} for name in ("saef", "", "constructor", None)),
    {"algorithm": ("mine", None, "by taste")},
    {"algorithm": ("mine", None, "pearson", "log")},
    {"algorithm": ("mine", None, "none", "raw", "favourites")},
    {"algorithm": ("mine", [(1, 0, 0)], "none", "raw", None)},
    {"algorithm": ("mine", [(1, 0)] * 3, "spearman", "rank", "drawn judge")},
    {"algorithm": ("mine", [(1, 0)] * 2, "pearson")},
    {"algorithm": ("mine", [(1, 0, 0)])},
    {"algorithm": ("mine", [(1, 1e308)])},
    {"algorithm": ("mine", [(1, 0)] * 3, "genotypic novelty")},
    {"algorithm": ("mine", [], "genotypic novelty")},
    {"algorithm": ("mine", [(1, 0)] * 2, "genotypic novelty")},
    *(
        {"algorithm": {"name": "mine", **fields}}
        for fields in (
            *({"kind": kind} for kind in ("goals", "", None)),
            *({"pool": pool} for pool in ("archive", None)),
            *(
                {"components": components}
                for components in ("novelty", [], ["novelty"] * 2, ["distance"], ["1 / way", None], None, 1)
            ),
            {"kind": "goal", "scaling": "rank"},
            {"kind": "goal", "components": ["novelty"]},
            {"kind": "goal", "components": ["1 / distance", "novelty", "path rarity"]},
            {"kind": "goal", "objectives": [(0, 1), (0.5, 1.01)]},
            {"kind": "goal", "objectives": [(0, 1, 0)]},
            {"kind": "goal", "objectives": []},
            {"kind": "goal", "objectives": [(0, 1)] * 3, "rating": "mutualism"},
            {"kind": "goal", "objectives": [(0, 1)] * 3, "rating": "patience"},
            {"kind": "goal", "objectives": [(0, 1)] * 2, "rating": "patience"},
            {"kind": "goal", "pool": "repertoire"},
            {"kind": "mixed", "objectives": []},
            {"kind": "mixed", "objectives": [(0, 1)] * 3},
            {"kind": "mixed", "objectives": [(0, -0.5)] * 4},
            {"kind": "mixed", "objectives": [(0, 1)] * 2, "rating": "redrawn"},
            *({"kind": "mixed", "rating": rating} for rating in ("pearson", "discovery", "patience")),
            *({"kind": "mixed", "pool": "repertoire", "judging": judging} for judging in JUDGINGS[:2]),
            {"rating": "patience"},
            {"pool": "repertoire"},
            {"pool": "repertoire", "judging": "favourite"},
            {"pool": "repertoire", "objectives": [(1, 0)]},
            {"pool": "repertoire", "objectives": [], "judging": "favourite"},
            {"pool": "repertoire", "objectives": [], "kind": "goal", "judging": "favourite"},
            {"pool": "repertoire", "objectives": [], "rating": "redrawn"},
            {"components": ["novelty"], "objectives": [(1, 0)]},
            {"components": ["novelty", "1 / way", "path rarity"], "objectives": [(1, 0)]},
        )
    ),
    *({"seed": seed} for seed in (-1, 0.5, None, [], [1, -2])),
    *({"parameters": {"population": value}} for value in (0, 51, 2, 1.5, "1", None, 10**9)),
    *({"parameters": {"objectives": value}} for value in (-2, 3, 2)),
    *({"parameters": {"elites": value}} for value in (-1, 1, 200)),
    *({"parameters": {"crossover": value}} for value in (-0.5, 1.01, None)),
    *(
        {"parameters": {name: -1}}
        for name in ("generations", "tournament", "k", "archive", "steps", "success_distance")
    ),
    *({"parameters": {name: 0}} for name in ("generations", "tournament", "k", "steps")),
    {"parameters": {"mutation": 2, "k": 0}},
    *({"parameters": {"admission": value}} for value in ("all", "", None, 0)),
    *({"parameters": {"admitted": value}} for value in (0, 1.5, 10**9)),
    *({"parameters": {"threshold": value}} for value in (-0.5, 10**7, "6", None)),
    {"parameters": {"threshold": -1, "admission": "constructor"}},
    *({"parameters": {"patience": value}} for value in (0, 1.5, None, 10**7)),
]


@pytest.mark.parametrize("function", ["evolve", "generations"])
def test_bad_arguments_are_refused_in_the_same_words(twin, function):
    calls = []
    for bad in BAD_ARGUMENTS:
        call = {"function": function, "maze": "S.G", "algorithm": "safe", "seed": 0, "parameters": {}, **bad}
        if isinstance(call["algorithm"], tuple):
            names = "name", "objectives", "rating", "scaling", "judging"
            call["algorithm"] = dict(zip(names, call["algorithm"], strict=False))
        calls.append(call)
    for call, answer in zip(calls, twin.answers(calls), strict=True):
        algorithm = call["algorithm"]
        with pytest.raises(ValueError, match=" must ") as refused:
            safe.evolve(
                Maze.from_drawing(call["maze"]),
                Algorithm(**algorithm) if isinstance(algorithm, dict) else algorithm,
                call["seed"],
                Parameters(**call["parameters"]),
            )
        assert answer.get("error") == str(refused.value), call


@pytest.mark.parametrize(
    "arguments", [{"k": 0}, {"k": 1.5}, {"capacity": -1}, {"capacity": 10**7}, {"metric": "cosine"}, {"metric": None}]
)
def test_bad_archives_are_refused_in_the_same_words(twin, arguments):
    (answer,) = twin.answers([{"function": "NoveltyArchive", "generations": [], **arguments}])
    with pytest.raises(ValueError, match="must be") as refused:
        NoveltyArchive(**arguments)
    assert answer.get("error") == str(refused.value)


@needs_node
def test_golden_runs():
    recorded = json.loads(golden.FILE.read_text())
    runs = recorded["runs"] + recorded["choices"]
    calls = [{"function": "evolve", "parameters": {}, **run, "maze": load_maze(run["maze"]).drawing()} for run in runs]
    with in_node() as twin:
        assert twin.results(calls) == [run["outcome"] for run in runs]


def test_runs_behind_the_ledger(twin):
    """Of each evolutionary algorithm in each maze, the three of 500 recorded runs that succeed soonest."""
    recorded = record.recorded_runs()
    calls, expected = [], []
    for experiment in record.experiments():
        runs = recorded[record.key(experiment)]
        if experiment.algorithm.is_random_search:
            continue
        for number, row in runs[runs.success].sort_values("generation", kind="stable").head(3).iterrows():
            run = experiment.maze, experiment.algorithm, experiment.seed_sequence(number), Parameters()
            calls.append(run_of("evolve", *run))
            expected.append((row.generation, row.distance, row.filter(regex=r"^p\d+$").tolist()))
    assert len(calls) > 12
    for got, (generation, distance, controller) in zip(twin.results(calls), expected, strict=True):
        assert (got["generation"], got["distance"]) == (generation, distance)
        assert got["controller"] == controller or np.isnan(controller).all()


def test_the_default_parameters(twin):
    call = run_of("evolve", load_maze("maze1"), "random", 5, Parameters())
    del call["parameters"]
    (found,) = twin.results([call])
    assert found == as_in_engine(safe.evolve("maze1", "random", 5))


seeds = st.integers(0, 2**300) | st.sampled_from([0, 1, 2**32 - 1, 2**32, 2**53, 2**64])


@settings(max_examples=30)
@given(
    seed=seeds
    | st.lists(seeds, min_size=1, max_size=6)
    | st.builds(
        lambda entropy, key: np.random.SeedSequence(entropy, spawn_key=key),
        seeds | st.lists(seeds, min_size=1, max_size=6),
        st.lists(st.integers(0, 2**40), max_size=3),
    )
)
@example(np.random.SeedSequence([2**64, 0], spawn_key=(0,)))
def test_random_search_draws_the_numbers_of_numpy(twin, seed):
    parameters = Parameters(20, 20, generations=3, steps=1)
    (found,) = twin.results([run_of("generations", Maze.from_drawing("S.G"), "random", seed, parameters)])
    sequence = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
    drawn = -1 + 2 * np.random.Generator(np.random.SFC64(sequence)).random((3, 20, 16))
    assert [generation["genomes"] for generation in found] == drawn.tolist()


def test_the_digests_of_experiments(twin):
    rng = np.random.default_rng(2022)
    experiments = [
        safe.Experiment(algorithm, maze, seed=int(rng.integers(2**62)), parameters=parameters)
        for maze, algorithm, _, parameters in [*runs_of_every_kind(), *runs_with_choices()]
    ]
    # numbers that Python and JavaScript write in different ways
    numbers = [1e-4, 1e-5, 1e-7, 1e15, 1e16, 123456789012345678.0, 1e22, 5e-324, -0.0, 0.1 + 0.2, 1 / 3, -1e-300]
    experiments += [safe.Experiment(safe.Algorithm("one", [(number, 1)]), "maze2") for number in numbers]
    calls = [run_of("digest", e.maze, e.algorithm, 0, e.parameters) | {"seed": str(e.seed)} for e in experiments]
    assert twin.results(calls) == [experiment.digest for experiment in experiments]
