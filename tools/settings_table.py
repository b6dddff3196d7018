# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/settings.md: every property that the extension adds to Blender, from its definition.

Runs in a Python that has Blender's module of version 5.0 and basicrt.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "docs/settings.md"

INTRODUCTION = """# Settings, one by one

All that BasicRT adds to Blender's data and preferences, as scripts write it; the text of each is its tooltip.
`tools/settings_table.py` writes this page from the definitions, and `tests/blender/test_settings_table.py`
holds it against them.
[Which value counts](blender_settings.md) where Cycles has the same setting says another page.
"""
# Whose they are, heading, where scripts find them.
GROUPS = (
    ("Scene", "Render settings", "scene.basicrt"),
    ("View3DShading", "Viewport settings", "space_view3d.shading.basicrt"),
)
PREFERENCES = 'bpy.context.preferences.addons["bl_ext.user_default.basicrt"].preferences'
# Beyond, a limit is none.
LARGE = 1e9


def number(value: float) -> str:
    """As short as it can be."""
    return str(value) if isinstance(value, int) else f"{value:.6g}"


def limits(made: Any) -> str:
    """What numbers are allowed."""
    low = number(made.hard_min) if made.hard_min > -LARGE else ""
    high = number(made.hard_max) if made.hard_max < LARGE else ""
    if low and high:
        return f"{low} to {high}"
    return f"at least {low}" if low else f"at most {high}" if high else ""


def kind(made: Any) -> tuple[str, str]:
    """What may be written, and the default."""
    if made.type == "BOOLEAN":
        return "True or False", str(made.default)
    if made.type == "ENUM":
        return ", ".join(f"`{item.identifier}`" for item in made.enum_items), f"`{made.default}`"
    if made.type in ("INT", "FLOAT"):
        unit = "" if made.unit == "NONE" else f", {made.unit.lower()}"
        allowed = limits(made)
        name = "whole number" if made.type == "INT" else "number"
        text = f"{name}{', ' if allowed else ''}{allowed}{unit}"
        return text, number(made.default)
    return made.type.lower(), ""


def rows(made: Any) -> Iterator[str]:
    """A line for each property of a group."""
    for item in made.properties:
        if item.identifier in ("rna_type", "name", "bl_idname", "bl_system_properties_get"):
            continue
        allowed, default = kind(item)
        text = item.description.rstrip(".")
        yield f"| `{item.identifier}` | {item.name} | {allowed} | {default} | {text} |"


def table() -> str:
    """The page."""
    import bpy

    parts = [INTRODUCTION]
    for owner, heading, place in GROUPS:
        made: Any = getattr(bpy.types, owner).bl_rna.properties["basicrt"].fixed_type
        parts.append(section(heading, place, made))
    parts.append(section("Preferences", PREFERENCES, preferences_class().bl_rna))
    return "".join(parts)


def section(heading: str, place: str, made: Any) -> str:
    """A group's heading and its table."""
    lines = [
        f"\n## {heading}: `{place}`\n",
        "| property | in the interface | values | default | |",
        "|---|---|---|---|---|",
        *rows(made),
    ]
    return "\n".join(lines) + "\n"


def preferences_class() -> Any:
    """That of the add-on which is registered: `bpy.types` doesn't name it."""
    import bpy

    classes: list[Any] = bpy.types.AddonPreferences.__subclasses__()
    return next(
        made for made in classes if made.__name__ == "BasicRTPreferences" and made.is_registered
    )


def main() -> int:
    """Write the page."""
    from basicrt import blender_addon  # type: ignore[attr-defined, unused-ignore]

    blender_addon.register()
    TABLE.write_text(table(), encoding="utf-8")
    blender_addon.unregister()
    return 0


if __name__ == "__main__":
    sys.exit(main())
