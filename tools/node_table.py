# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/nodes.md: every shader node of a Blender and what the extension makes of it.

Each node is made in a material and translated, so the table says what a user would be told. Run it
with the Python of a virtual environment that has Blender's module and BasicRT (`make setup`).
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "docs" / "nodes.md"
# Nodes that only hold others or end a tree.
STRUCTURE = ("Output", "Group", "Tree", "CustomGroup")
# Nodes of other uses: lamps' and line styles' own, and those that only the background has.
ELSEWHERE = {"ShaderNodeBackground", "ShaderNodeTexEnvironment", "ShaderNodeTexSky"}

HEADER = """\
# Shader nodes

What the extension makes of each shader node of Blender {version} in a material, by translating one
with its defaults. Written by `tools/node_table.py`; `tests/blender/test_node_table.py` holds it against the code.
Environment and sky textures are for the background of a world.

| node | drawn | not as in Blender |
|---|---|---|
"""


@dataclass(frozen=True)
class Row:
    """A node's name, how much of it is drawn, and what is told of the rest."""

    name: str
    drawn: str
    notes: tuple[str, ...]


def translate_node(bl_idname: str, output: str) -> list[str]:
    """The warnings of a material that shows one output of a node."""
    import bpy
    from addon.nodes import Textures, translate_surface
    from addon.report import Report

    import basicrt

    material = bpy.data.materials.new("Material")
    try:
        material.use_nodes = True
        tree: Any = material.node_tree
        tree.nodes.clear()
        node = tree.nodes.new(bl_idname)
        socket = next(s for s in node.outputs if s.identifier == output)
        target = tree.nodes.new("ShaderNodeOutputMaterial").inputs
        place = target["Volume" if is_volume(bl_idname) else "Surface"]
        if socket.type != "SHADER":
            emission = tree.nodes.new("ShaderNodeEmission")
            tree.links.new(emission.outputs[0], place)
            place = emission.inputs["Color"]
        tree.links.new(socket, place)
        report = Report()
        translate_surface(material, report, Textures(basicrt.Scene()))
        return [text.split(": ", 1)[1] for text in report.warnings]
    finally:
        bpy.data.materials.remove(material)


def is_volume(bl_idname: str) -> bool:
    """Whether a node's shader belongs to a volume."""
    return "Volume" in bl_idname and bl_idname != "ShaderNodeVolumeInfo"


def row_of(bl_idname: str, name: str, outputs: list[tuple[str, str]]) -> Row:
    """What becomes of one node."""
    told = {label: translate_node(bl_idname, identifier) for identifier, label in outputs}
    missing = [label for label, notes in told.items() if any("own value" in n for n in notes)]
    notes = {n.split(": ", 1)[-1] for notes in told.values() for n in notes if "own value" not in n}
    if outputs and len(missing) == len(outputs):
        return Row(name, "no", ())
    said = sorted(notes)
    if missing:
        said.insert(0, "without " + ", ".join(missing))
    if any("drawn as" in note for note in notes):
        return Row(name, "as another", tuple(said))
    return Row(name, "in part" if said else "yes", tuple(said))


def rows() -> list[Row]:
    """All nodes that a material may have."""
    import bpy

    found = []
    tree: Any = bpy.data.node_groups.new("Nodes", "ShaderNodeTree")
    for bl_idname in sorted(name for name in dir(bpy.types) if name.startswith("ShaderNode")):
        if bl_idname in ELSEWHERE or any(word in bl_idname for word in STRUCTURE):
            continue
        try:
            node = tree.nodes.new(bl_idname)
        except RuntimeError:  # a base class, or a node of another kind of tree
            continue
        outputs = [(s.identifier, s.name) for s in node.outputs if s.enabled]
        found.append(row_of(bl_idname, node.bl_rna.name, outputs))
    bpy.data.node_groups.remove(tree)
    return sorted(found, key=lambda row: row.name)


def table() -> str:
    """The whole page."""
    import bpy

    major, minor, _patch = bpy.app.version
    lines = [f"| {row.name} | {row.drawn} | {'; '.join(row.notes)} |\n" for row in rows()]
    return HEADER.format(version=f"{major}.{minor}") + "".join(lines)


def main() -> int:
    """Write the page."""
    sys.path.insert(0, str(ROOT))
    TABLE.write_text(table(), encoding="utf-8")
    print(f"wrote {TABLE.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
