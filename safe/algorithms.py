"""The paper's algorithms and its Table 1, as data, and the choices beyond the paper.

Every solution S_i is scored by every objective function O_j of a population of objective functions and takes the best
score (Algorithm 1 of the paper). An objective function is a weighted sum of components,

    O_j(S_i) = a_j * (1 / distance of S_i's end point to the goal) + b_j * (novelty of S_i)         (Equation 1)

and the algorithms differ only in who judges:

    standard    the single [1, 0], which never changes
    novelty     the single [0, 1], which never changes
    fixed       the single [1/2, 1/2], which never changes
    safe        a population of random ones, bred by their genotypic novelty (Algorithm 2)
    random      nobody: there is nothing to select by, so every generation is drawn at random

A choice has a name, and the paper's is the default:

    who judges      `Algorithm`: `kind`, `components`, `scaling` and `rating` (see `safe.judges`), `judging` (see
                    `safe.operators`), `pool` (see `safe.repertoire`)
    sizes, rules    `Parameters`: `admission` (see `safe.novelty`)
"""

from __future__ import annotations

import string
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields

from safe import checks
from safe.judges import KINDS, RATINGS, SCALINGS
from safe.novelty import ADMISSIONS, ARCHIVE_CAPACITY, K
from safe.operators import JUDGINGS
from safe.repertoire import POOLS
from safe.robot import STEPS

COMPONENTS = ("1 / distance", "novelty")  # what an objective function weighs in the paper
WEIGHABLE = (*COMPONENTS, "path rarity", "1 / way")  # what it may weigh
CLOSENESS, NOVELTY, PATH_RARITY, WAY = range(len(WEIGHABLE))
COEFFICIENTS = tuple(string.ascii_lowercase[: len(COMPONENTS)])  # the names of the components' coefficients: a, b


