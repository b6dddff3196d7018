# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the one-directional rule: a layer may use itself and the layers before it, nothing else.

The C++ layers are checked through `#include "layer/file.h"`, the add-on's through its imports.
docs/architecture.md explains the two lists.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

NATIVE_LAYERS = (
    "base",
    "math",
    "image",
    "geometry",
    "bvh",
    "sampling",
    "shading",
    "bsdf",
    "light",
    "camera",
    "film",
    "scene",
    "io",
    "integrator",
    "render",
)
# In both tables: layers that share a rank may not use each other.
NATIVE_RANKS = {name: rank for rank, name in enumerate(NATIVE_LAYERS)}
NATIVE_TOP = len(NATIVE_LAYERS)

ADDON_RANKS = {
    "compat": 0,
    "properties": 1,
    "preferences": 1,
    "report": 2,
    "culprit": 2,
    "nodes": 3,
    "export": 4,
    "sync": 5,
    "engine": 6,
    "operators": 7,
    "ui": 7,
    "__init__": 8,
}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)
INCLUDE_ANGLE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*<([^>]+)>", re.MULTILINE)
CPP_SUFFIXES = {".h", ".hpp", ".cpp", ".inl"}


def violation(place: str, layer: str, used: str, ranks: Mapping[str, int]) -> str | None:
    """What is wrong with `layer` using `used`, if anything."""
    if used not in ranks:
        return f"{place}: `{used}` is not a layer (known: {', '.join(ranks)})"
    if used == layer or ranks[used] < ranks[layer]:
        return None
    return f"{place}: `{layer}` must not use `{used}`, which is not below it"


def line_of(text: str, position: int) -> int:
    """The line number of a character."""
    return text.count("\n", 0, position) + 1


def check_native(native: Path) -> Iterator[str]:
    """The violations in native/src, native/cli and native/bindings."""
    ranks = {**NATIVE_RANKS, "cli": NATIVE_TOP, "bindings": NATIVE_TOP}
    source = native / "src"
    for path in sorted(p for p in native.rglob("*") if p.suffix in CPP_SUFFIXES):
        layer = path.relative_to(source if path.is_relative_to(source) else native).parts[0]
        text = path.read_text(encoding="utf-8")
        for include in INCLUDE.finditer(text):
            place = f"{path}:{line_of(text, include.start())}"
            used, slash, _ = include[1].partition("/")
            if layer not in ranks:
                yield f"{place}: the folder `{layer}` is not a layer (known: {', '.join(ranks)})"
            elif ".." in include[1].split("/"):
                yield f'{place}: write #include "layer/file.h", not a path with ..'
            elif not slash:
                if layer in NATIVE_RANKS or not (path.parent / used).exists():
                    yield f'{place}: write #include "layer/file.h", not "{include[1]}"'
            elif error := violation(place, layer, used, ranks):
                yield error
        if layer != "bindings":
            for include in INCLUDE_ANGLE.finditer(text):
                if include[1] == "Python.h" or include[1].startswith("pybind11/"):
                    yield f"{path}:{line_of(text, include.start())}: only bindings know Python"


def imported_layers(tree: ast.AST, depth: int) -> Iterator[tuple[int, str, bool]]:
    """(line, layer, whether the import is relative) for each of the add-on's imports of its own modules.

    `depth` is how many folders below the add-on's root the file lies.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level > 0:
            if node.level <= depth:
                continue  # inside its own layer
            if node.level > depth + 1:
                yield node.lineno, "..", True
            elif node.module:
                yield node.lineno, node.module.split(".")[0], True
            else:
                for alias in node.names:
                    yield node.lineno, alias.name, True
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.lineno, node.module.split(".")[0], False
        elif isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name.split(".")[0], False


def check_addon(addon: Path) -> Iterator[str]:
    """The violations in the add-on's folder."""
    for path in sorted(addon.rglob("*.py")):
        inside = path.relative_to(addon)
        layer = inside.parts[0].removesuffix(".py")
        depth = len(inside.parts) - 1
        tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
        if layer not in ADDON_RANKS:
            yield f"{path}:1: `{layer}` is not a layer (known: {', '.join(ADDON_RANKS)})"
            continue
        for line, used, is_relative in imported_layers(tree, depth):
            place = f"{path}:{line}"
            if used == "..":
                yield f"{place}: import reaches outside the add-on"
            elif is_relative and used != layer:
                if error := violation(place, layer, used, ADDON_RANKS):
                    yield error
            elif not is_relative and used in {"addon", "bl_ext", "basicrt_addon"}:
                yield f"{place}: import the add-on's own modules relatively"


def check(root: Path) -> list[str]:
    """All violations in a checkout."""
    return [*check_native(root / "native"), *check_addon(root / "addon")]


def main() -> int:
    """Check the checkout this script is in, or the one named."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    errors = check(root)
    print(*errors, sep="\n", end="\n" if errors else "")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
