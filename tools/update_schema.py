# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings docs/scene.schema.json up to date with the described structs, as the C++ test of it sees them.

Wants the tests compiled (`make build`). What the reader adds to them by hand is left as it is.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from project import ROOT, relative, say

SCHEMA = ROOT / "docs" / "scene.schema.json"
TESTS = ROOT / "build" / "basicrt_tests"
WIDTH = 110


def text_of(value: Any, indent: int = 0, used: int = 0) -> str:
    """As JSON, on one line where that fits."""
    short = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, dict | list) or not value or indent + used + len(short) < WIDTH:
        return short
    inner = indent + 2
    if isinstance(value, dict):
        keys = {json.dumps(key): part for key, part in value.items()}
        lines = [f"{key}: {text_of(part, inner, len(key) + 2)}" for key, part in keys.items()]
    else:
        lines = [text_of(part, inner) for part in value]
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    body = ",\n".join(" " * inner + line for line in lines)
    return f"{opening}\n{body}\n{' ' * indent}{closing}"


def described() -> dict[str, Any]:
    """The definitions that follow from described structs."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "definitions.json"
        environment = os.environ | {"BASICRT_DEFINITIONS": str(path)}
        filtered = [str(TESTS), "--gtest_filter=SceneSchema.described*"]
        subprocess.run(filtered, env=environment, check=False, stdout=subprocess.DEVNULL)
        return dict(json.loads(path.read_text(encoding="utf-8")))


def main() -> int:
    """Write the schema."""
    if not TESTS.exists():
        print(f"no {relative(TESTS)}: run `make build` first", file=sys.stderr)
        return 1
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    schema["$defs"] |= described()
    SCHEMA.write_text(text_of(schema) + "\n", encoding="utf-8")
    say(f"wrote {relative(SCHEMA)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
