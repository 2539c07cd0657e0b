"""The whole pipeline, on a copy of the checkout: notebooks executed at a few runs, the book built from them."""

import csv
import importlib
import json
import re
import shutil
import sys
from html.parser import HTMLParser

import nbformat
import pandas as pd
import pytest

import safe
from tests.helpers.checkout import ROOT, RUNS, build, execute, locked, output_of


@pytest.fixture
def pages(checkout):
    html = checkout / "_build" / "html"
    found = sorted(page for page in html.rglob("*.html") if "_static" not in page.parts)
    return {page.relative_to(html).as_posix(): page.read_text() for page in found}


def test_every_chapter_is_a_page(checkout, pages):
    chapters = re.findall(r"(?:root|file): (.+)", (checkout / "book" / "_toc.yml").read_text())
    assert len(chapters) > len(list((checkout / "notebooks").glob("*.ipynb")))
    assert {f"{chapter}.html" for chapter in chapters} <= set(pages)


def test_the_page_at_the_top_leads_to_the_book(pages):
    assert 'content="0; url=book/index.html"' in pages["index.html"]
    assert 'href="_static/favicon.svg"' in pages["index.html"]


def test_every_notebook_is_a_chapter(checkout):
    contents = (checkout / "book" / "_toc.yml").read_text()
    for notebook in (checkout / "notebooks").glob("*.ipynb"):
        assert f"notebooks/{notebook.stem}" in contents


def outputs(checkout, name):
    copy = json.loads((checkout / "executed" / f"{name}.ipynb").read_text())
    return [(cell, output) for cell in copy["cells"] for output in cell.get("outputs", [])]


def test_every_figure_that_was_computed_is_shown(checkout, pages):
    count = 0
    for notebook in (checkout / "notebooks").glob("*.ipynb"):
        drawn = sum("image/svg+xml" in output.get("data", {}) for _, output in outputs(checkout, notebook.stem))
        images = re.findall(r'<img [^>]*src="../_images/[0-9a-f]+.svg"', pages[f"notebooks/{notebook.stem}.html"])
        shown = [image for image in images if 'alt=""' not in image]  # the others are its panels, for narrow pages
        assert len(shown) == drawn, notebook.stem
        count += drawn
    assert count > 10


class Tables(HTMLParser):
    """The captions and cells of the tables of a page."""

    def __init__(self, page):
        super().__init__()
        self.found, self.inside = [], None
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        if tag == "table":
            self.found.append({"id": dict(attributes).get("id"), "caption": "", "rows": []})
        elif tag == "tr":
            self.found[-1]["rows"].append([])
        elif tag in ("th", "td"):
            self.found[-1]["rows"][-1].append("")
        is_mark = tag == "a" and self.inside == "caption"
        self.inside = tag if tag in ("caption", "th", "td") else None if is_mark else self.inside

    def handle_endtag(self, tag):
        self.inside = None if tag in ("caption", "th", "td") else self.inside

    def handle_data(self, data):
        if self.inside == "caption":
            self.found[-1]["caption"] += data
        elif self.inside:
            self.found[-1]["rows"][-1][-1] += data


def test_every_table_that_was_computed_is_shown_with_number_and_caption_and_can_be_downloaded(checkout, pages):
    html = checkout / "_build" / "html"
    count = 0
    for notebook in (checkout / "notebooks").glob("*.ipynb"):
        page = pages[f"notebooks/{notebook.stem}.html"]
        shown = {table["id"]: table for table in Tables(page).found}
        for cell, output in outputs(checkout, notebook.stem):
            if "text/csv" not in output.get("data", {}):
                continue
            settings = cell["metadata"]["table"]
            expected = list(csv.reader("".join(output["data"]["text/csv"]).splitlines()))
            table = shown[settings["name"]]
            number, caption = re.fullmatch(r"Table ([0-9.]+) (.*)", table["caption"]).groups()
            assert caption.replace("’", "'") == settings["caption"], number
            columns = len(expected[0])  # one more may hold links (see test_links.py)
            rows = [[cell.strip().replace("’", "'") for cell in row[:columns]] for row in table["rows"]]
            assert rows == expected, settings["name"]
            (link,) = re.findall(rf'href="../(_downloads/[^"]*/{settings["name"]}.csv)"', page)
            assert list(csv.reader((html / link).read_text().splitlines())) == expected
            count += 1
    assert count > 15


