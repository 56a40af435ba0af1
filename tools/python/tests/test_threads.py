"""Other threads run while a call of the module takes longer than a millisecond."""

import os
import sys
import threading
import time

import numpy as np
import pytest
import tearmesh

from conftest import grid
from test_table import exports

PLANE = ((0.31, 0, 0), (1, 0.2, 0))

# A call that takes long on a mesh of 100,000 faces, for each export that has one. `kept` is from before the calls.
CALLS = {
    "check": lambda kept: tearmesh.check(kept.faces, len(kept.points)),
    "pieces": lambda kept: tearmesh.pieces(kept.faces, len(kept.points)),
    "cut": lambda kept: tearmesh.cut(kept.points, kept.faces, PLANE, uv=kept.uv),
    "mend": lambda kept: tearmesh.mend(kept.cut.points, kept.cut.faces, kept.cut.roots),
    "write_obj": lambda kept: tearmesh.write_obj(kept.path, kept.points, kept.faces, uv=kept.uv),
    "read_obj": lambda kept: tearmesh.read_obj(kept.path),
    "TornMesh.map": lambda kept: kept.cut.map(kept.uv, "corner"),
    "Simulation": lambda kept: tearmesh.Simulation(kept.points, kept.faces),
    "Simulation.of_scene": lambda kept: tearmesh.Simulation.of_scene(kept.points, kept.faces, kept.scene),
    "Simulation.advance": lambda kept: kept.sim.advance(kept.sim.step_length),
    "Simulation.step": lambda kept: kept.sim.step(),
    "Simulation.hold": lambda kept: kept.sim.hold(kept.all),
    "Simulation.free": lambda kept: kept.sim.free(kept.all),
    "Simulation.reaction": lambda kept: kept.sim.reaction(kept.all),
    "Simulation.pick": lambda kept: kept.sim.pick((0.5, 0.5, 5), (0, 0, -1)),
    "Simulation.grab": lambda kept: kept.sim.grab(next(kept.vertices)),
    "Simulation.release": lambda kept: kept.sim.release(next(kept.hands)),
    "Simulation.cut": lambda kept: kept.sim.cut(PLANE),
    "Simulation.heal": lambda kept: kept.sim.heal(),
    "Simulation.set_wind": lambda kept: kept.sim.set_wind((0, 0, 1)),
    "Simulation.map": lambda kept: kept.sim.step(0) or kept.sim.map(np.ones((len(kept.sim.roots), 8))),
    "Simulation.points": lambda kept: kept.sim.points,
    "Simulation.velocities": lambda kept: kept.sim.velocities,
    "Simulation.faces": lambda kept: kept.sim.faces,
    "Simulation.roots": lambda kept: kept.sim.roots,
    "Simulation.pieces": lambda kept: kept.sim.pieces,
}

# What reads a number, makes objects of Python, or returns an array that is there already.
SHORT = {"Simulation.lead", "Simulation.events", "Simulation.time", "Simulation.step_length", "Simulation.open_pairs"}
SHORT |= {f"TornMesh{part}" for part in ["", ".points", ".faces", ".roots", ".pieces", ".uv", ".sides", ".seam", ".missed"]}


class Kept:
    """What calls are made with."""

    def __init__(self, folder):
        points, self.faces = grid(224)
        self.points = points + 0.05 * np.sin(9 * points[:, [2, 2, 0]])
        self.uv = points[self.faces][..., :2]
        self.all = np.arange(len(points))
        self.cut = tearmesh.cut(self.points, self.faces, PLANE)
        self.sim = tearmesh.Simulation(self.points, self.faces)
        self.vertices = iter(range(1000, 2000))
        self.hands = (self.sim.grab(vertex) for vertex in range(2000, 3000))
        self.path, self.scene = folder / "a.obj", folder / "scene.toml"
        tearmesh.write_obj(self.path, self.points, self.faces, uv=self.uv)
        self.scene.write_text("")


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return Kept(tmp_path_factory.mktemp("threads"))


class Watch:
    """A thread that looks, as often as it can, at the time that the main thread spent on the processor. Between two looks
    the main thread may have kept this one out, but not while this one waited for a processor. Nothing makes a thread of
    Python let go of the GIL here: it does so by itself, or not at all."""

    def __init__(self):
        clock = time.pthread_getcpuclockid(threading.main_thread().ident)
        self.looks, self.longest, self.done = 0, 0.0, False
        self.clock = lambda: time.clock_gettime(clock)
        self.thread = threading.Thread(target=self.look)

    def look(self):
        waits = os.open("/proc/thread-self/schedstat", os.O_RDONLY)
        last = self.clock(), 0.0
        while not self.done:
            now = self.clock(), int(os.pread(waits, 99, 0).split()[1]) / 1e9
            self.longest = max(self.longest, (now[0] - last[0]) - (now[1] - last[1]))
            last, self.looks = now, self.looks + 1
            time.sleep(2e-5)
        os.close(waits)

    def more_looks(self):
        looks = self.looks
        while self.looks < looks + 2:
            time.sleep(5e-4)

    def held(self, work):
        """The seconds for which a call kept the thread out at most, and those of the processor that it took."""
        self.more_looks()
        self.longest, began = 0.0, self.clock()
        # What is made is freed later: that is up to Python.
        made = work()
        took = self.clock() - began
        self.more_looks()
        held = self.longest
        del made
        return held, took


@pytest.fixture
def watch():
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    watch = Watch()
    watch.thread.start()
    yield watch
    watch.done = True
    watch.thread.join()
    sys.setswitchinterval(interval)


@pytest.mark.skipif(not os.path.exists("/proc/thread-self/schedstat"), reason="needs the clocks of threads")
@pytest.mark.parametrize("name", CALLS)
def test_a_long_call_lets_other_threads_run(kept, watch, name):
    # A call is not judged alone, since what the thread waited for a processor may hide how long it was kept out.
    calls = sorted(watch.held(lambda: CALLS[name](kept)) for _ in range(5))
    held, took = calls[2]
    assert held < max(0.001, 0.05 * took), [f"{1000 * held:.1f} of {1000 * took:.1f} ms" for held, took in calls]


def test_each_export_is_short_or_lets_other_threads_run():
    assert {*CALLS} | SHORT == {*exports()} and not {*CALLS} & SHORT