@dataclass(frozen=True)
class Algorithm:
    """Who judges the solutions.

    Parameters
    ----------
    name : str
        A label, without effect on the runs.
    objectives : sequence of (a, b), or None
        The coefficients of the objective functions of the first generation. None draws them uniformly from [0, 1],
        as many as `Parameters.objectives` says. With an empty sequence the algorithm is random search.
    rating : {"none", "genotypic novelty", "pearson", "spearman"}
        The fitness by which objective functions are bred in each generation. With "none" they never change. The last
        two are correlations, over the generation, of the scores that an objective function gives with minus the
        distance to the goal.
    scaling : {"raw", "maximum", "rank"}
        What is weighed: the components as they are, divided by the generation's largest, or their ranks from 0 to 1.
    judging : {"best score", "drawn judge", "favourite"}
        Who selects parents: the best of the scores that a solution gets from all objective functions; or for each
        tournament one objective function, drawn uniformly; or such a one takes the individual that it scores highest.
    kind : {"weights", "goal", "mixed"}
        Of objective functions: weighted sums of components (Equation 1); or goals, which are places in the maze, (a, b)
        in the unit square, and score a solution by how near to it the robot ends; or as many of these as of those.
    components : sequence of str
        What objective functions weigh, of "1 / distance", "novelty", "path rarity" (see `safe.paths`) and "1 / way",
        the shortest way from the end point to the goal; an objective function has a coefficient for each.
    pool : {"generation", "repertoire"}
        From which parents are taken. With the repertoire (see `safe.repertoire`), nobody or goals must choose.

    Raises
    ------
    ValueError
        If an objective function does not have one finite coefficient for each component, if a choice is unknown or
        does not go with another, or if objective functions that evolve are odd in number.

    Examples
    --------
    >>> Algorithm("mostly novelty", objectives=[(0.1, 0.9)]).objectives
    ((0.1, 0.9),)
    """

    name: str
    objectives: Sequence[Sequence[float]] | None = None
    rating: str = "none"
    scaling: str = "raw"
    judging: str = "best score"
    kind: str = "weights"
    components: Sequence[str] = COMPONENTS
    pool: str = "generation"

    def __post_init__(self) -> None:
        checks.text("name", self.name)
        for field, choices in (
            ("rating", RATINGS),
            ("scaling", SCALINGS),
            ("judging", JUDGINGS),
            ("kind", KINDS),
            ("pool", POOLS),
        ):
            checks.choice(field, getattr(self, field), choices)
        object.__setattr__(self, "components", checks.choices("components", self.components, WEIGHABLE))
        if self.objectives is not None:
            self._check_objectives()
        self._check_together()

    def _check_objectives(self) -> None:
        bounds = () if self.kind == "weights" else (0, 1)
        coefficients = checks.array("objectives", self.objectives, (None, self.genes), *bounds, or_empty=True)
        object.__setattr__(self, "objectives", tuple(map(tuple, coefficients.tolist())))
        if self.rating != "none" and (len(coefficients) == 0 or len(coefficients) % 2):
            raise ValueError(f"objectives must be even in number if they evolve; got {len(coefficients)}")
        if self.kind == "mixed" and len(coefficients) % 2:
            raise ValueError(f"objectives must be even in number if they are mixed; got {len(coefficients)}")

    def _check_together(self) -> None:
        """Check that the choices go together."""

        def check(field: str, allowed: Sequence[object], reason: str) -> None:
            if getattr(self, field) not in allowed:
                *others, last = map(repr, allowed)
                words = f"{', '.join(others)} or {last}" if others else last
                raise ValueError(f"{field} must be {words} {reason}; got {getattr(self, field)!r}")

        if self.objectives == ():
            check("kind", ("weights",), "without objective functions")
            if self.pool == "repertoire":
                check("judging", ("best score",), "without objective functions")
            return
        if self.kind == "goal":
            check("scaling", ("raw",), "for goals, which weigh nothing")
            check("components", (COMPONENTS,), "for goals, which weigh nothing")
        if self.kind == "mixed":
            check("rating", ("none", "redrawn"), "for a mixture with goals")
        if self.rating == "patience":
            check("kind", ("goal",), "for a rating by patience")
        if self.pool == "repertoire":
            check("kind", ("goal", "mixed"), "to choose from the repertoire")
            judgings = ("drawn judge", "favourite") if self.kind == "goal" else ("favourite",)
            check("judging", judgings, "to choose from the repertoire")

    @property
    def genes(self) -> int:
        """How many numbers an objective function consists of: coefficients, or the two of a place."""
        weights = len(self.components)
        return {"weights": weights, "goal": 2, "mixed": max(2, weights)}[self.kind]

    def first_goal(self, number: int) -> int:
        """From which one on so many objective functions are goals; `number` if none is.

        Examples
        --------
        >>> Algorithm("both", kind="mixed").first_goal(200)
        100
        """
        return {"weights": number, "goal": 0, "mixed": number // 2}[self.kind]

    @property
    def content(self) -> dict:
        """What the algorithm does, whatever its name, by field; choices only if they depart from the paper's.

        Examples
        --------
        >>> Algorithm("mine", rating="pearson", judging="drawn judge").content
        {'objectives': None, 'rating': 'pearson', 'judging': 'drawn judge'}
        """
        names = "scaling", "judging", "kind", "components", "pool"
        return {"objectives": self.objectives, "rating": self.rating, **_departures(self, names)}

    @property
    def is_random_search(self) -> bool:
        """Is there nobody to judge and nothing to remember, so that every generation is drawn at random?"""
        return self.objectives == () and self.pool == "generation"


def _departures(chosen: Algorithm | Parameters, names: Iterable[str]) -> dict[str, object]:
    """The fields among these names whose values differ from the defaults, which are attributes of the class."""
    return {name: value for name in names if (value := getattr(chosen, name)) != getattr(type(chosen), name)}


ALGORITHMS = {
    algorithm.name: algorithm
    for algorithm in (
        Algorithm("standard", objectives=[(1, 0)]),
        Algorithm("novelty", objectives=[(0, 1)]),
        Algorithm("safe", objectives=None, rating="genotypic novelty"),
        Algorithm("fixed", objectives=[(0.5, 0.5)]),
        Algorithm("random", objectives=[]),
        # beyond the paper: what the book ends with as its best
        Algorithm(
            "weighing-and-goals",
            rating="redrawn",
            scaling="rank",
            judging="favourite",
            kind="mixed",
            components=("1 / distance", "novelty", "path rarity"),
            pool="repertoire",
        ),
    )
}


def get_algorithm(name: str | Algorithm) -> Algorithm:
    """An algorithm by its name in ALGORITHMS; an Algorithm is returned as it is."""
    return name if isinstance(name, Algorithm) else ALGORITHMS[checks.choice("algorithm", name, ALGORITHMS)]


@dataclass(frozen=True)
class Parameters:
    """The paper's Table 1, and the choices beyond it.

    Raises
    ------
    ValueError
        If a size, count or rate is out of range, or a choice unknown. Offspring come in pairs, so a population and
        its elites must be even in number.

    Examples
    --------
    >>> Parameters().evaluations
    100000
    >>> Parameters(population=51)
    Traceback (most recent call last):
        ...
    ValueError: population must be an even number; got 51
    """

    population: int = 200  # solutions in a generation
    objectives: int = 200  # objective functions in a generation, if they are drawn
    generations: int = 500  # at most
    tournament: int = 5  # individuals drawn for a tournament
    elites: int = 2  # fittest individuals that pass on unchanged
    crossover: float = 0.8  # probability, for a pair of parents
    mutation: float = 0.4  # probability, for an offspring
    k: int = K  # nearest neighbours that count towards novelty
    archive: int = ARCHIVE_CAPACITY  # places in each of the two novelty archives
    steps: int = STEPS  # that a robot takes
    success_distance: int = 2  # cells, taxicab: an end point this near to the goal is a success
    # beyond the paper:
    admission: str = "lowest replaced"  # what enters the archive of end points; see `safe.novelty`
    admitted: int = 5  # solutions that enter it in each generation, with "random"
    threshold: float = 6.0  # novelty above which they enter it at first, with "threshold"; Lehman and Stanley's
    patience: int = 10  # generations without getting nearer to a goal, after which it is given up, with "patience"

    def __post_init__(self) -> None:
        lowest = {"elites": 0, "archive": 0, "success_distance": 0}
        highest = {"crossover": 1, "mutation": 1}
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type == "str":
                value = checks.choice(field.name, value, ADMISSIONS)
            elif field.type == "float":
                value = checks.number(field.name, value, 0, highest.get(field.name, checks.MOST))
            else:
                value = checks.integer(field.name, value, lowest.get(field.name, 1), checks.MOST)
            object.__setattr__(self, field.name, value)
        for name in ("population", "objectives", "elites"):
            if getattr(self, name) % 2:
                raise ValueError(f"{name} must be an even number; got {getattr(self, name)}")
        if self.elites >= min(self.population, self.objectives):
            raise ValueError(
                f"elites must be fewer than the {self.population} solutions and "
                f"{self.objectives} objective functions; got {self.elites}"
            )

    @property
    def departures(self) -> dict[str, int | float | str]:
        """The parameters that differ from the paper's, by name.

        Examples
        --------
        >>> Parameters(population=50, mutation=0.1).departures
        {'population': 50, 'mutation': 0.1}
        """
        return _departures(self, [field.name for field in fields(self)])

    @property
    def evaluations(self) -> int:
        """The most solutions that a run evaluates; random search evaluates exactly this many."""
        return self.population * self.generations
