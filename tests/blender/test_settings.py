# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose settings count: BasicRT's, or those that a file has for Cycles."""

from typing import Any

import bpy
import pytest
from addon.properties.choice import CYCLES_NAMES, Choice

from support.blender import add_camera, export, new_scene


@pytest.fixture
def scene() -> Any:
    made = new_scene()
    made.basicrt.property_unset("samples")
    add_camera()
    return made


def test_untouched_settings_have_our_defaults(scene: Any) -> None:
    assert list(Choice(scene).followed()) == []
    assert export().settings.samples == scene.basicrt.samples == 128


def test_what_was_changed_for_cycles_counts_where_ours_was_not(scene: Any) -> None:
    scene.cycles.samples, scene.cycles.transparent_max_bounces = 17, 3
    scene.cycles.film_exposure = 2.0
    settings = export().settings
    assert (settings.samples, settings.transparent_bounces, settings.exposure) == (17, 3, 2.0)
    assert settings.diffuse_bounces == scene.basicrt.diffuse_bounces


def test_what_was_changed_for_us_counts_before_cycles(scene: Any) -> None:
    scene.cycles.max_bounces = 3
    scene.basicrt.max_bounces = 5
    assert export().settings.max_bounces == 5


def test_the_noise_threshold_goes_with_the_samples(scene: Any) -> None:
    scene.cycles.samples = 50
    assert export().settings.adaptive_threshold == pytest.approx(0.01), "Cycles' default"
    scene.basicrt.samples = 60
    assert Choice(scene).adaptive_threshold == 0


def test_a_noise_threshold_of_zero_is_chosen_by_the_samples_as_in_cycles(scene: Any) -> None:
    scene.cycles.samples, scene.cycles.adaptive_threshold = 50, 0
    assert Choice(scene).adaptive_threshold == pytest.approx(1 / 50)
    scene.cycles.use_adaptive_sampling = False
    assert Choice(scene).adaptive_threshold == 0


def test_the_option_reads_all_from_cycles(scene: Any) -> None:
    scene.basicrt.samples, scene.basicrt.use_cycles_settings = 5, True
    assert set(Choice(scene).followed()) == set(CYCLES_NAMES)
    assert export().settings.samples == scene.cycles.samples == 4096


def test_the_button_makes_cycles_values_ours(scene: Any) -> None:
    scene.cycles.samples, scene.cycles.pixel_filter_type = 9, "GAUSSIAN"
    assert bpy.ops.basicrt.copy_cycles_settings() == {"FINISHED"}
    scene.cycles.samples, scene.cycles.pixel_filter_type = 10, "BOX"
    settings = export().settings
    assert (settings.samples, settings.filter_type) == (9, "gaussian")


def test_every_followed_setting_takes_cycles_value(scene: Any) -> None:
    for name, cycles_name in CYCLES_NAMES.items():
        assert hasattr(scene.cycles, cycles_name)
        setattr(scene.basicrt, name, getattr(scene.cycles, cycles_name))


def test_without_cycles_ours_count(scene: Any) -> None:
    scene.cycles.samples = 17
    bpy.ops.preferences.addon_disable(module="cycles")
    try:
        scene.basicrt.use_cycles_settings = True
        assert not hasattr(scene, "cycles")
        assert export().settings.samples == scene.basicrt.samples
        assert not bpy.ops.basicrt.copy_cycles_settings.poll()
    finally:
        bpy.ops.preferences.addon_enable(module="cycles")


def test_animated_seed_differs_from_frame_to_frame(scene: Any) -> None:
    scene.cycles.seed, scene.cycles.use_animated_seed = 3, True
    seeds = []
    for frame in (1, 2):
        scene.frame_set(frame)
        seeds.append(export().settings.seed)
    assert seeds[0] != seeds[1]


def test_seed_is_the_same_in_every_frame(scene: Any) -> None:
    scene.cycles.seed = 3
    scene.frame_set(2)
    assert export().settings.seed == 3
