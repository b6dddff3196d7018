# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's own tools: the manifest they fill in, the reports they add up, the wheels they repack."""

import tomllib
import zipfile
from pathlib import Path

import pytest

import build_extension
import build_wheel
import stages
import system_packages

MANIFEST = """\
id = "basicrt"
version = "0.0.0"
blender_version_min = "4.2.0"
wheels = [
  "./wheels/old.whl",
]

[permissions]
files = "Write exported scenes"
"""


def test_wheels_are_added_before_the_first_table() -> None:
    text = build_extension.with_wheels(MANIFEST, ["a.whl", "b.whl"], "linux-x64")
    manifest = tomllib.loads(text)
    assert manifest["wheels"] == ["./wheels/a.whl", "./wheels/b.whl"]
    assert manifest["platforms"] == ["linux-x64"]
    assert manifest["version"] == build_extension.version()
    assert manifest["blender_version_min"] == "4.2.0"
    assert manifest["permissions"] == {"files": "Write exported scenes"}


def test_manifest_without_tables_gets_wheels_too() -> None:
    manifest = tomllib.loads(build_extension.with_wheels('id = "x"\n', ["a.whl"], "linux-x64"))
    assert manifest["wheels"] == ["./wheels/a.whl"]


@pytest.mark.parametrize(
    ("report", "succeeded", "counts"),
    [
        ('<testsuite tests="5" failures="1" disabled="1" skipped="1"/>', False, (2, 1, 2)),
        (
            '<testsuites><testsuite tests="4" failures="0" errors="1" skipped="0"/></testsuites>',
            False,
            (3, 1, 0),
        ),
        ('<testsuite tests="3" failures="0"/>', True, (3, 0, 0)),
        # The runner crashed on its way out: that is a failure of its own.
        ('<testsuite tests="3" failures="0"/>', False, (3, 1, 0)),
        (None, False, (0, 1, 0)),
    ],
)
def test_reports_are_counted(
    tmp_path: Path, report: str | None, succeeded: bool, counts: tuple[int, int, int]
) -> None:
    path = tmp_path / "report.xml"
    if report is not None:
        path.write_text(report, encoding="utf-8")
    found = stages.read_report(path, succeeded)
    assert (found.passed, found.failed, found.skipped) == counts


def test_files_whose_tests_measure_time_are_found() -> None:
    assert stages.files_with("alone", ["tests/python"]) == ["tests/python/test_session.py"]


def test_repacked_wheel_holds_the_other_module_and_its_tags(tmp_path: Path) -> None:
    info = f"basicrt-{build_wheel.version()}.dist-info"
    donor = tmp_path / f"basicrt-{build_wheel.version()}-cp311-cp311-linux_x86_64.whl"
    with zipfile.ZipFile(donor, "w") as archive:
        archive.writestr("basicrt/__init__.py", "")
        archive.writestr("basicrt/_native.cpython-311-x86_64-linux-gnu.so", "old")
        archive.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nTag: cp311-cp311-linux_x86_64\n")
        archive.writestr(f"{info}/RECORD", "stale")
    module = tmp_path / "_native.cpython-314-x86_64-linux-gnu.so"
    module.write_bytes(b"new")
    wheel = tmp_path / donor.name.replace("311", "314")

    build_wheel.repack(donor, wheel, module)

    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        assert [name for name in names if name.endswith(".so")] == [f"basicrt/{module.name}"]
        assert archive.read(f"basicrt/{module.name}") == b"new"
        assert b"Tag: cp314-cp314-linux_x86_64" in archive.read(f"{info}/WHEEL")
        recorded = [line.split(",")[0] for line in archive.read(f"{info}/RECORD").decode().split()]
    assert sorted(recorded) == sorted(names)


def test_missing_packages_are_named_where_they_cannot_be_installed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(system_packages, "is_debian", lambda: True)
    monkeypatch.setattr(system_packages, "missing_packages", lambda names: ["libxi6"])
    monkeypatch.setattr(system_packages, "apt_prefix", lambda: None)
    with pytest.raises(system_packages.ToolError, match=r"sudo apt-get install .* libxi6"):
        system_packages.install_packages(["libxi6", "libgl1"])
