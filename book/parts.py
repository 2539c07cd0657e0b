"""The parts of the table of contents in a PDF, where Sphinx would leave them out; all is numbered as on the pages."""

from __future__ import annotations

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform
from sphinx.util.texescape import escape
from sphinx.util.typing import ExtensionMetadata

NUMBERED = r"\setcounter{secnumdepth}{0}"  # chapters, not sections
UNNUMBERED = r"\setcounter{secnumdepth}{-1}\setcounter{chapter}{0}\setcounter{table}{0}"


class Parts(SphinxTransform):
    default_priority = 450  # after the table of contents is there

    def apply(self, **kwargs: object) -> None:
        for toctree in list(self.document.findall(addnodes.toctree)):
            if toctree.get("caption"):
                numbering = NUMBERED if toctree["numbered"] else UNNUMBERED
                part = nodes.raw("", rf"{numbering}\part{{{escape(toctree['caption'])}}}", format="latex")
                toctree.parent.insert(toctree.parent.index(toctree), part)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.add_transform(Parts)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
