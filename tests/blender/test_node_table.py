# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/nodes.md says what the translators do."""

import sys
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="the table is of Blender 5.0")
def test_the_table_of_nodes_is_up_to_date() -> None:
    import node_table

    written = node_table.TABLE.read_text(encoding="utf-8")
    assert written == node_table.table(), "run tools/node_table.py with Blender 5.0"
