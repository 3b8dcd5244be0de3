"""What a C or C++ header declares, with its comments: read by a parser of the language, nothing compiled.

The comments of the headers are written for whoever reads the header: an opening comment that explains the model, a
comment before a declaration, units and meanings behind the members. All of it is kept.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import tree_sitter_cpp
from tree_sitter import Language, Node, Parser

GUARDED = re.compile(r"^#ifdef __cplusplus$.*?^#endif$", flags=re.MULTILINE | re.DOTALL)
"""What a C header has for C++ alone: a linkage specification, opened and closed in two of these."""
ATTRIBUTE = re.compile(r"\s+HEXDBB_NOEXCEPT(?=;)")
"""Expands to `noexcept` in C++ and to nothing in C; no part of either language before the preprocessor."""
INTO = {"namespace_definition", "declaration_list", "linkage_specification", "preproc_ifdef", "preproc_if"}
FUNCTIONS = {"declaration", "field_declaration", "function_definition"}
TYPES = {"struct_specifier", "class_specifier", "enum_specifier"}
LANGUAGE = Language(tree_sitter_cpp.language())


@dataclass
class Declared:
    """One declaration.

    Attributes
    ----------
    kind
        `function`, `variable`, `alias`, `macro`, `struct`, `class`, `enum` or `enum-class`.
    signature
        As a domain of Sphinx takes it: without body, initializers of members and semicolon. Functions that stand under
        one comment are one declaration of several signatures.
    scope
        Namespace, as `hexdbb::port`; empty in C.
    comment
        The comment before it and the one behind it, markers removed; empty where there is none.
    text
        The declaration as it stands in the header.
    members
        Public members where there is a function among them; a type of data only is told by its text.
    """

    kind: str
    signature: list[str]
    scope: str
    comment: str
    text: str
    last_row: int
    members: list[Declared] = field(default_factory=list)


@dataclass(frozen=True)
class Header:
    """A header: its opening comment and what it declares, in order."""

    name: str
    opening: str
    declared: tuple[Declared, ...]


def read_header(path: Path) -> Header:
    """Parse a header.

    Raises
    ------
    ValueError
        The parser does not understand a line of it.
    """
    text = GUARDED.sub(lambda guarded: "\n" * guarded[0].count("\n"), path.read_text(encoding="utf-8"))
    text = ATTRIBUTE.sub("", text)
    tree = Parser(LANGUAGE).parse(text.encode())
    comments, _ = _leading_comments(tree.root_node)
    if fault := next(_faults(tree.root_node), None):
        raise ValueError(f"{path.name}:{fault.start_point.row + 1}: not understood: {_source(fault)[:40]!r}")
    return Header(path.name, comments, tuple(_declared(tree.root_node, "")))


def plain(comment: str) -> str:
    """Return the words of one or several comments without their markers."""
    lines = []
    for line in comment.splitlines():
        bare = re.sub(r"^\s*(?:///?|/\*+|\*(?!/))? ?", "", line)
        lines.append(re.sub(r"\s*\*/\s*$", "", bare).rstrip())
    return "\n".join(lines).strip("\n")


def _declared(parent: Node, scope: str) -> Iterator[Declared]:
    before: list[Node] = []
    found: list[Declared] = []
    public = parent.parent is None or parent.parent.type != "class_specifier"
    for node in parent.children:
        row = node.start_point.row
        if node.type == "access_specifier":
            public = _source(node) == "public"
        elif node.type == "comment":
            if found and found[-1].last_row == row:
                found[-1].comment = f"{found[-1].comment}\n{plain(_source(node))}".strip()
                found[-1].last_row = -1 if _is_alone(node) else row
            else:
                before = [*(each for each in before if _follows(each, before, node)), node]
        elif node.type in INTO:
            name = node.child_by_field_name("name") if node.type == "namespace_definition" else None
            inner = f"{scope}::{_source(name)}".removeprefix("::") if name else scope
            found.extend(_declared(node, inner))
            before = []
        elif public and (one := _declaration(node, scope, before)) is not None:
            previous = found[-1] if found else None
            if not one.comment and previous and previous.kind == one.kind == "function" and _adjoin(previous, node):
                previous.signature += one.signature
                previous.last_row = one.last_row
            else:
                found.append(one)
            before = []
        elif node.is_named:
            before = []
    yield from found


def _declaration(node: Node, scope: str, before: list[Node]) -> Declared | None:
    """Return what a node declares; None where it is of no use to a reader (forward declarations, guards, includes)."""
    near = before and before[-1].end_point.row >= node.start_point.row - 1
    comment = plain("\n".join(_source(each) for each in before)) if near else ""
    text = _dedented(node)
    kind, signature, members = "", "", []
    if node.type in TYPES or (node.type == "type_definition" and node.child_by_field_name("type") is not None):
        specifier = node if node.type in TYPES else node.child_by_field_name("type")
        assert specifier is not None
        body = specifier.child_by_field_name("body")
        name = specifier.child_by_field_name("name") or node.child_by_field_name("declarator")
        if body is None:
            kind, signature = ("alias", text.removesuffix(";")) if node.type == "type_definition" else ("", "")
        else:
            words = _source(specifier)[: body.start_byte - specifier.start_byte].split()
            kind = {"struct": "struct", "class": "class"}.get(words[0], "enum-class" if "class" in words else "enum")
            signature = _source(name) if name is not None else ""
            members = list(_declared(body, "")) if kind in ("struct", "class") else []
            if not any(each.kind == "function" for each in members):
                members = []
    elif node.type in FUNCTIONS or node.type == "template_declaration":
        kind, signature = _function_or_variable(node)
    elif node.type in ("alias_declaration", "type_definition"):
        kind, signature = "alias", re.sub(r"^(?:using|typedef) |;$", "", text)
    elif node.type in ("preproc_def", "preproc_function_def") and len(text.split(maxsplit=2)) == 3:
        kind, signature = "macro", text.split()[1]
        if signature.endswith("NOEXCEPT"):
            return None
    if not kind:
        return None
    return Declared(kind, [" ".join(signature.split())], scope, comment, text, _last_row(node), members)


def _function_or_variable(node: Node) -> tuple[str, str]:
    inner = next((each for each in node.children if each.type in FUNCTIONS), node)
    declarator = inner.child_by_field_name("declarator")
    while declarator is not None and declarator.type not in ("function_declarator", "init_declarator"):
        declarator = declarator.child_by_field_name("declarator") or next(
            (each for each in declarator.named_children if each.type.endswith("_declarator")), None
        )
    text = _source(node)
    is_function = declarator is not None and declarator.type == "function_declarator"
    if not is_function:
        return "variable", re.sub(r"^inline |;$", "", text)
    if re.search(r"=\s*(?:default|delete);?$", text):
        return "", ""
    ends = [each.start_byte for each in inner.children if each.type in ("field_initializer_list", "compound_statement")]
    text = text[: min(ends, default=node.end_byte) - node.start_byte] if ends else text
    return "function", re.sub(r"^inline |\s*(?:= 0)?;$", "", text.strip())


def _leading_comments(root: Node) -> tuple[str, int]:
    taken: list[Node] = []
    for node in root.children:
        if node.type != "comment" or (taken and taken[-1].end_point.row + 1 != node.start_point.row):
            break
        taken.append(node)
    return plain("\n".join(_source(each) for each in taken)), len(taken)


def _faults(node: Node) -> Iterator[Node]:
    """Yield what the parser skipped. What it misses (it knows no `{}` as a default argument) leaves the text whole."""
    if node.type == "ERROR":
        yield node
    for child in node.children:
        if child.has_error:
            yield from _faults(child)


def _follows(comment: Node, before: list[Node], node: Node) -> bool:
    return before[-1].end_point.row + 1 == node.start_point.row


def _adjoin(previous: Declared, node: Node) -> bool:
    return previous.last_row + 1 == node.start_point.row


def _is_alone(comment: Node) -> bool:
    return comment.start_point.column == 0


def _last_row(node: Node) -> int:
    """Return the row of the node's last character; a preprocessor line includes the line's end."""
    return node.end_point.row - (1 if node.end_point.column == 0 else 0)


def _dedented(node: Node) -> str:
    return textwrap.dedent(" " * node.start_point.column + _source(node)).strip()


def _source(node: Node) -> str:
    assert node.text is not None
    return node.text.decode()
