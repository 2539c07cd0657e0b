"""The playground's page as tests see it: the views, short runs, and what the page says."""

import re
from decimal import ROUND_HALF_UP, Context

import safe
from tests.helpers.addresses import maze_of

FIGURES = {  # in chapters, by their pages; each with its view
    "robot": {"fig-readings": "drive", "fig-three-weights": "drive"},
    "objective": {"fig-pocket": "watch"},
    "novelty": {"fig-crowded": "watch", "fig-memory": "watch"},
    "safe": {"fig-coefficients-over-time": "watch", "fig-scales": "watch"},
    "experiments": {"fig-how-many": "runs"},
}
VIEWS = {"watch": "Watch", "drive": "Drive", "draw": "Draw", "runs": "Many runs", "challenges": "Challenges"}
QUICK = "population=20&objectives=20&generations=30"
QUICK_PARAMETERS = safe.Parameters(population=20, objectives=20, generations=30)


def panel(page, title):
    """The line in which the page says how far an algorithm has come."""
    return page.get_by_role("region", name=title).locator(".status")


def play_to_the_end(page, *titles):
    page.get_by_label("Speed").fill("6")
    page.get_by_role("button", name="Play").click()
    for title in titles:
        panel(page, title).get_by_text(re.compile("uccess")).wait_for()
    page.get_by_role("button", name="Play").wait_for()


WORDS = {"1 / distance": "closeness", "1 / way": "closeness on the way"}  # for components, if not their own


def short(value):
    """A number to three digits, and halves upwards, as in JavaScript."""
    return f"{float(Context(prec=3, rounding=ROUND_HALF_UP).create_decimal_from_float(float(value))):g}"


def place_of(goal, shape=(100, 100)):
    """The cell that a goal names in a maze of this shape."""
    return tuple(min(int(gene * side), side - 1) for gene, side in zip(goal, shape, strict=True))


def status_of(run, algorithm="safe"):
    """What the page says of a run that is over."""
    algorithm = safe.algorithms.get_algorithm(algorithm)
    cells = "1 cell" if run.distance == 1 else f"{run.distance} cells"
    outcome, fitness = "Success" if run.success else "No success", ""
    if run.coefficients or algorithm.pool == "repertoire":
        outcome += f" in generation {run.generation}" if run.success else f" in {run.generation + 1} generations"
    if algorithm.kind == "goal":
        fitness = f" Its fitness: how near it came to the place {place_of(run.coefficients)}."
    elif run.coefficients:
        pairs = zip(run.coefficients, algorithm.components, strict=True)
        fitness = f" Its fitness: {' + '.join(f'{short(c)} · {WORDS.get(name, name)}' for c, name in pairs)}."
    return f"{outcome}: best {cells} from the goal, after {run.evaluations} robots.{fitness}"


def look_at(page, robot):
    """Select a robot of the generation by its number."""
    page.get_by_label("Robot", exact=True).fill(str(robot))
    page.keyboard.press("Enter")
    page.get_by_text(f"Robot {robot} ended at").wait_for()


def address_of(page):
    """The keys and values of the address, once the page has written its state there."""
    page.evaluate("new Promise((done) => setTimeout(done, 250))")  # started after the page's own timer
    fragment = page.evaluate("decodeURIComponent(location.hash.slice(1))")
    return [tuple(part.split("=", 1)) for part in fragment.split("&")]


def driven(page):
    """The controller in the address of the page, which drives."""
    return [float(weight) for weight in dict(address_of(page))["controller"].split(",")]


def maze_at(page):
    """The maze in the address of the page, which draws."""
    return maze_of(dict(address_of(page))["maze"])


def wait_for_view(page, view):
    """Wait until a view is complete."""
    page.get_by_role("tab", name=VIEWS[view], selected=True).wait_for()
    shown = {
        "watch": "Generation",
        "drive": "After 300 steps",
        "draw": "The goal can be reached",
        "runs": "Runs so far",
        "challenges": "Solved:",
    }
    page.get_by_role("tabpanel").get_by_text(shown[view]).locator("visible=true").first.wait_for()
