"""Figures whose parts lead to the playground.

A notebook shows such a figure by `safe.companion.notebook.show_figure`, and the links travel beside its image, as
metadata of the output. On the page each is an area over its part of the image. Print has the image alone.
"""

from __future__ import annotations

import html
import json

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.typing import ExtensionMetadata

from executed import EXECUTED
from playground import PAGE as PLAYGROUND


class FigureLinks(SphinxTransform):
    """Keep the links of every cell that has some, for `LinkedFigures`."""

    default_priority = 400

    def apply(self, **kwargs: object) -> None:
        copy = EXECUTED / f"{self.env.docname.rsplit('/', 1)[-1]}.ipynb"
        cells = [c for c in self.document.findall(nodes.container) if c.get("nb_element") == "cell_code"]
        if not cells or not copy.exists():
            return
        executed = json.loads(copy.read_text(encoding="utf-8"))["cells"]
        for cell in cells:
            for output in executed[cell["cell_index"]]["outputs"]:
                links = output.get("metadata", {}).get("image/svg+xml", {}).get("links")
                if links:
                    cell["figure_links"] = links


class LinkedFigures(SphinxPostTransform):
    """On the page the image gets an area for each link."""

    default_priority = 700
    formats = ("html",)

    def run(self, **kwargs: object) -> None:
        playground = self.app.builder.get_relative_uri(self.env.docname, PLAYGROUND)
        for cell in self.document.findall(lambda node: isinstance(node, nodes.container) and "figure_links" in node):
            (image,) = cell.findall(nodes.image)
            areas = "".join(
                f'<a href="{html.escape(f"{playground}#{address}")}" title="{html.escape(text)}" style="left: {left}%; '
                f'top: {top}%; width: {width}%; height: {height}%"></a>'
                for text, address, left, top, width, height in cell["figure_links"]
            )
            linked = nodes.container("", image.deepcopy(), nodes.raw("", areas, format="html"), classes=["linked"])
            image.replace_self(linked)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.add_transform(FigureLinks)
    app.add_post_transform(LinkedFigures)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
