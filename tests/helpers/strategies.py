"""Strategies of Hypothesis: mazes, algorithms, controllers and points."""

import hypothesis.extra.numpy as hnp
import numpy as np
from hypothesis import strategies as st

from safe import Algorithm, Maze
from safe.algorithms import COMPONENTS, WEIGHABLE
from safe.judges import KINDS, RATINGS, SCALINGS
from safe.operators import JUDGINGS
from safe.repertoire import POOLS


@st.composite
def mazes(draw, longest=12):
    """Mazes of up to `longest` cells a side, the walls at random, with at least one way to the goal."""
    height, width = draw(st.integers(2, longest)), draw(st.integers(2, longest))
    walls = draw(hnp.arrays(bool, (height, width), elements=st.sampled_from([False, False, True])))
    start = draw(st.tuples(st.integers(0, height - 1), st.integers(0, width - 1)))
    goal = draw(st.tuples(st.integers(0, height - 1), st.integers(0, width - 1)).filter(lambda cell: cell != start))
    # a corridor: along the row of the start, then along the column of the goal
    walls[start[0], min(start[1], goal[1]) : max(start[1], goal[1]) + 1] = False
    walls[min(start[0], goal[0]) : max(start[0], goal[0]) + 1, goal[1]] = False
    return Maze(walls, start, goal)


@st.composite
def algorithms(draw):
    """Algorithms with any choices that go together."""
    kind, pool = draw(st.sampled_from(KINDS)), draw(st.sampled_from(POOLS))
    judging, scaling, rating = "best score", "raw", "none"
    components = COMPONENTS
    nobody = kind == "weights" and pool == "repertoire"  # is there to judge
    if not nobody:
        allowed = JUDGINGS if pool == "generation" else JUDGINGS[1:] if kind == "goal" else ["favourite"]
        judging = draw(st.sampled_from(allowed))
        ratings = {"weights": [r for r in RATINGS if r != "patience"], "goal": RATINGS, "mixed": ["none", "redrawn"]}
        rating = draw(st.sampled_from(ratings[kind]))
    if kind != "goal":
        scaling = draw(st.sampled_from(SCALINGS))
        components = draw(st.lists(st.sampled_from(WEIGHABLE), min_size=1, unique=True) | st.just(COMPONENTS))
    genes = {"weights": len(components), "goal": 2, "mixed": max(2, len(components))}[kind]
    values = st.sampled_from([-0.5, 0.0, 0.25, 1.0] if kind == "weights" else [0.0, 0.3, 0.99, 1.0])
    given = st.lists(st.lists(values, min_size=genes, max_size=genes), min_size=4, max_size=4)
    objectives = [] if nobody else draw(st.none() | given)
    return Algorithm("mine", objectives, rating, scaling, judging, kind, components, pool)


def controllers(count=None):
    """One controller, or an array of `count` of them."""
    shape = 16 if count is None else (count, 16)
    # few distinct values, so that sums are often exactly zero
    return hnp.arrays(np.float64, shape, elements=st.sampled_from([-1.0, -0.5, 0.0, 0.25, 1.0]) | st.floats(-1, 1))


def generations_of_points():
    """A few generations of points in one to three dimensions; from a small grid, so that there are many ties."""
    return st.integers(1, 3).flatmap(
        lambda dimensions: st.lists(
            hnp.arrays(
                np.float64,
                st.tuples(st.integers(0, 9), st.just(dimensions)),
                elements=st.integers(0, 6).map(float) | st.floats(0, 6, allow_subnormal=False),
            ),
            min_size=1,
            max_size=5,
        )
    )
