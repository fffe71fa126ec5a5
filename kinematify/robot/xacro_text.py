"""xacro as URDF text, without ROS: by the package xacro, whose expressions may call nothing but what it offers."""

from __future__ import annotations

import ast
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.mesh_paths import declared_name, find_mesh, mesh_candidates
from kinematify.robot.urdf_text import parse_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

_INNER = frozenset(
    f"{kind}_{what}" for kind in ("gi", "cr", "ag", "tb", "f") for what in
    ("frame", "code", "back", "globals", "locals", "builtins", "await", "yieldfrom", "trace", "next")
) | {"format", "format_map", "mro"}  # fmt: skip
"""Attributes that lead from a value to the interpreter."""


def expand_xacro(path: Path, package_dirs: Sequence[Path], arguments: Mapping[str, str]) -> str:
    """Return the URDF that a xacro makes.

    Args:
        path: The file.
        package_dirs: Where ``$(find NAME)`` looks beside the folders above the file and the environment.
        arguments: Values of its ``<xacro:arg>``.

    Raises:
        DescriptionError: xacro does not expand it; the message is xacro's.
    """
    import xacro  # noqa: PLC0415 - for such files only
    from xacro import substitution_args  # noqa: PLC0415

    safe_eval = xacro.safe_eval

    def checked_eval(text: str, names: Any, local: Any = None) -> Any:
        _check_expression(text)
        return safe_eval(text, names, local)

    def evaluated(text: str, context: Any) -> str:
        functions = {"arg": lambda name: substitution_args.convert_value(context["arg"][name], "auto")}
        known = {key: value for key, value in substitution_args._eval_dict.items() if key != "__builtins__"}
        values = {key: substitution_args.convert_value(value, "auto") for key, value in context.get("arg", {}).items()}
        return str(checked_eval(text, {**known, **values, **functions}))

    def found(resolved: str, command: str, words: Sequence[str], _context: Any) -> str:
        tail = resolved.split(f"$({command})", 1)[1].split("$", 1)[0].strip("/")
        places = mesh_candidates(f"package://{words[0]}/{tail}", path.resolve().parent, package_dirs, "the xacro")
        there = (item for item in places if item.exists() and (tail or words[0] in (item.name, declared_name(item))))
        place = next(map(str, there), None)
        if place is None:
            raise substitution_args.SubstitutionException(
                f"no package {words[0]} with {tail or 'anything'}; name its folder with --package-dir"
            )
        return resolved.replace(f"$({command})", place[: len(place) - len(tail)].rstrip("/") if tail else place, 1)

    xacro.safe_eval, substitution_args._eval, substitution_args._find = checked_eval, evaluated, found
    try:
        text = str(xacro.process_file(str(path), mappings=dict(arguments)).toprettyxml(indent="  "))
    except Exception as error:  # of xacro, its parser, and whatever an expression raises
        said = " ".join(str(error).split()) or type(error).__name__
        raise DescriptionError(
            f"xacro does not expand {path}: {said[:600]}. Arguments are given as NAME:=VALUE."
        ) from error
    return _with_whole_paths(text, path.resolve().parent, package_dirs)


def _with_whole_paths(text: str, folder: Path, package_dirs: Sequence[Path]) -> str:
    """A URDF whose paths of files that are there hold from anywhere; many are meant from the folder above the xacro."""
    try:
        root = parse_text(text.encode())
    except etree.XMLSyntaxError:
        return text  # the reader of URDF says where
    for element in (*root.iter("mesh"), *root.iter("texture")):
        for place in (folder, folder.parent):
            with suppress(DescriptionError):  # a finding will say so
                element.set("filename", str(find_mesh(element.get("filename") or "", place, package_dirs, "the xacro")))
                break
    return etree.tostring(root, encoding="unicode")


def _check_expression(text: str) -> None:
    """Refuse what leads out of the values of an expression.

    Raises:
        DescriptionError: It does.
    """
    for node in ast.walk(ast.parse(text.strip(), mode="eval")):
        name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
        if name.startswith("__") or name in _INNER:
            raise DescriptionError(f"the expression {text.strip()!r} uses {name}, which is not allowed")
