# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/settings.md says what the properties' definitions do."""

import sys
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="the table is of Blender 5.0")
def test_the_table_of_settings_is_up_to_date() -> None:
    import settings_table

    written = settings_table.TABLE.read_text(encoding="utf-8")
    assert written == settings_table.table(), "run tools/settings_table.py with Blender 5.0"
