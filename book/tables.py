"""Tables of results as tables of the book: captioned, numbered, and to be downloaded as CSV.

A cell of a notebook whose metadata holds `table: {name, caption, stub, class}` shows one table, which carries itself
along as CSV. Here that CSV becomes a table of the document, with as many columns of headings as `stub` says (1), and
with a class for its looks beside `results`. It can be referred to by its name, and is a table in print as well. Nothing
in it is read as markup.
"""

from __future__ import annotations

import csv
import json

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.transforms import SphinxTransform
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.typing import ExtensionMetadata

from executed import EXECUTED, ROOT

TABLES = EXECUTED / "tables"
WIDEST = 30  # characters of a column that count for its width in print


class ResultTables(SphinxTransform):
    default_priority = 400  # before labels are collected

    def apply(self, **kwargs: object) -> None:
        cells = [
            cell
            for cell in self.document.findall(nodes.container)
            if cell.get("nb_element") == "cell_code" and "table" in cell["cell_metadata"]
        ]
        if not cells:
            return
        copy = EXECUTED / f"{self.env.docname.rsplit('/', 1)[-1]}.ipynb"
        executed = json.loads(copy.read_text(encoding="utf-8"))["cells"]
        for cell in cells:
            (output,) = (part for part in cell.children if part.get("nb_element") == "cell_code_output")
            output.children = []
            settings = cell["cell_metadata"]["table"]
            shown = [
                o["data"]["text/csv"]
                for o in executed[cell["cell_index"]]["outputs"]
                if "text/csv" in o.get("data", {})
            ]
            if len(shown) != 1:
                raise ExtensionError(f"{copy.name} must show one table as {settings['name']}; showed {len(shown)}")
            output += self.table("".join(shown[0]), settings)

    def table(self, text: str, settings: dict) -> list[nodes.Node]:
        name, stub = settings["name"], settings.get("stub", 1)
        header, *rows = csv.reader(text.splitlines())
        group = nodes.tgroup(
            "",
            *(nodes.colspec(colwidth=1, stub=int(column < stub)) for column in range(len(header))),
            nodes.thead("", _row(header)),
            nodes.tbody("", *map(_row, rows)),
            cols=len(header),
        )
        table = nodes.table("", nodes.title("", settings["caption"]), group, names=[name])
        table["classes"] = ["results", *settings.get("class", "").split()]
        self.document.note_explicit_target(table)
        TABLES.mkdir(exist_ok=True)
        file = TABLES / f"{name}.csv"
        file.write_text(text, encoding="utf-8")
        link = addnodes.download_reference(
            "", nodes.Text("this table as CSV"), reftarget=f"/{file.relative_to(ROOT)}", refdoc=self.env.docname
        )
        return [table, nodes.paragraph("", "", link, classes=["results-download"])]


class PrintedTables(SphinxPostTransform):
    """In print a table breaks between pages, its columns are as wide as what they hold, and nothing is downloaded."""

    default_priority = 700
    formats = ("latex",)

    def run(self, **kwargs: object) -> None:
        for table in self.document.findall(nodes.table):
            if "results" in table["classes"]:
                table["classes"] += ["longtable", "colwidths-given"]
                lines = [[cell.astext() for cell in row.children] for row in table.findall(nodes.row)]
                for column, spec in enumerate(table.findall(nodes.colspec)):
                    spec["colwidth"] = 5 + min(max(len(line[column]) for line in lines), WIDEST)
        for paragraph in list(self.document.findall(nodes.paragraph)):
            if "results-download" in paragraph["classes"]:
                paragraph.parent.remove(paragraph)


def _row(texts: list[str]) -> nodes.row:
    return nodes.row("", *(nodes.entry("", nodes.paragraph("", text)) for text in texts))


def setup(app: Sphinx) -> ExtensionMetadata:
    app.add_transform(ResultTables)
    app.add_post_transform(PrintedTables)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
