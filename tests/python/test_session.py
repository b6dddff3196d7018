# SPDX-License-Identifier: GPL-3.0-or-later
"""Session: tiles, determinism, threads, stopping, progress; render() on top of it."""

import gc
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import basicrt
from basicrt import SceneError, Session
from support.scenes import add, aim, bumpy, endless, still_life

# Every machine is given this long to stop, whatever else it is doing; alone it takes a few milliseconds.
STOP_SECONDS = 0.3


def picture_bytes(scene: basicrt.Scene, **options: int) -> bytes:
    return b"".join(picture.tobytes() for picture in basicrt.render(scene, **options).values())


@pytest.fixture(scope="module")
def reference() -> bytes:
    return picture_bytes(still_life(), threads=1, tile_size=64)


@pytest.mark.parametrize("threads", [1, 2, 3, 8])
@pytest.mark.parametrize("tile_size", [1, 7, 16, 4096])
def test_pictures_have_the_same_bytes_for_any_threads_and_tiles(
    reference: bytes, threads: int, tile_size: int
) -> None:
    assert picture_bytes(still_life(), threads=threads, tile_size=tile_size) == reference


def test_another_seed_gives_other_noise_and_the_same_picture(reference: bytes) -> None:
    scene = still_life()
    scene.settings.seed = 1
    assert picture_bytes(scene) != reference
    mean = basicrt.render(still_life())["Combined"].mean()
    assert basicrt.render(scene)["Combined"].mean() == pytest.approx(mean, rel=0.05)


@pytest.mark.parametrize("tile_size", [1, 5, 16, 1000])
@pytest.mark.parametrize("border", [None, (5, 7, 13, 11)])
def test_tiles_cover_the_picture_exactly_once(tile_size: int, border) -> None:
    scene = still_life(samples=1)
    if border:
        s = scene.settings
        s.border_x, s.border_y, s.border_width, s.border_height = border
    count = np.zeros((32, 48), dtype=int)
    with Session(scene, tile_size=tile_size) as session:
        x, y, width, height = border or (0, 0, 48, 32)
        assert session.rect == (x, y, width, height)
        for tile in session.tiles():
            if tile is None:
                continue
            assert tile.width <= tile_size
            assert tile.height <= tile_size
            assert tile.passes == ["Combined", "Depth", "Normal"]
            for name, channels in (("Combined", 4), ("Depth", 1), ("Normal", 3)):
                values = tile[name]
                assert values.shape == (tile.height, tile.width, channels)
                assert values.dtype == np.float32
                assert values.flags.c_contiguous
            count[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] += 1
    expected = np.zeros_like(count)
    expected[y : y + height, x : x + width] = 1
    assert np.array_equal(count, expected)


def test_a_border_shows_the_same_pixels_as_the_whole(reference: bytes) -> None:
    whole_scene, scene = still_life(), still_life()
    names = [info.name for info in basicrt.passes()]
    whole_scene.settings.passes = scene.settings.passes = names
    whole = basicrt.render(whole_scene)
    s = scene.settings
    s.border_x, s.border_y, s.border_width, s.border_height = 5, 7, 13, 11
    part = basicrt.render(scene)
    for info in basicrt.passes():
        inside = np.s_[7:18, 5:18]
        # As bytes: mattes' ids are no numbers.
        assert part[info.name][inside].tobytes() == whole[info.name][inside].tobytes()
        outside = np.ones((32, 48), dtype=bool)
        outside[inside] = False
        assert (part[info.name][outside] == info.background).all()


def test_only_the_passes_that_were_asked_for_are_made() -> None:
    scene = still_life(samples=1)
    scene.settings.passes = ["Normal", "Combined"]
    assert list(basicrt.render(scene)) == ["Combined", "Normal"]
    with Session(scene) as session:
        tile = next(tile for tile in session.tiles() if tile)
        with pytest.raises(KeyError, match="Depth"):
            tile["Depth"]


def test_row_0_is_the_bottom() -> None:
    scene = basicrt.Scene()
    add(scene, basicrt.Sphere((0, -1, 0), 0.5), basicrt.EmissionShader())
    aim(scene, (0, 0, 5), (0, 0, 0), size=(16, 16), samples=4)
    combined = basicrt.render(scene)["Combined"]
    assert combined[:8, :, 0].max() == 1
    assert combined[8:, :, 0].max() == 0


