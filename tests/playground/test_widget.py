import json
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib import pyplot as plt

import safe

DRAWING = "#####\n#S.G#\n#####"
RUN = safe.Run(True, 3, 2, (0.5, -1.0) + (0.0,) * 14, (0.25, 1.0), 800)
GENERATIONS = safe.Parameters(generations=2)


@pytest.fixture
def playground():
    playground = safe.Playground()
    yield playground
    playground.close()


def page_of(playground):
    """The traits as the page receives them."""
    state = playground.get_state(["maze", "controller", "seed", "result"])
    return json.loads(json.dumps(state))


def test_what_it_shows_at_first(playground):
    assert playground.maze == safe.load_maze("maze1")
    assert playground.maze.name == "maze1"
    assert (playground.controller, playground.seed, playground.result) == ((0,) * 16, 0, None)
    assert page_of(playground) == {
        "maze": safe.load_maze("maze1").drawing(),
        "controller": [0.0] * 16,
        "seed": "0",
        "result": None,
    }


@pytest.mark.parametrize("form", ["maze", "name", "path", "drawing", "file"])
def test_a_maze_in_any_form(playground, form, tmp_path):
    expected = safe.Maze.from_drawing(DRAWING)
    file = tmp_path / "mine.maze"
    file.write_text(DRAWING)
    given = {
        "maze": expected,
        "name": "maze2",
        "path": file,
        "drawing": DRAWING,
        "file": "size 3,5\nstart 1,1\ngoal 1,3\nwall 0,0 0,4\nwall 2,0 2,4\nwall 1,0 1,0\nwall 1,4 1,4",
    }[form]
    playground.maze = given
    assert playground.maze == (safe.load_maze("maze2") if form == "name" else expected)
    assert page_of(playground)["maze"] == playground.maze.drawing()


@pytest.mark.parametrize("controller", [np.linspace(-1, 1, 16), [0.5] * 16, RUN.controller])
def test_a_controller_in_any_form(playground, controller):
    playground.controller = controller
    assert playground.controller == tuple(controller)
    assert page_of(playground)["controller"] == list(controller)
    assert safe.path(playground.maze, playground.controller).shape == (301, 2)


@pytest.mark.parametrize(
    ("seed", "text"),
    [
        (7, "7"),
        (np.int64(7), "7"),
        (2**64 - 1, "18446744073709551615"),
        (2**256 - 1, "0x" + 64 * "f"),
        ((1, 2, 3), "1,2,3"),
        ([1, 2**70], "1,0x400000000000000000"),
        (np.random.SeedSequence(7), "7"),
        (np.random.SeedSequence(7, spawn_key=(17, 3)), "7/17,3"),
        (np.random.SeedSequence(np.array([4, 5], dtype=np.uint32), spawn_key=[0]), "4,5/0"),
        (
            safe.Experiment("safe", "maze1").seed_sequence(5),
            f"{hex(int(safe.Experiment('safe', 'maze1').digest, 16))}/5",
        ),
    ],
)
def test_a_seed_gives_the_same_run_in_any_form(playground, seed, text):
    playground.seed = seed
    assert page_of(playground)["seed"] == text
    runs = [safe.evolve("maze1", "standard", s, GENERATIONS) for s in (seed, playground.seed)]
    assert runs[0] == runs[1]
    playground.seed = 1
    playground.set_state({"seed": text})
    assert page_of(playground)["seed"] == text
    assert safe.evolve("maze1", "standard", playground.seed, GENERATIONS) == runs[0]


@pytest.mark.parametrize(
    ("text", "same"),
    [("0xFF", 255), ("007", 7), ("1,0x2", (1, 2)), ("0/0", np.random.SeedSequence(0, spawn_key=(0,)))],
)
def test_a_seed_as_the_page_may_write_it(playground, text, same):
    playground.set_state({"seed": text})
    random = [np.random.default_rng(seed).random() for seed in (playground.seed, same)]
    assert random[0] == random[1]


def test_a_result_is_shown_with_its_controller(playground):
    playground.result = RUN
    assert playground.controller == RUN.controller
    assert page_of(playground)["result"] == {
        "success": True,
        "generation": 3,
        "distance": 2,
        "controller": list(RUN.controller),
        "coefficients": [0.25, 1.0],
        "evaluations": 800,
    }
    playground.result = None
    assert playground.controller == RUN.controller


def test_a_generation_is_a_result(playground):
    *_, last = safe.generations("maze1", "safe", 1, GENERATIONS)
    playground.result = last
    assert playground.result == safe.evolve("maze1", "safe", 1, GENERATIONS)


@pytest.mark.parametrize("algorithm", ["safe", "random"])
def test_the_page_gives_the_run_that_python_would(playground, algorithm):
    run = safe.evolve("maze1", algorithm, 1, GENERATIONS)
    playground.result = run
    shown = page_of(playground)["result"]
    playground.result = None
    playground.set_state({"result": shown})
    assert playground.result == run
    assert playground.controller == run.controller