def test_every_table_has_a_number_and_a_caption(pages):
    for name, page in pages.items():
        if name.startswith(("book/", "notebooks/")) and name != "book/worksheet.html":  # whose tables are forms
            for table in Tables(page).found:
                assert re.match(r"Table [0-9.]+ \w", table["caption"]), (name, table)


def test_no_page_names_a_folder_of_the_machine_that_built_it(checkout, pages):
    """Regression: the reference showed the default of a parameter, a path."""
    folders = str(checkout), str(ROOT)
    assert [name for name, page in pages.items() if any(folder in page for folder in folders)] == []


def test_numbers_in_prose_are_those_of_the_table(checkout, pages):
    (numbers,) = [
        output["data"]["application/json"]
        for _, output in outputs(checkout, "table2-success")
        if "successes_maze1_safe" in output.get("data", {}).get("application/json", {})
    ]
    prose = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", pages["book/index.html"]))
    found = [f"{numbers[f'successes_maze1_{name}']:.0f}" for name in ("safe", "novelty", "standard")]
    assert f"Here it is {', '.join(found)} and {numbers['successes_maze2_safe']:.0f} of {RUNS}" in prose
    assert "SAFE finds the goal of maze1 in 328 of 500 runs, about as often as novelty search (322)" in prose


def test_no_number_of_the_prose_is_missing(pages):
    for name, page in pages.items():
        assert "{{" not in re.sub(r"<(script|pre).*?</\1>", "", page, flags=re.DOTALL), name


def test_no_page_shows_the_cell_that_installs_the_package(pages):
    for name, page in pages.items():
        if name.startswith("notebooks/"):
            assert "import_module" not in page, name


def test_every_page_has_a_title_and_a_description(pages):
    titles = set()
    for name, page in pages.items():
        title = re.search(r"<title>\s*(.*?)\s*</title>", page, re.DOTALL).group(1)
        assert title not in titles, name
        titles.add(title)
        if name.startswith(("book/", "notebooks/")):
            assert re.search(r'<meta name="description" content="[^"]{40,}"', page), name
            assert re.search(r'<meta property="og:title" content="[^"]+"', page), name


def test_without_an_address_of_the_repository_no_page_links_to_one(pages):
    for name, page in pages.items():
        assert not re.search("mybinder|colab|/edit/", page), name


DOCUTILS = "[general]\nsmart_quotes: no\nlanguage_code: de\n[parsers]\nraw_enabled: no\n"


@pytest.fixture(scope="module")
def with_address(checkout, tmp_path_factory):
    """The pages of a book with an address, built by somebody whose settings would break or change any other build."""
    folder, home = tmp_path_factory.mktemp("another") / "with address", tmp_path_factory.mktemp("home")
    with locked(checkout):
        shutil.copytree(checkout, folder, ignore=shutil.ignore_patterns("_build"))
    config = folder / "_config.yml"
    config.write_text(config.read_text().replace('url: ""', 'url: "https://github.com/someone/something"'))
    for file in (folder / "docutils.conf", home / ".docutils"):
        file.write_text(DOCUTILS)
    (home / "theme.py").write_text("raise SystemExit('not the theme of the book')")
    settings = {"PYTHONWARNINGS": "error", "PYTHONOPTIMIZE": "2", "MPLBACKEND": "nonsense"}
    built = build(folder, HOME=str(home), PYTHONPATH=str(home), **settings)
    assert built.returncode == 0, output_of(built)
    return folder / "_build" / "html"


def test_the_users_settings_do_not_reach_a_page(with_address, pages):
    for name, page in pages.items():
        if name.startswith(("book/", "notebooks/")):
            article, another = (
                re.search("<article.*</article>", text, re.DOTALL).group()
                for text in (page, (with_address / name).read_text())
            )
            assert article == another, name


