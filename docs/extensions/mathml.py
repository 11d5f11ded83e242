"""Formulas as MathML, which browsers draw by themselves: neither a network nor LaTeX is needed."""

import re

from docutils.nodes import Element, SkipNode
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

TAG = re.compile(r"\s*\\tag\{([^}]+)\}")


def inline(translator: HTML5Translator, node: Element) -> None:
    """A formula within a line."""
    translator.body.append(tex2mathml(node.astext()))
    raise SkipNode


def block(translator: HTML5Translator, node: Element) -> None:
    r"""A formula on lines of its own, with the number that its `\tag` states."""
    tag = TAG.search(node.astext())
    formula = TAG.sub("", node.astext())
    translator.body.append(translator.starttag(node, "div", CLASS="formula"))
    translator.body.append(f'<div class="drawn">{tex2mathml(formula, as_block=True)}</div>')
    if tag:
        translator.body.append(f'<span class="number">({tag[1]})</span>')
    translator.body.append("</div>\n")
    raise SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