def test_what_the_page_changes_is_observed(playground):
    seen = []
    playground.observe(lambda change: seen.append((change.name, change.new)), ["maze", "controller"])
    playground.set_state({"maze": "S.\n.G", "controller": [1] * 16})
    assert seen == [("maze", safe.Maze.from_drawing("S.\n.G")), ("controller", (1.0,) * 16)]


def test_one_row_can_be_drawn_in_the_page(playground):
    playground.set_state({"maze": "S..G"})
    assert playground.maze.shape == (1, 4)


BAD = [
    ("maze", "maze3", "maze must be one of 'hard', 'maze1', 'maze2', 'medium' or the path of a maze file; got 'maze3'"),
    ("maze", "S.\n..", "the drawing of a maze must have exactly one goal; got 0"),
    ("maze", None, "maze must be a Maze, a maze's name or a file's path; got None"),
    ("controller", [0] * 15, r"controller must have the shape \(16\); got shape \(15,\)"),
    ("controller", [2] * 16, r"controller must be finite and in \[-1, 1\]; got 2.0 at index \(0,\)"),
    ("controller", "0" * 16, "controller must be an array of numbers; got '0000000000000000'"),
    ("seed", -1, "seed must be a non-negative integer, a sequence of them, or a SeedSequence; got -1"),
    ("seed", "7", "seed must be a non-negative integer, a sequence of them, or a SeedSequence; got '7'"),
    ("seed", 2**256, "seed must be an integer from 0 to [0-9]*; got "),
    ("seed", np.random.SeedSequence(7, pool_size=8), "seed must have a pool_size of 4; got 8"),
    ("result", {"success": True}, "result must be a safe.Run or None; got {'success': True}"),
]


@pytest.mark.parametrize(("name", "value", "message"), BAD)
def test_a_bad_value_is_refused(playground, name, value, message):
    before = getattr(playground, name)
    with pytest.raises(ValueError, match=f"^{message}") as error:
        setattr(playground, name, value)
    assert "\n" not in str(error.value)
    assert getattr(playground, name) == before


@pytest.mark.parametrize(("name", "value", "message"), [bad for bad in BAD if bad[0] != "result"])
def test_it_is_not_made_of_a_bad_value(name, value, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        safe.Playground(**{name: value})


NONSENSE = [
    None,
    7,
    -1.5,
    True,
    "",
    "S",
    "#",
    "/",
    "1/",
    "1//2",
    "0x",
    "9" * 4301,
    [],
    {},
    [None] * 16,
    ["0"] * 16,
    {"success": 1},
]
RESULT = {
    "success": True,
    "generation": 3,
    "distance": 2,
    "controller": [0] * 16,
    "coefficients": [1, 0],
    "evaluations": 9,
}


@pytest.mark.parametrize(
    ("name", "value"),
    [(name, value) for name in ("maze", "controller", "seed") for value in NONSENSE]
    + [("result", value) for value in NONSENSE if value is not None]
    + [
        ("result", RESULT | change)
        for change in (
            {"success": 1},
            {"generation": -1},
            {"generation": 1.5},
            {"distance": "2"},
            {"controller": [0] * 15},
            {"coefficients": [[1, 0]]},
            {"coefficients": None},
            {"evaluations": 0},
            {"more": 1},
        )
    ],
)
def test_nonsense_from_the_page_changes_nothing(playground, name, value):
    before = page_of(playground)
    with pytest.raises(ValueError, match=" must ") as error:
        playground.set_state({name: value})
    assert "\n" not in str(error.value)
    assert page_of(playground) == before
    playground.set_state({"result": RESULT})  # what makes sense is still taken
    assert playground.result.evaluations == 9


def test_where_there_is_no_kernel_a_picture_stands_for_it(playground):
    data, _ = playground._repr_mimebundle_()
    assert ElementTree.fromstring(data["image/svg+xml"]).tag.endswith("svg")
    assert data["application/pdf"].startswith("JVBERi")  # %PDF-
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == playground.model_id
    assert plt.get_fignums() == []
    playground.controller = [-1] * 16
    assert playground._repr_mimebundle_()[0]["image/svg+xml"] != data["image/svg+xml"]


WITHOUT_ANYWIDGET = """
import sys
sys.modules["anywidget"] = None  # as if it were not installed
import inspect, pydoc, safe
from safe import *
try:
    safe.Playground
except AttributeError as error:
    print(error)
assert not hasattr(safe, "Playground")
assert "Playground" not in dict(inspect.getmembers(safe))
assert "evolve" in pydoc.render_doc(safe)
"""


def test_without_anywidget_all_else_can_be_used():
    command = [sys.executable, "-c", WITHOUT_ANYWIDGET]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert output == "safe.Playground needs anywidget: pip install anywidget\n"


def test_only_who_asks_for_it_loads_anywidget():
    code = "import sys, safe; assert not {'anywidget', 'ipywidgets', 'matplotlib'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_name_that_there_is_not():
    with pytest.raises(AttributeError, match="module 'safe' has no attribute 'Playgroud'"):
        safe.Playgroud  # noqa: B018
