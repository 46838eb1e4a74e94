"""What fails says so in words, leaves everything as it was, and nothing behind."""

import contextlib
import gc
import os
import resource
import signal
import sys
import threading
import time
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import saltus

DROP = {"restitution": 0.8, "ball": {"height": "1 m"}}


def ball(does=lambda where, value: value):
    """A ball of functions that are called, each of which does as it is told with what it gives."""

    def flow(t, x):
        return does("flow", [float(x[1]), -9.81])

    def guard(t, x):
        return does("guard", float(x[0]))

    def reset(t, x):
        return does("reset", [0.0, -0.5 * float(x[1])])

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", saltus.TracingWarning)
        return saltus.Hybrid(2).mode("m", flow).edge("m", "m", guard, reset)


def run(system):
    return system.run("m", [1.0, 0.0], (0, 1))


class Broken(Exception):
    pass


WHERE = st.sampled_from(["flow", "guard", "reset"])


@settings(max_examples=60, deadline=None)
@given(where=WHERE, after=st.integers(0, 40), kind=st.sampled_from([Broken, ValueError, ZeroDivisionError, MemoryError]))
def test_what_a_function_raises_is_the_cause(where, after, kind):
    raised, calls, armed = kind("the sensor is gone"), {"n": 0}, True

    def does(place, value):
        calls["n"] += place == where
        if armed and place == where and calls["n"] > after:
            raise raised
        return value

    system = ball(does)
    calls["n"] = 0
    try:
        run(system)
    except saltus.RunError as failed:
        assert failed.__cause__ is raised and "the sensor is gone" in str(failed)
        assert 0 <= failed.t <= 1 and failed.mode == "m" and len(failed.state) == 2
    else:
        assert calls["n"] <= after
    armed = False
    assert run(system).jumps.tobytes() == run(ball()).jumps.tobytes()


@pytest.mark.parametrize("kind", [KeyboardInterrupt, SystemExit])
def test_what_is_no_failure_passes(kind):
    def does(place, value):
        if armed and place == "reset":
            raise kind
        return value

    armed = False
    system = ball(does)
    armed = True
    with pytest.raises(kind):
        run(system)


@settings(max_examples=80, deadline=None)
@given(where=WHERE, gives=st.sampled_from([None, "one", [], [1.0], [1.0, 2.0, 3.0], [[1.0, 2.0]], 1j, object(), {}, np.ones(3), float("nan"), [np.nan, 1.0], np.array(["a", "b"])]))  # fmt: skip
def test_what_is_no_number_is_refused(where, gives):
    armed = False
    system = ball(lambda place, value: gives if armed and place == where else value)
    armed = True
    if where == "guard" and isinstance(gives, list) and gives == [1.0]:
        assert run(system).count == 0  # a list of one is one number
        return
    with pytest.raises(saltus.RunError) as failed:
        run(system)
    says = str(failed.value)
    assert isinstance(failed.value.__cause__, (TypeError, ValueError)) or "not a number" in says or "finite" in says


def test_a_run_of_many_that_raises_is_a_row():
    def does(place, value):
        if armed and place == "reset":
            raise Broken("the sensor is gone")
        return value

    armed = False
    system = ball(does)
    armed = True
    many = system.ensemble("m", [[1.0, 0.0], [1000.0, 0.0]], (0, 1))
    assert many.stop.tolist() == ["failed", "time"] and "the sensor is gone" in many.why[0]


# -- memory


def used():
    gc.collect()
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def fails(call, *errors):
    try:
        call()
    except errors:
        return
    raise AssertionError("it did not fail")


