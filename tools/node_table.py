# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/nodes.md: every shader node of a Blender and what the extension makes of it.

Each node is made in a material and translated, so the table says what a user would be told. Run it
with the Python of a virtual environment that has Blender's module and BasicRT (`make setup`).
"""

from __future__ import annotations

import atexit
import contextlib
import io
import shutil
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "docs" / "nodes.md"
# Nodes that only hold others or end a tree.
STRUCTURE = ("Output", "Group", "Tree", "CustomGroup")
# Nodes that only the background of a world has.
ELSEWHERE = {"ShaderNodeBackground", "ShaderNodeTexSky"}

# Of a node's own properties, those that don't change what it computes.
LABELS = {"label", "name", "bl_idname", "bl_label", "bl_icon", "bl_description", "location"}

HEADER = """\
# Shader nodes

What the extension makes of each shader node of Blender {version} in a material: with its defaults, with each
of its inputs linked, with each of its settings. `tools/node_table.py` writes this page by translating them, and
`tests/blender/test_node_table.py` holds it against the code. In Blender the render properties list the same
for a scene. Sky Texture is for the background of a world. Lamps take the same nodes; of shaders those that shine:
Emission, Principled BSDF, Mix and Add.

| node | drawn | not as in Blender |
|---|---|---|
"""


# Of one candela in all directions below.
LUMINAIRE = "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 1\n"


@cache
def luminaire_file() -> str:
    """The path of a file that says the same, gone when Python ends."""
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder)
    path = Path(folder) / "luminaire.ies"
    path.write_text(LUMINAIRE, encoding="utf-8")
    return str(path)


@dataclass(frozen=True)
class Row:
    """A node's name, how much of it is drawn, and what is told of the rest."""

    name: str
    drawn: str
    notes: tuple[str, ...]


@dataclass
class Trial:
    """A material with one node, whose output it shows."""

    material: Any
    tree: Any
    node: Any

    @classmethod
    def of(cls, bl_idname: str) -> Trial:
        """The node with its defaults, and an image where it wants one."""
        import bpy

        material: Any = bpy.data.materials.new("Material")
        material.use_nodes = True
        material.node_tree.nodes.clear()
        node = material.node_tree.nodes.new(bl_idname)
        if "image" in node.bl_rna.properties:
            node.image = bpy.data.images.new("Image", 2, 2)
        return cls(material, material.node_tree, node)

    def add_luminaire(self) -> None:
        """Give the node one where it wants it, from where it wants it."""
        import bpy

        if "ies" not in self.node.bl_rna.properties:
            return
        if self.node.mode == "INTERNAL":
            self.node.ies = bpy.data.texts.new("Luminaire")
            self.node.ies.write(LUMINAIRE)
        else:
            self.node.filepath = luminaire_file()

    def show(self, output: str) -> None:
        """Link an output to where it is seen."""
        socket = next(s for s in self.node.outputs if s.identifier == output)
        target = self.tree.nodes.new("ShaderNodeOutputMaterial").inputs
        name = "Volume" if is_volume(self.node.bl_idname) else "Surface"
        place = target["Displacement" if output == "Displacement" else name]
        if socket.type != "SHADER" and output != "Displacement":
            emission = self.tree.nodes.new("ShaderNodeEmission")
            self.tree.links.new(emission.outputs[0], place)
            place = emission.inputs["Color"]
        self.tree.links.new(socket, place)

    def vary(self, identifier: str) -> None:
        """Link an input to something that varies, of its type."""
        socket = next(s for s in self.node.inputs if s.identifier == identifier)
        if socket.type == "SHADER":
            source = self.tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0]
        elif socket.type == "VECTOR":
            source = self.tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"]
        else:
            noise = self.tree.nodes.new("ShaderNodeTexNoise")
            source = noise.outputs["Color" if socket.type == "RGBA" else 0]
        self.tree.links.new(source, socket)

    def warnings(self) -> list[str]:
        """What the user is told, without the material's name; takes the material away."""
        import bpy
        from addon.nodes import Textures, translate_surface
        from addon.report import Report

        import basicrt

        report = Report()
        scene = basicrt.Scene()
        scene.camera = basicrt.PerspectiveCamera()
        with contextlib.redirect_stdout(io.StringIO()):
            translate_surface(self.material, report, Textures(scene))
        bpy.data.materials.remove(self.material)
        return [text.split(": ", 1)[1] for text in report.warnings]


def is_volume(bl_idname: str) -> bool:
    """Whether a node's shader belongs to a volume."""
    return "Volume" in bl_idname and bl_idname != "ShaderNodeVolumeInfo"


def is_missing(warnings: list[str]) -> bool:
    """Whether an output could not be had at all."""
    return any("own value is used" in text or "as diffuse grey" in text for text in warnings)


def settings_of(node: Any) -> Iterator[tuple[str, Any]]:
    """Each value of each of a node's settings but those that it has."""
    import bpy

    inherited = set(bpy.types.ShaderNode.bl_rna.properties.keys()) | LABELS
    for name, made in node.bl_rna.properties.items():
        if name in inherited or made.is_readonly:
            continue
        if made.type == "ENUM":
            values = [item.identifier for item in made.enum_items]
        elif made.type == "BOOLEAN":
            values = [not made.default]
        else:
            continue
        default = getattr(node, name)
        for value in values:
            with contextlib.suppress(TypeError):  # the list of values depends on the node
                setattr(node, name, value)
                if value != default:
                    yield name, value
        setattr(node, name, default)


def row_of(bl_idname: str, name: str) -> Row:
    """What becomes of one node."""

    def tried(output: str, linked: str = "", setting: str = "", value: Any = None) -> list[str]:
        trial = Trial.of(bl_idname)
        if linked:
            trial.vary(linked)
        if setting:
            setattr(trial.node, setting, value)
        trial.add_luminaire()
        enabled = [s.identifier for s in trial.node.outputs if s.enabled]
        trial.show(output if output in enabled else enabled[0])
        return trial.warnings()

    trial = Trial.of(bl_idname)
    outputs = {s.identifier: s.name for s in trial.node.outputs if s.enabled}
    inputs = [s.identifier for s in trial.node.inputs if s.enabled and s.name]
    settings = list(settings_of(trial.node))
    trial.warnings()
    told = {label: tried(identifier) for identifier, label in outputs.items()}
    missing = [label for label, warnings in told.items() if is_missing(warnings)]
    if len(missing) == len(outputs):
        return Row(name, "no", ())
    shown = next(identifier for identifier, label in outputs.items() if label not in missing)
    notes = {text for label, texts in told.items() if label not in missing for text in texts}
    for identifier in inputs:
        warnings = tried(shown, linked=identifier)
        notes.update([f"{identifier} does not vary"] if is_missing(warnings) else warnings)
    for setting, value in settings:
        warnings = tried(shown, setting=setting, value=value)
        notes.update([f"{setting} {value} is left out"] if is_missing(warnings) else warnings)
    said = sorted({note.split('": ', 1)[-1] for note in notes})
    if missing:
        said.insert(0, "without " + ", ".join(missing))
    is_another = any("drawn as" in text for texts in told.values() for text in texts)
    return Row(name, "as another" if is_another else "in part" if said else "yes", tuple(said))


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
        if any(socket.enabled for socket in node.outputs):
            found.append(row_of(bl_idname, node.bl_rna.name))
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