def test_with_an_address_there_are_buttons(with_address):
    notebook, page = ((with_address / name).read_text() for name in ("notebooks/ledger.html", "book/safe.html"))
    assert "https://mybinder.org/v2/gh/someone/something/main?urlpath=tree/notebooks/ledger.ipynb" in notebook
    assert "https://colab.research.google.com/github/someone/something/blob/main/notebooks/ledger.ipynb" in notebook
    assert "https://github.com/someone/something/edit/main/book/safe.md" in page
    assert "mybinder" not in page


class Loads(HTMLParser):
    """The addresses from which a page loads something."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag in ("script", "img", "iframe", "source"):
            self.found.append(attributes.get("src"))
        elif tag == "link" and attributes.get("rel") != "canonical":
            self.found.append(attributes.get("href"))


def test_no_page_loads_anything_from_elsewhere(pages):
    for name, page in pages.items():
        addresses = [address for address in Loads(page).found if address]
        assert addresses or name == "index.html"
        assert [address for address in addresses if re.match(r"(https?:)?//", address)] == [], name


def test_figures_have_a_caption_a_number_and_a_text(pages):
    for name, page in pages.items():
        whole = re.sub(r'<span class="cut".*?</span>', "", page, flags=re.DOTALL)
        for image in re.findall(r"<img [^>]*_images/[^>]*>", whole):
            assert re.search(r'alt="[^"]{20,}"', image), (name, image)
        for panels in re.findall(r'<div class="panels"[^>]*>', page):
            assert re.search(r'aria-label="[^"]{20,}"', panels), (name, panels)
        figures = re.findall(r"<figure.*?</figure>", page, re.DOTALL)
        for figure in figures:
            assert "caption-number" in figure, name


def test_no_script_on_a_page_names_an_address_elsewhere(pages):
    for name, page in pages.items():
        for script in re.findall(r"<script.*?</script>", page, re.DOTALL):
            assert "://" not in script, name


def test_the_download_is_the_clean_notebook(checkout):
    for notebook in (checkout / "notebooks").glob("*.ipynb"):
        assert (checkout / "_build/html/_sources/notebooks" / notebook.name).read_bytes() == notebook.read_bytes()


@pytest.mark.usefixtures("alone_in_checkout")
def test_what_is_up_to_date_is_not_executed_again(checkout):
    again = execute(checkout)
    assert again.stdout.count("up to date") == len(list((checkout / "notebooks").glob("*.ipynb")))


@pytest.fixture
def book_of(monkeypatch):
    """A module of book/, in this process, at work in a checkout."""
    monkeypatch.syspath_prepend(ROOT / "book")

    def book_of(checkout, name):
        executed = importlib.import_module("executed")
        for constant in ("NOTEBOOKS", "EXECUTED"):
            monkeypatch.setattr(executed, constant, checkout / getattr(executed, constant).relative_to(executed.ROOT))
        monkeypatch.setattr(executed, "ROOT", checkout)
        return importlib.import_module(name)

    return book_of


@pytest.mark.usefixtures("alone_in_checkout")
@pytest.mark.parametrize("change", ["notebook", "package", "record", "measurements", "parameters", "missing"])
def test_stale_copies_are_recognised(checkout, book_of, change):
    what_is_wrong = book_of(checkout, "executed").what_is_wrong
    notebook = checkout / "notebooks" / "table2-success.ipynb"
    requested = {"runs": int(RUNS)}
    assert what_is_wrong(notebook, requested) is None
    copy, module = checkout / "executed" / notebook.name, checkout / "safe" / "robot.py"
    measurements, record = (
        checkout / "benchmarks" / "results.json",
        checkout / "safe/companion/record/designs/runs.csv.xz",
    )
    before = {file: file.read_bytes() for file in (notebook, copy, module, measurements, record)}
    if change == "notebook":
        notebook.write_bytes(before[notebook].replace(b"Who finds the goal", b"Who ever finds the goal"))
    elif change == "package":
        module.write_bytes(before[module] + b"# changed\n")
    elif change == "record":
        record.write_bytes(b"changed")
    elif change == "measurements":
        measurements.write_bytes(before[measurements] + b"\n")
    elif change == "parameters":
        requested = {"runs": 5}
    else:
        copy.unlink()
    try:
        fault = what_is_wrong(notebook, requested)
    finally:
        for file, content in before.items():
            file.write_bytes(content)
    changed = "package" if change == "record" else change
    expected = "was not executed" if change == "missing" else f"was executed before the {changed} changed"
    assert fault == expected


@pytest.mark.usefixtures("alone_in_checkout")
def test_a_copy_made_with_other_packages_is_stale(checkout, book_of, monkeypatch):
    executed = book_of(checkout, "executed")
    monkeypatch.setattr(executed.metadata, "version", lambda name: "99")
    fault = executed.what_is_wrong(checkout / "notebooks" / "table2-success.ipynb", {"runs": int(RUNS)})
    assert fault == "was executed before the packages changed"


@pytest.mark.usefixtures("alone_in_checkout")
def test_files_of_editors_and_systems_make_nothing_stale(checkout, book_of):
    strangers = [
        checkout / "safe" / name for name in (".DS_Store", "robot.py~", "#robot.py#", ".robot.py.swp", ".x.py")
    ]
    for file in strangers:
        file.write_text("not of this package")
    try:
        fault = book_of(checkout, "executed").what_is_wrong(
            checkout / "notebooks" / "table2-success.ipynb", {"runs": int(RUNS)}
        )
    finally:
        for file in strangers:
            file.unlink()
    assert fault is None


def svg_of(copy):
    """The figures of an executed notebook, without the time at which they were drawn."""
    shown = [output.get("data", {}) for cell in copy["cells"] for output in cell.get("outputs", [])]
    svg = ["".join(data["image/svg+xml"]) for data in shown if "image/svg+xml" in data]
    return [re.sub(r"<dc:date>.*?</dc:date>", "", text) for text in svg]


@pytest.mark.usefixtures("alone_in_checkout")
def test_the_users_settings_do_not_reach_a_notebook(checkout, tmp_path, monkeypatch):
    kernel, startup, style = (
        tmp_path / name for name in ("kernels/python3/kernel.json", "profile_default/startup/a.py", "matplotlibrc")
    )
    for file in (kernel, startup):
        file.parent.mkdir(parents=True)
    kernel.write_text('{"argv": ["false"], "display_name": "another", "language": "python"}')
    startup.write_text("raise SystemExit")
    style.write_text("font.size: 40")
    for name, value in {
        "MPLBACKEND": "nonsense",
        "MATPLOTLIBRC": style,
        "IPYTHONDIR": tmp_path,
        "JUPYTER_PATH": tmp_path,
        "PYTHONWARNINGS": "error",
    }.items():
        monkeypatch.setenv(name, str(value))
    copy = checkout / "executed" / "figure1-mazes.ipynb"
    before = copy.read_text()
    copy.unlink()
    try:
        made = execute(checkout, "figure1-mazes")
        assert made.returncode == 0, output_of(made)
        assert made.stdout.startswith(f"Python {sys.version.split()[0]} in {sys.prefix}\n")
        assert svg_of(json.loads(copy.read_text())) == svg_of(json.loads(before)) != []
    finally:
        copy.write_text(before)


@pytest.mark.parametrize(("notebook", "what"), [("figure1-mazes", "figure"), ("table2-success", "table")])
def test_a_cell_that_shows_nothing_is_a_failure(checkout, book_of, notebook, what):
    check_outputs = book_of(checkout, "execute").check_outputs
    copy = nbformat.read(checkout / "executed" / f"{notebook}.ipynb", as_version=4)
    check_outputs(copy)
    for cell in copy.cells:
        cell.outputs = []
    with pytest.raises(ValueError, match=f"cell .+ must show a {what}; got none"):
        check_outputs(copy)


@pytest.mark.usefixtures("alone_in_checkout")
def test_a_stale_copy_stops_the_build(checkout):
    refused = build(checkout, runs="5")
    assert refused.returncode != 0
    reason = "table2-success.ipynb was executed before the parameters changed"
    assert reason in re.sub(r"\s+", " ", output_of(refused))


@pytest.mark.parametrize(
    ("arguments", "runs", "complaint"),
    [
        (
            ["table2-success", "-p", "run", "5.5"],
            RUNS,
            "parameter must be one of cores, maze, runs, scheduler, seed, store; got run",
        ),
        (["table3"], RUNS, "notebook must be one of archive-costs, .*; got 'table3'"),
        ([], "many", "RUNS must be an integer of at least 1; got 'many'"),
        ([], "0", "RUNS must be an integer of at least 1; got '0'"),
    ],
)
def test_the_runner_refuses_what_it_does_not_know(checkout, book_of, monkeypatch, capsys, arguments, runs, complaint):
    monkeypatch.setenv("RUNS", runs)
    monkeypatch.setattr("sys.argv", ["book/execute.py", *arguments])
    with pytest.raises(SystemExit) as refused:
        book_of(checkout, "execute").main()
    assert refused.value.code != 0
    assert re.search(complaint, re.sub(r"\s+", " ", capsys.readouterr().err))


@pytest.mark.parametrize(
    ("sources", "said"),
    [
        (["same", "same", "same"], ""),
        (["other", "same", "unknown"], ", although 2 of them were made from other or unknown sources of the science"),
    ],
    ids=["same", "other"],
)
def test_runs_made_from_other_sources_are_counted(checkout, book_of, monkeypatch, capsys, tmp_path, sources, said):
    """Most often they were made before a change of the package: nothing has to be wrong with them."""
    experiment = safe.Experiment("novelty", "maze1", runs=3, parameters=safe.Parameters(generations=2))
    safe.run(experiment, tmp_path / "s.sqlite", progress=False)
    repeated = safe.verify(tmp_path / "s.sqlite", progress=False).assign(sources=sources)
    verify = book_of(checkout, "verify")
    monkeypatch.setattr("sys.argv", ["book/verify.py", str(tmp_path / "s.sqlite")])
    monkeypatch.setattr(verify.safe, "verify", lambda *_, **__: repeated)
    monkeypatch.setattr(verify.evidence, "verify", lambda: (5, 1))
    monkeypatch.setattr(verify.peers, "verify", lambda: 2)
    verify.main()
    line, recorded = capsys.readouterr().out.splitlines()
    assert line == f"3 stored runs, drawn at random, were repeated and gave the same results{said}"
    assert recorded == "7 recorded runs and 1 recorded trace, drawn at random, were repeated and gave the same results"


def test_evidence_that_is_not_reproduced_stops_the_build(checkout, book_of, monkeypatch):
    def refuse():
        raise ValueError("record must hold what its experiments make")

    verify = book_of(checkout, "verify")
    monkeypatch.setattr("sys.argv", ["book/verify.py"])
    monkeypatch.setattr(verify.safe, "verify", lambda *_, **__: pd.DataFrame({"sources": []}))
    monkeypatch.setattr(verify.evidence, "verify", refuse)
    with pytest.raises(SystemExit, match="the recorded evidence cannot be trusted: record must hold what its"):
        verify.main()


@pytest.mark.usefixtures("alone_in_checkout")
def test_a_failed_execution_leaves_the_copy_as_it_was(checkout):
    copy = checkout / "executed" / "figure1-mazes.ipynb"
    before = copy.read_bytes()
    failed = execute(checkout, "figure1-mazes", "-p", "maze", "maze3")
    assert failed.returncode != 0
    (complaint,) = failed.stderr.splitlines()
    assert complaint.startswith("[1/1] figure1-mazes: ValueError: maze must be one of 'hard', 'maze1', 'maze2', ")
    assert copy.read_bytes() == before