TRACED = saltus.Hybrid(2).mode("m", lambda t, x: [x[1], -9.81])
TRACED.edge("m", "m", lambda t, x: x[0], lambda t, x: [0.0, -0.8 * x[1]])
CALLED = ball()
REPEATED = {
    "runs": (100_000, lambda: run(TRACED).jumps),
    "runs that fail": (100_000, lambda: fails(lambda: TRACED.run("m", [-1.0, 0.0], (0, 1)), saltus.RunError)),
    "runs of called functions": (2_000, lambda: run(CALLED)),
    "many runs": (2_000, lambda: TRACED.ensemble("m", np.ones((20, 2)), (0, 1))),
    "derivatives": (5_000, lambda: TRACED.gradient("m", [1.0, 0.0], (0, 1), by=["x0"])),
    "systems": (5_000, lambda: saltus.Hybrid(2).mode("m", lambda t, x: [x[1], -np.sin(x[0])]).run("m", [1, 0], (0, 0.1))),
    "scenes": (5_000, lambda: saltus.simulate(DROP, most_jumps=3).impacts),
    "scenes that fail": (5_000, lambda: fails(lambda: saltus.simulate(restitution=2.0, ball={}), saltus.SceneError)),
    "fits": (500, lambda: saltus.fit([100, 64, 41, 26], "cm", sigma_height="5 mm").cor),
    "tables that fail": (2_000, lambda: fails(lambda: saltus.fit({"a": ["x"]}), saltus.TableError)),
    "sweeps": (1_000, lambda: saltus.sweep(DROP, vary={"restitution": [0.5, 0.6]}, most_jumps=2, progress=False, chunk=2)),
}  # fmt: skip


@pytest.mark.parametrize("name", REPEATED)
def test_memory_is_flat(name):
    count, call = REPEATED[name]
    sizes = [used()]
    for _ in range(4):
        for _ in range(count // 4):
            call()
        sizes.append(used())
    # What leaks grows every time; what an allocator keeps, once.
    assert min(np.diff(sizes)) < 65_536


# -- Ctrl-C


def swing(traced):
    flow = (lambda t, x: [x[1], -x[0]]) if traced else (lambda t, x: [float(x[1]), -float(x[0])])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return saltus.Hybrid(2).mode("swing", flow)


def trials():
    random = np.random.default_rng(1)
    heights = np.tile(0.8 ** (2 * np.arange(8.0)), 1000) * (1 + 0.01 * random.normal(size=8000))
    return {"trial": np.repeat(np.arange(1000), 8), "bounce": np.tile(np.arange(8), 1000), "height_m": heights}


LONG = {
    "a run": lambda: swing(True).run("swing", [1.0, 0.0], (0, 1e12), method="dop853"),
    "a run of called functions": lambda: swing(False).run("swing", [1.0, 0.0], (0, 1e12), method="dop853"),
    "many runs": lambda: swing(True).ensemble("swing", np.ones((10_000_000, 2)), (0, 9)),
    "a derivative": lambda: swing(True).gradient("swing", [1.0, 0.0], (0, 1e12), by=["x0"], method="dop853"),
    "a scene": lambda: saltus.simulate(DROP | {"restitution": 0.9999999, "drag": {"per_length": 0.1}}, most_jumps=2_000_000, until=1e9),
    "a fit": lambda: saltus.fit(trials(), bootstrap=3000),
    "a sweep": lambda: saltus.sweep(DROP, vary={"restitution": "0.1:0.9:10000", "ball.height": "1:9:1000"}, progress=False),
}  # fmt: skip


CORE = {"run", "ensemble", "gradient", "simulate", "fit", "sweep_rows"}


@contextlib.contextmanager
def pressed_after(begun):
    """Presses Ctrl-C so many seconds after this thread has gone into compiled code; says when."""
    inside, over, pressed = threading.Event(), threading.Event(), []

    def calls(_, event, what):
        if event == "c_call" and what.__name__ in CORE:
            inside.set()

    def press():
        inside.wait()
        # Pressed after the end, it would end the tests.
        if not over.wait(begun):
            pressed.append(time.process_time())
            os.kill(os.getpid(), signal.SIGINT)

    # Programs that a shell starts in the background ignore it.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread = threading.Thread(target=press)
    thread.start()
    sys.setprofile(calls)
    try:
        yield pressed
    finally:
        sys.setprofile(None)
        over.set()
        inside.set()
        thread.join()
        signal.signal(signal.SIGINT, handler)


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_it(name):
    with pressed_after(0.05) as pressed, pytest.raises(KeyboardInterrupt):
        LONG[name]()
    # By the clock of this process, on which others that are busy do not count.
    assert time.process_time() - pressed[0] < 0.25 * os.cpu_count()
    time.sleep(0.3)  # the part that is under way ends
    rests = time.process_time()
    time.sleep(0.3)
    assert time.process_time() - rests < 0.1, "it goes on behind"