def test_tiles_outlive_their_session() -> None:
    with Session(still_life(samples=1)) as session:
        tile = next(tile for tile in session.tiles() if tile)
        values = tile["Combined"]
    copy = values.copy()
    del tile, session
    gc.collect()
    assert np.array_equal(values, copy)


def test_a_session_keeps_its_own_scene() -> None:
    scene = still_life()
    with Session(scene, threads=1) as session:
        scene.settings.samples = 1
        scene.materials[0] = basicrt.Material()
        scene.lights[0] = basicrt.PointLight()
        del scene
        gc.collect()
        picture = np.zeros((32, 48, 4), dtype=np.float32)
        for tile in session.tiles():
            if tile:
                picture[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = tile[
                    "Combined"
                ]
    assert np.array_equal(picture, basicrt.render(still_life())["Combined"])


def test_progress_never_falls_and_ends_at_one() -> None:
    session = Session(still_life(samples=64), tile_size=8)
    seen = [session.progress]
    for _ in session.tiles(poll_seconds=0.002):
        seen.append(session.progress)
    fractions = [progress.fraction for progress in seen]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    assert seen[-1].is_done
    assert not seen[0].is_done
    elapsed = [progress.elapsed_seconds for progress in seen]
    assert elapsed == sorted(elapsed)
    assert seen[-1].remaining_seconds == 0
    assert seen[-1].samples_per_second > 0


def test_render_calls_progress_to_the_end() -> None:
    fractions: list[float] = []
    basicrt.render(still_life(), tile_size=8, progress=lambda p: fractions.append(p.fraction))
    assert len(fractions) >= 24
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1


def test_what_progress_raises_ends_the_rendering() -> None:
    class EnoughError(Exception):
        pass

    def progress(_: basicrt.Progress) -> None:
        raise EnoughError

    begin = time.perf_counter()
    with pytest.raises(EnoughError):
        basicrt.render(endless(), progress=progress)
    assert time.perf_counter() - begin < 5


def test_waiting_without_a_tile_yields_none() -> None:
    with Session(endless()) as session:
        begin = time.perf_counter()
        assert next(session.tiles(poll_seconds=0.05)) is None
        assert 0.04 < time.perf_counter() - begin < 2
        assert next(session.tiles(poll_seconds=0)) is None


@pytest.mark.alone
def test_stop_takes_effect_at_once() -> None:
    with Session(endless((1024, 1024))) as session:
        time.sleep(0.2)
        begin = time.perf_counter()
        session.stop()
        tiles = list(session.tiles())
        session.__exit__(None, None, None)  # joins the threads
        seconds = time.perf_counter() - begin
    print(f"stopped and joined after {1000 * seconds:.1f} ms")
    assert tiles == []
    assert session.is_stopped
    assert seconds < STOP_SECONDS


@pytest.mark.alone
def test_another_thread_can_stop_a_waiting_one() -> None:
    session = Session(endless())
    stopped_at = 0.0

    def stop() -> None:
        nonlocal stopped_at
        time.sleep(0.2)
        stopped_at = time.perf_counter()
        session.stop()

    thread = threading.Thread(target=stop)
    thread.start()
    assert list(session.tiles(poll_seconds=60)) == []
    seconds = time.perf_counter() - stopped_at
    thread.join()
    print(f"woke up after {1000 * seconds:.1f} ms")
    assert seconds < STOP_SECONDS


def test_another_thread_can_close_the_session_of_a_waiting_one() -> None:
    session = Session(endless())
    results: list[object] = []
    thread = threading.Thread(target=lambda: results.extend(session.tiles(poll_seconds=60)))
    thread.start()
    time.sleep(0.1)
    session.__exit__(None, None, None)
    thread.join(timeout=5)
    assert not thread.is_alive()
    assert results == []


def test_a_finished_session_can_still_be_asked() -> None:
    with Session(still_life(samples=1)) as session:
        list(session.tiles())
    assert session.progress.fraction == 1
    assert session.rect == (0, 0, 48, 32)
    assert not session.is_stopped
    assert list(session.tiles()) == []
    session.stop()


def test_dropping_a_session_ends_its_threads() -> None:
    before = native_thread_count()
    session = Session(endless(), threads=3)
    assert native_thread_count() == before + 3
    del session
    gc.collect()
    # The kernel may count a thread a little longer than it takes to join it.
    deadline = time.monotonic() + 5
    while native_thread_count() > before and time.monotonic() < deadline:
        time.sleep(0.001)
    assert native_thread_count() == before


def native_thread_count() -> int:
    with Path("/proc/self/status").open() as file:
        return next(int(line.split()[1]) for line in file if line.startswith("Threads:"))


def longest_pause(work) -> tuple[float, float]:
    """Runs work() while another Python thread ticks: how long it took, and the longest time between two ticks."""
    ticks: list[float] = []
    is_done = threading.Event()

    def tick() -> None:
        while not is_done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    time.sleep(0.05)
    begin = time.perf_counter()
    work()
    end = time.perf_counter()
    time.sleep(0.05)
    is_done.set()
    thread.join()
    return end - begin, max(np.diff(ticks))


@pytest.mark.alone
def test_python_threads_run_while_native_ones_render() -> None:
    scene = still_life(size=(96, 64), samples=256)
    seconds, pause = longest_pause(lambda: basicrt.render(scene, tile_size=4096))
    print(f"rendered for {seconds:.2f} s, Python paused for at most {pause:.3f} s")
    assert pause < max(0.5 * seconds, 0.1)


@pytest.mark.alone
def test_python_threads_run_while_a_scene_is_prepared() -> None:
    scene = basicrt.Scene()
    add(scene, bumpy(700), basicrt.DiffuseShader())
    aim(scene, (0, 0, 3), (0, 0, 0), size=(8, 8), samples=1)
    seconds, pause = longest_pause(lambda: Session(scene))
    print(f"prepared for {seconds:.2f} s, Python paused for at most {pause:.3f} s")
    assert pause < max(0.5 * seconds, 0.1)


def large_scene() -> basicrt.Scene:
    scene = still_life(samples=1)
    add(scene, bumpy(1000), basicrt.DiffuseShader())
    return scene


def test_preparing_tells_how_far_it_is_and_the_tree_has_a_size() -> None:
    fractions: list[float] = []
    with Session(large_scene(), preparing=fractions.append) as session:
        assert session.tree_bytes > 2_000_000 * 40
    assert fractions
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1


@pytest.mark.alone
def test_what_preparing_raises_ends_it_soon() -> None:
    class EnoughError(Exception):
        pass

    raised = 0.0

    def enough(_fraction: float) -> None:
        nonlocal raised
        raised = time.monotonic()
        raise EnoughError

    scene = large_scene()
    with pytest.raises(EnoughError):
        Session(scene, preparing=enough)
    assert time.monotonic() - raised < STOP_SECONDS
    scene.settings.samples = 1  # nobody holds the scene any more


def test_nobody_changes_a_scene_while_it_is_prepared() -> None:
    scene = basicrt.Scene()
    add(scene, bumpy(700), basicrt.DiffuseShader())
    aim(scene, (0, 0, 3), (0, 0, 0), size=(8, 8), samples=1)
    refusals: list[str] = []
    is_done = threading.Event()

    def change() -> None:
        while not is_done.is_set():
            try:
                scene.lights.append(basicrt.PointLight())
            except RuntimeError as error:
                refusals.append(str(error))
            time.sleep(0.001)

    thread = threading.Thread(target=change)
    thread.start()
    with Session(scene):
        is_done.set()
    thread.join()
    assert refusals
    assert "another thread" in refusals[0]
    scene.lights.append(basicrt.PointLight())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"threads": -1}, "Session.threads: must be at least 0, is -1"),
        ({"tile_size": 0}, "Session.tile_size: must be at least 1, is 0"),
    ],
)
def test_bad_options_are_refused(options, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Session(still_life(), **options)
    with Session(still_life(samples=1)) as session, pytest.raises(SceneError, match="poll_seconds"):
        session.tiles(poll_seconds=-1)


def test_running_out_of_memory_is_a_memory_error() -> None:
    code = """
        import resource
        import numpy as np
        import basicrt
        from support.scenes import add, aim, bumpy

        scene = basicrt.Scene()
        add(scene, bumpy(500), basicrt.DiffuseShader())
        aim(scene, (0, 0, 3), (0, 0, 0), size=(8, 8), samples=1)
        with open("/proc/self/statm") as file:
            used = int(file.read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + (4 << 20), resource.RLIM_INFINITY))
        try:
            basicrt.Session(scene, threads=1)
        except MemoryError:
            print("MemoryError")
    """
    path = [p for p in sys.path if p]
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path[:0] = {path!r}\n{textwrap.dedent(code)}"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "MemoryError\n"), done.stderr
