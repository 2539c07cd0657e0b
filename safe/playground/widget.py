"""The book's playground as a Jupyter widget: draw a maze, drive a robot, watch a run, and go on in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, fields

try:
    import anywidget
except ImportError as error:
    raise ImportError("safe.Playground needs anywidget: pip install anywidget") from error
import numpy as np
import traitlets
from IPython.core.pylabtools import print_figure
from matplotlib import pyplot as plt

from safe import checks
from safe.evolution import Generation, Run, Seed
from safe.maze import Maze
from safe.maze_files import load_maze, packaged_mazes, parse_maze
from safe.playground import bundle
from safe.playground.address import read_seed, seed_text
from safe.results import figures
from safe.robot import WEIGHTS, path


class _Shared(traitlets.TraitType):
    """A trait that the kernel and the page share.

    `check` returns the value to keep, or raises a ValueError; `to_page` and `from_page` translate.
    """

    def __init__(self, default: object, check: Callable, to_page: Callable, from_page: Callable) -> None:
        super().__init__(default)
        self.check = check
        self.tag(sync=True, to_json=lambda value, _: to_page(value), from_json=lambda value, _: from_page(value))

    def validate(self, obj: traitlets.HasTraits, value: object) -> object:
        return self.check(value)


def _check_maze(value: object) -> Maze:
    is_text = isinstance(value, str) and "\n" in value
    return parse_maze(value, name="drawing") if is_text else load_maze(value)


def _read_maze(drawing: object) -> Maze:
    """The maze of a drawing; a packaged maze has its name again."""
    maze = Maze.from_drawing(drawing)
    return next((packaged for packaged in packaged_mazes().values() if packaged == maze), maze)


def _check_controller(value: object) -> tuple[float, ...]:
    return tuple(checks.array("controller", value, (WEIGHTS,), -1, 1).tolist())


def _check_run(value: object) -> Run | None:
    if value is not None and not isinstance(value, Run):
        raise ValueError(f"result must be a safe.Run or None; got {checks.shown(value)}")
    return value.run if isinstance(value, Generation) else value


def _read_run(value: object) -> Run | None:
    if value is None:
        return None
    names = {field.name for field in fields(Run)}
    if not isinstance(value, Mapping) or value.keys() != names or not isinstance(value["success"], bool):
        raise ValueError(f"result must be a run, given by {', '.join(sorted(names))}; got {checks.shown(value)}")
    return Run(
        success=value["success"],
        generation=checks.integer("generation", value["generation"], 0),
        distance=checks.integer("distance", value["distance"], 0),
        controller=_check_controller(value["controller"]),
        coefficients=tuple(checks.array("coefficients", value["coefficients"], (None,), or_empty=True).tolist()),
        evaluations=checks.integer("evaluations", value["evaluations"], 1),
    )


class Playground(anywidget.AnyWidget):
    """The playground in a notebook.

    The parameters below are attributes, as is `result`, the outcome of the last run (a Run, or None before the first).
    They follow what the user does in the playground, and setting one of them updates the playground. Setting a result
    also sets the controller. `observe` calls a function whenever one of them changes.

    Parameters
    ----------
    maze : Maze or str
        The maze, its name, the path of its file, or a drawing of two rows or more; read as a Maze.
    controller : array of float, shape (16,), optional
        The weights p_1..p_16, each in [-1, 1], of the robot that is driven; all 0 by default, read as a tuple.
    seed : int, sequence of int, or numpy.random.SeedSequence
        The seed of the runs' random numbers, as in `safe.evolve`.

    Raises
    ------
    AttributeError
        From `safe.Playground` itself, if anywidget is not installed.
    ValueError
        If a maze, controller, seed or result is not valid.

    Examples
    --------
    >>> import safe
    >>> playground = safe.Playground("maze2", seed=3)
    >>> playground.maze = '''
    ...     #####
    ...     #S.G#
    ...     #####'''
    >>> playground.result = safe.evolve(playground.maze, "safe", playground.seed)
    >>> safe.path(playground.maze, playground.controller)[-1]
    array([1, 3])
    """

    _esm = (
        bundle.script(("widget.js", "worker.js"))
        + "const { renderWidget, makeWorker } = playground();\n"
        + "export default { render: ({ model, el }) => renderWidget(model, el, makeWorker) };\n"
    )
    _css = bundle.stylesheet()

    maze = _Shared("maze1", _check_maze, Maze.drawing, _read_maze)
    controller = _Shared((0,) * WEIGHTS, _check_controller, list, _check_controller)
    seed = _Shared(0, lambda seed: read_seed(seed_text(seed)), seed_text, read_seed)
    result = _Shared(None, _check_run, lambda run: run and asdict(run), _read_run)

    def __init__(self, maze: Maze | str = "maze1", controller: np.ndarray | None = None, seed: Seed = 0) -> None:
        super().__init__(maze=maze, controller=(0,) * WEIGHTS if controller is None else controller, seed=seed)

    @traitlets.observe("result")
    def _show_result(self, change: Mapping) -> None:
        if self.result is not None:
            self.controller = self.result.controller

    def _repr_mimebundle_(self, **kwargs: object) -> tuple[dict, dict]:
        """Add a picture of the maze and the robot's path, for pages without a kernel and for print."""
        data, metadata = super()._repr_mimebundle_(**kwargs)
        with plt.style.context(figures.STYLE):
            figure, _ = figures.plot_paths([[(self.maze, path(self.maze, self.controller), self.maze.name)]])
            data["image/svg+xml"] = print_figure(figure, "svg")
            data["application/pdf"] = print_figure(figure, "pdf", base64=True)
            plt.close(figure)
        return data, metadata
