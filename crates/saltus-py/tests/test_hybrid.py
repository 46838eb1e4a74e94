"""Hybrid systems of plain functions: laws of the tracing, of runs, and of what fails."""

import math
import pickle
import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import saltus
from saltus._trace import trace


def ball(**values):
    return (
        saltus.Hybrid(["height", "velocity"], {"g": 9.81, "e": 0.8, **values})
        .mode("flight", lambda t, x, p: [x[1], -p.g])
        .edge("flight", "flight", lambda t, x, p: x[0], lambda t, x, p: [0.0, -p.e * x[1]])
    )


def drag_ball():
    return (
        saltus.Hybrid(2, {"k": 0.1, "e": 0.9})
        .mode("flight", lambda t, x, p: [x[1], -9.8 - p.k * x[1] * abs(x[1])])
        .edge("flight", "flight", lambda t, x, p: x[0], lambda t, x, p: [0.0, -p.e * x[1]])
    )


# -- what is traced


FUNCTIONS = {
    "arithmetic": lambda t, x, p: [x[0] + 2 * x[1] - t / 3, -x[0] * x[1] / (1 + x[0] ** 2) + p.k],
    "powers": lambda t, x, p: [-x[0] ** 3 + abs(x[1]) ** 1.5 + 2.0 ** -x[0], (1 + x[0] ** 2) ** -0.5 + (2 + t) ** x[1]],
    "circle": lambda t, x, p: [np.sin(x[0]) * np.cos(t), np.tan(0.3 * x[1]) + np.arctan2(x[1], x[0] + 2.5)],
    "growth": lambda t, x, p: [np.exp(-(x[0] ** 2)) + np.log(2 + x[1] ** 2), np.tanh(p.k * x[0]) + np.arctan(x[1])],
    "roots": lambda t, x, p: [np.sqrt(1 + x[0] ** 2), np.hypot(x[0], x[1]) + np.square(x[1]) + np.sinh(x[0])],
    "choices": lambda t, x, p: [np.minimum(x[0], x[1]), np.maximum(x[0], p.k) + np.clip(x[1], -0.5, 0.5)],
    "where": lambda t, x, p: [np.where(x[0] > x[1], x[0], 2 * x[1] - x[0]), np.where(x[0] < 0, 0.0, x[0] ** 2)],
    "arrays": lambda t, x, p: np.sin(x) * p.k - 0.5 * x[::-1] + np.maximum(x, 0) + np.array([[0, 1], [-1, 0]]) @ x,
    "sums": lambda t, x, p: [np.sum(x), np.dot(x, x)],
}  # fmt: skip


@pytest.mark.parametrize("name", FUNCTIONS)
@settings(max_examples=40, deadline=None)
@given(t=st.floats(0, 2), x=st.tuples(st.floats(-2, 2), st.floats(-2, 2)), k=st.floats(-1, 1))
def test_a_formula_has_the_values_of_its_function(name, t, x, k):
    function = FUNCTIONS[name]
    system = saltus.Hybrid(2, {"k": k}).mode("m", function)
    assert not system.called
    # A step so short that the slope is all there is to see.
    h = 2.0**-20
    slope = np.asarray(function(t, np.array(x), saltus._trace.Parameters({"k": k})), dtype=float)
    run = system.run("m", x, (t, t + h), method="tsit5")
    assert (run.state - x) / h == pytest.approx(slope, abs=2e-5 * (1 + np.abs(slope).max()) ** 3)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_series_and_steppers_agree(name):
    system = saltus.Hybrid(2, {"k": 0.4}).mode("m", FUNCTIONS[name])
    ends = {m: system.run("m", [0.7, -0.4], (0, 0.8), method=m, rtol=1e-10).state for m in ("series", "tsit5", "dop853", "rodas5p")}
    reference = ends["dop853"]
    for method, end in ends.items():
        assert end == pytest.approx(reference, rel=2e-7), method


def test_guards_that_are_affine_are_found():
    exact = ball().run("flight", [1.0, 0.0], (0, 3))
    assert exact.cost["exact"] == exact.count + 1 and exact.cost["steps"] == 0


@settings(max_examples=60, deadline=None)
@given(
    weights=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    level=st.floats(0.05, 2),
    g=st.floats(0, 5),
    start=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
)
def test_falls_by_formula_are_those_that_are_searched_for(weights, level, g, start):
    a, b = weights
    offset = level - a * start[0] - b * start[1]
    system = saltus.Hybrid(2).mode("m", lambda t, x: [x[1], -g])
    system.edge("m", "m", lambda t, x: a * x[0] + b * x[1] + offset, terminal=True)
    exact, searched = (system.run("m", start, (0, 9), method=method) for method in ("auto", "dop853"))
    assert exact.stop == searched.stop
    assert exact.t == pytest.approx(searched.t, abs=1e-6)


@pytest.mark.parametrize(
    ("flow", "says"),
    [
        (lambda t, x: [x[1], -1 if x[0] > 0 else 1], "numpy.where"),
        (lambda t, x: [min(x[0], 0.0), x[1]], "numpy.minimum"),
        (lambda t, x: [math.sin(x[0]), x[1]], "numpy.sin"),
        (lambda t, x: [x[0] % 1.0, x[1]], "remainder"),
        (lambda t, x: [np.floor(x[0]), x[1]], "numpy.floor"),
        (lambda t, x: np.linalg.solve(np.eye(2), np.array([x[0], x[1]], dtype=float)), "numpy"),
    ],
)
def test_what_cannot_be_traced_is_called_and_said_once(flow, says):
    with pytest.warns(saltus.TracingWarning, match=says) as warned:
        system = saltus.Hybrid(2).mode("m", flow)
    assert len(warned) == 1 and system.called
    run = system.run("m", [0.3, 0.2], (0, 0.1))
    peer = solve_ivp(lambda t, x: np.asarray(flow(t, x), dtype=float), (0, 0.1), [0.3, 0.2], rtol=1e-9, atol=1e-12)
    assert run.state == pytest.approx(peer.y[:, -1], rel=1e-7)


# -- runs


def test_a_ball_comes_to_its_limit_and_goes_on_beyond():
    run = ball().run("flight", [1.0, 0.0], (0, 6))
    limit = math.sqrt(2 / 9.81) * 1.8 / 0.2
    assert run.stop == "zeno" and run.limit == pytest.approx(limit, abs=1e-9)
    rests = ball().mode("rest", lambda t, x, p: [0.0, 0.0]).beyond("flight", "rest", lambda t, x, p: [0.0, 0.0])
    run = rests.run("flight", [1.0, 0.0], (0, 6))
    assert (run.stop, run.mode, run.jumps["edge"][-1]) == ("time", "rest", -1)
    assert run.mode_at([1.0, 5.0, 7.0]).tolist() == ["flight", "rest", ""]
    assert np.all(run.at(np.linspace(0, 6, 1000))[:, 0] >= 0)


def test_a_state_by_name():
    by_name = ball().run("flight", {"velocity": 0.5, "height": 1.0}, (0, 3))
    assert by_name.jumps.tobytes() == ball().run("flight", [1.0, 0.5], (0, 3)).jumps.tobytes()
    assert pickle.loads(pickle.dumps(by_name)).state.tolist() == by_name.state.tolist()


def test_both_limits_at_a_jump():
    run = ball().run("flight", [1.0, 0.0], (0, 1))
    jump = run.jumps[0]
    assert run.at(jump["t"], before=True).tolist() == jump["before"].tolist()
    assert run.at(jump["t"]).tolist() == jump["after"].tolist() == [0.0, -0.8 * jump["before"][1]]
    assert run.at([[0.0, 0.1], [0.2, 2.0]]).shape == (2, 2, 2) and np.isnan(run.at(2.0)).all()


def test_drag_has_the_times_of_a_closed_form():
    run = drag_ball().run("flight", [10.0, 0.0], (0, 5), method="series", rtol=1e-12)
    a = math.sqrt(9.8 * 0.1)
    assert run.jumps["t"][0] == pytest.approx(math.acosh(math.exp(0.1 * 10)) / a, abs=1e-11)


def test_terminal_edges_and_entries():
    drain = saltus.Hybrid(1).mode("drain", lambda t, x: [-1.0])
    drain.edge("drain", "drain", lambda t, x: x[0], terminal=True)
    assert drain.run("drain", [2.0], (0, 3)).stop == "terminal"
    with pytest.raises(saltus.RunError, match="already negative") as failed:
        drain.run("drain", [-1.0], (0, 3))
    assert (failed.value.t, failed.value.mode, failed.value.state) == (0.0, "drain", [-1.0])


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 16, 17, 40, 64])
def test_any_number_of_coordinates_up_to_64(n):
    rates = 0.5 + np.arange(n) / n
    system = saltus.Hybrid(n).mode("m", lambda t, x: -rates * x)
    for method in ("series", "dop853", "rodas5p"):
        run = system.run("m", np.ones(n), (0, 1), method=method)
        assert run.state == pytest.approx(np.exp(-rates), abs=1e-7)


def test_stiff_flows():
    rod = saltus.Hybrid(1).mode("heat", lambda t, x: [1e6 * (np.sin(t) - x[0])])
    for method in ("steps", "rodas5p"):
        run = rod.run("heat", [0.0], (0, 3), method=method)
        assert run.state[0] == pytest.approx(math.sin(3.0), abs=1e-5) and run.cost["flows"] < 20_000


# -- clocks and slides


@settings(max_examples=60, deadline=None)
@given(period=st.floats(0.01, 1), phase=st.one_of(st.none(), st.floats(0, 1)), start=st.floats(-2, 2), first=st.booleans())
def test_clocks_tick_at_multiples_rounded_once(period, phase, start, first):
    end = start + 3
    counter = saltus.Hybrid(1).mode("run", lambda t, x: [0.0])
    counter.clock("run", "run", lambda t, x: [x[0] + 1], every=period, after=phase, from_start=first)
    run = counter.run("run", [0.0], (start, end))
    k = np.arange(0 if phase is not None else np.floor(start / period) - 1, np.ceil(end / period) + 2)
    ticks = (phase or 0.0) + k * period
    near = 1e-12 * (1 + np.abs(ticks))  # a tick at the very end, or at the start, is as rounding has it
    wanted = ticks[(ticks > start + near) & (ticks < end - near)]
    found = run.jumps["t"]
    found = found[(found > start + 1e-12 * 4) & (found < end - 1e-12 * 4)]
    assert found == pytest.approx(wanted, rel=1e-15, abs=1e-15) and run.state[0] == run.count


def test_clocks_at_times_of_their_own_in_order():
    system = saltus.Hybrid(2).mode("day", lambda t, x: [0.0, 0.0]).mode("night", lambda t, x: [0.0, 0.0])
    system.clock("day", "night", at=[0.75, 1.25], every=2.0)
    system.clock("night", "day", lambda t, x: [x[0] + 1, t], at=[1.0, 1.25, 2.0])
    system.clock("night", "night", lambda t, x: [10 * x[0], x[1]], at=[1.25])
    run = system.run("day", [0.0, 0.0], (0.0, 3.0))
    assert [(j["t"], j["from"], j["to"]) for j in run.jumps] == [
        (0.75, "day", "night"), (1.0, "night", "day"), (1.25, "day", "night"), (1.25, "night", "day"), (2.75, "day", "night"),
    ]  # fmt: skip
    assert run.state.tolist() == [2.0, 1.25] and run.mode == "night"
    again = pickle.loads(pickle.dumps(run))
    assert again.jumps.tobytes() == run.jumps.tobytes()


def rubbing(friction, stiffness):
    block = saltus.Hybrid(["place", "speed"], {"rub": friction, "k": stiffness})
    block.mode("forth", lambda t, x, p: [x[1], -p.k * x[0] - p.rub]).mode("back", lambda t, x, p: [x[1], -p.k * x[0] + p.rub])
    return block.slide("sticks", "forth", "back", lambda t, x, p: x[1])


@settings(max_examples=80, deadline=None)
@given(rub=st.floats(0.1, 5), k=st.floats(1, 200), start=st.floats(0.05, 3), method=st.sampled_from(["auto", "series", "dop853"]))
def test_a_block_that_rubs_sticks_where_the_closed_form_says(rub, k, start, method):
    held = rub / k  # the spring holds it within this of its rest
    run = rubbing(rub, k).run("back" if start > held else "sticks", [start, 0.0], (0, 500), method=method)
    place, swings = start, 0
    while abs(place) > held:
        place = -place + math.copysign(2 * held, place)
        swings += 1
    if abs(abs(place) - held) < 1e-6 or swings > 40:
        return  # which swing is the last is a matter of rounding
    assert run.mode == "sticks" and run.state[0] == pytest.approx(place, abs=1e-6 * start) and abs(run.state[1]) < 1e-12
    assert run.count == swings
    turns = math.pi / math.sqrt(k) * np.arange(1, swings + 1)
    assert run.jumps["t"] == pytest.approx(turns, abs=1e-6)


@settings(max_examples=40, deadline=None)
@given(up=st.floats(-3, -0.06), down=st.floats(0.01, 3), across=st.tuples(st.floats(-2, 2), st.floats(-2, 2)))
def test_a_slide_is_the_mixture_that_stays_on_a_curved_surface(up, down, across):
    """On a circle: out of it with speed `up` above, `down` below, and around it with `across`."""

    def flow(out, around):
        return lambda t, x: [out * x[0] - around * x[1], out * x[1] + around * x[0]]

    system = saltus.Hybrid(2).mode("out", flow(up, across[0])).mode("in", flow(down, across[1]))
    system.slide("on", "out", "in", lambda t, x: x[0] ** 2 + x[1] ** 2 - 1)
    run = system.run("out", [1.5, 0.0], (0, 8))
    met = -math.log(1.5) / up
    share = down / (down - up)
    turned = across[0] * met + (share * across[0] + (1 - share) * across[1]) * (8 - met)
    assert run.mode == "on" and run.jumps["t"] == pytest.approx([met], abs=1e-7)
    assert run.state == pytest.approx([math.cos(turned), math.sin(turned)], abs=1e-6)


def test_a_flow_that_leads_through_crosses():
    system = saltus.Hybrid(1).mode("above", lambda t, x: [-1.0]).mode("below", lambda t, x: [-2.0])
    system.slide("on", "above", "below", lambda t, x: x[0])
    run = system.run("above", [1.0], (0, 2))
    assert run.jumps["to"].tolist() == ["below"] and run.state[0] == -2.0


def test_what_slides_is_pickled_and_made_many_times():
    system, rub = rubbing(3.0, 100.0), np.linspace(1, 5, 20)
    many = pickle.loads(pickle.dumps(system)).ensemble("back", [[0.1, 0.0]], (0, 10), {"rub": rub})
    for n in (0, 7, 19):
        one = system.run("back", [0.1, 0.0], (0, 10), {"rub": rub[n]})
        assert many.state[n].tolist() == one.state.tolist() and many.mode[n] == one.mode == "sticks"


def test_what_a_called_flow_raises_on_a_surface_is_the_cause():
    def above(t, x):
        if x[0] < 1e-9:
            raise KeyError("the belt is gone")
        return [-1.0]

    with pytest.warns(saltus.TracingWarning):
        system = saltus.Hybrid(1).mode("above", above)
    system.mode("below", lambda t, x: [1.0]).slide("on", "above", "below", lambda t, x: x[0])
    with pytest.raises(saltus.RunError) as failed:
        system.run("above", [1.0], (0, 2))
    assert isinstance(failed.value.__cause__, KeyError)


# -- derivatives


@settings(max_examples=60, deadline=None)
@given(rub=st.floats(0.1, 2), k=st.floats(4, 100), start=st.floats(0.3, 3))
def test_derivatives_of_a_block_that_comes_to_stick(rub, k, start):
    """After n swings it lies at (-1)ⁿ (x - 2 n rub/k), for ever, since n π/√k."""
    held = rub / k
    n = math.ceil((start / held - 1) / 2)
    if n < 1 or n > 25 or abs(start - 2 * n * held) > 0.98 * held:
        return  # which swing is the last is a matter of rounding
    sign = (-1) ** n
    block = rubbing(rub, k)
    gradient = block.gradient("back", [start, 0.0], (0, 100), by=["rub", "k", "place"], rtol=1e-12)
    known = np.array([[-sign * 2 * n / k, 0], [sign * 2 * n * rub / k**2, 0], [sign, 0]])
    assert gradient.end == pytest.approx(known, rel=1e-8, abs=1e-8)
    swings = np.arange(1, n + 1)
    times = np.array([0 * swings, -0.5 * math.pi * k**-1.5 * swings, 0 * swings])
    assert gradient.times == pytest.approx(times, rel=1e-8, abs=1e-8)


@settings(max_examples=60, deadline=None)
@given(up=st.floats(-3, -0.3), down=st.floats(0.3, 3), over=st.floats(-2, 2), under=st.floats(-2, 2), radius=st.floats(0.5, 1.3))
def test_derivatives_along_a_curved_surface(up, down, over, under, radius):
    """It meets the circle at ln(R/x)/up, and goes round with the mixture."""

    def flow(out, around):
        def turned(t, x, p):
            u, w = getattr(p, out), getattr(p, around)
            return [u * x[0] - w * x[1], u * x[1] + w * x[0]]

        return turned

    values = {"up": up, "down": down, "over": over, "under": under, "R": radius}
    system = saltus.Hybrid(2, values).mode("out", flow("up", "over")).mode("in", flow("down", "under"))
    system.slide("on", "out", "in", lambda t, x, p: x[0] ** 2 + x[1] ** 2 - p.R**2)
    far, end = 1.5, 8.0
    gradient = system.gradient("out", [far, 0.0], (0, end), by=[*values, "x0"], rtol=1e-12)
    met, share, gap = math.log(radius / far) / up, down / (down - up), (down - up) ** 2
    around = share * over + (1 - share) * under
    left = end - met
    by_met = np.array([-met / up, 0, 0, 0, 1 / (radius * up), -1 / (far * up)])
    mixed = (over - under) * left
    turns = np.array([mixed * down / gap, -mixed * up / gap, met + share * left, (1 - share) * left, 0, 0])
    angle, turns = over * met + around * left, turns + (over - around) * by_met
    along, out = np.array([-math.sin(angle), math.cos(angle)]), np.array([math.cos(angle), math.sin(angle)])
    known = radius * np.outer(turns, along)
    known[4] += out
    assert gradient.end == pytest.approx(known, rel=1e-7, abs=1e-7)
    assert gradient.times[:, 0] == pytest.approx(by_met, rel=1e-9, abs=1e-9)


def test_derivatives_of_a_slide_with_a_clock_and_an_edge_of_its_own():
    """Carried by a belt until a clock nudges it, through a gate that it meets as it slides, and off the belt."""
    block = saltus.Hybrid(["place", "speed"], {"belt": 0.5, "rub": 2.0, "k": 3.0, "nudge": 0.1, "gate": 0.45})
    block.mode("slower", lambda t, x, p: [x[1], -p.k * x[0] + p.rub]).mode("faster", lambda t, x, p: [x[1], -p.k * x[0] - p.rub])
    block.slide("sticks", "faster", "slower", lambda t, x, p: x[1] - p.belt)
    block.clock("sticks", "sticks", lambda t, x, p: [x[0] + p.nudge, x[1]], at=[0.6])
    block.edge("sticks", "slower", lambda t, x, p: p.gate - x[0], lambda t, x, p: [x[0], 0.8 * x[1]], entry="wait")
    state, span, by = [0.0, 0.2], (0.0, 1.9), [*block.parameters, *block.names]
    gradient = block.gradient("slower", state, span, by=by, rtol=1e-12)
    jumps = block.run("slower", state, span, rtol=1e-12).jumps
    assert jumps["to"].tolist()[:3] == ["sticks", "sticks", "slower"] and len(jumps) > 3
    for k, name in enumerate(by):
        ends = []
        for step in (-2, -1, 1, 2):
            start, values, h = list(state), {}, 1e-4 * step
            if name in block.names:
                start[block.names.index(name)] += h
            else:
                values[name] = block.values[name] + h
            ends.append(block.run("slower", start, span, values, rtol=1e-13))
        ends = [np.concatenate([run.state, run.jumps["t"]]) for run in ends]
        fourth = (ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / 12e-4
        assert np.concatenate([gradient.end[k], gradient.times[k]]) == pytest.approx(fourth, rel=1e-7, abs=1e-7), name


def test_derivatives_of_an_end_that_is_not_determined():
    """Both flows lose their push at t = 1/b: until then the derivatives are there, and how the end moves is not."""
    fading = saltus.Hybrid(2, {"b": 0.8}).mode("above", lambda t, x, p: [p.b * t - 1, 2.0])
    fading.mode("below", lambda t, x, p: [1 - p.b * t, 4.0]).slide("on", "above", "below", lambda t, x, p: x[0])
    gradient = fading.gradient("on", [0.0, 0.0], (0, 2), by=["b", "x1"])
    assert np.isnan(gradient.times).all() and gradient.end == pytest.approx(np.array([[0, 0], [0, 1]]), abs=1e-9)


@pytest.mark.parametrize("make", [ball, drag_ball])
def test_derivatives_are_those_of_neighbouring_runs(make):
    system = make()
    state, span = [1.0, 0.5], (0.0, 1.7)
    by = [*system.parameters, *system.names]
    gradient = system.gradient("flight", state, span, by=by, rtol=1e-11)
    named = system.gradient("flight", dict(zip(reversed(system.names), reversed(state))), span, by=by, rtol=1e-11)
    assert np.array_equal(named.end, gradient.end) and np.array_equal(named.times, gradient.times)
    for k, name in enumerate(by):
        ends = []
        for sign in (1, -1):
            h, start, values = 1e-5 * sign, list(state), {}
            if name in system.names:
                start[system.names.index(name)] += h
            else:
                values[name] = system.values[name] + h
            ends.append(system.run("flight", start, span, values, rtol=1e-12))
        assert gradient.end[k] == pytest.approx((ends[0].state - ends[1].state) / 2e-5, rel=1e-4, abs=1e-5)
        times = (ends[0].jumps["t"] - ends[1].jumps["t"]) / 2e-5
        assert gradient.times[k] == pytest.approx(times, rel=1e-4, abs=1e-6)


# -- many runs


def test_an_ensemble_is_its_runs_to_the_bit():
    system, e = drag_ball(), np.linspace(0.5, 0.95, 50)
    many = system.ensemble("flight", [[1.0, 0.0]], (0, 3), {"e": e, "k": 0.2})
    assert len(many) == 50
    for n in (0, 17, 49):
        one = system.run("flight", [1.0, 0.0], (0, 3), {"e": e[n], "k": 0.2})
        assert many.state[n].tolist() == one.state.tolist() and many.jumps[n] == one.count
        assert many.stop[n] == one.stop and many.mode[n] == one.mode


def test_a_run_that_fails_is_a_row():
    growth = saltus.Hybrid(1).mode("grow", lambda t, x: x**2)
    many = growth.ensemble("grow", [[0.1], [1.0]], (0, 2))
    assert many.stop.tolist() == ["time", "failed"] and "the solution may blow up" in many.why[1]
    assert many.state[0, 0] == pytest.approx(1 / 8) and np.isnan(many.state[1, 0])


def test_systems_and_runs_are_pickled():
    run = ball().run("flight", [1.0, 0.0], (0, 3), {"e": 0.7})
    again = pickle.loads(pickle.dumps(run))
    assert again.jumps.tobytes() == run.jumps.tobytes() and again.state.tolist() == run.state.tolist()


def test_another_thread_runs_meanwhile():
    system, ticks, done = drag_ball(), [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    system.ensemble("flight", [[1.0, 0.0]], (0, 10), {"e": np.linspace(0.5, 0.95, 4000)})
    done.set()
    thread.join()
    assert len(ticks) > 3 and np.max(np.diff(ticks)) < 0.2


# -- what fails


@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        (lambda: saltus.Hybrid(0).mode("m", lambda t, x: []).run("m", [], (0, 1)), ValueError, "1 to 64"),
        (lambda: saltus.Hybrid(65).mode("m", lambda t, x: -x).run("m", np.ones(65), (0, 1)), ValueError, "1 to 64"),
        (lambda: saltus.Hybrid(2).mode("m", lambda t, x: [x[0]]).run("m", [1, 2], (0, 1)), ValueError, "gives 1 numbers and not 2"),
        (lambda: saltus.Hybrid(1).mode("m", 3.0), TypeError, "no function"),
        (lambda: ball().run("flight", [1.0], (0, 1)), ValueError, "1 coordinates and not 2"),
        (lambda: ball().run("fly", [1.0, 0.0], (0, 1)), ValueError, "no mode 'fly'"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1), {"x": 1}), ValueError, "no parameter 'x'"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1), method="euler"), ValueError, "'euler' is no method"),
        (lambda: ball().run("flight", ["one", 0.0], (0, 1)), ValueError, "could not convert"),
        (lambda: ball().run("flight", [math.nan, 0.0], (0, 1)), saltus.RunError, "not finite"),
        (lambda: ball().run("flight", [1.0, 0.0], (1, 0)), saltus.RunError, "span"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1), rtol=-1), saltus.RunError, "tolerances"),
        (lambda: ball().edge("flight", "gone", lambda t, x, p: x[0]).run("flight", [1, 0], (0, 1)), ValueError, "'gone', which is not declared"),
        (lambda: ball().ensemble("flight", np.ones((3, 2)), (0, 1), {"e": [0.1, 0.2]}), ValueError, "e has 2 rows, and others have 3"),
        (lambda: ball().gradient("flight", [1.0, 0.0], (0, 1), by=["mass"]), ValueError, "'mass'"),
        (lambda: ball().clock("flight", "flight"), TypeError, "ticks every="),
        (lambda: ball().clock("flight", "gone", every=1.0).run("flight", [1, 0], (0, 1)), ValueError, "'gone', which is not declared"),
        (lambda: ball().clock("flight", "flight", every=0.0).run("flight", [1, 0], (0, 1)), saltus.RunError, "has a period of 0 s"),
        (lambda: rubbing(1.0, 1.0).gradient("sticks", [0.5, 0], (0, 1), by=["speed"]), saltus.RunError, "leads off it"),
        (lambda: rubbing(1.0, 1.0).run("sticks", [1, 0.5], (0, 1)), saltus.RunError, "is on the surface"),
        (lambda: saltus.Hybrid(1).slide("on", "a", "b", lambda t, x: math.sin(x[0])), TypeError, "must be a formula"),
        (lambda: saltus.Hybrid(1).slide("on", "a", "b", lambda t, x: x[0]).run("on", [0], (0, 1)), ValueError, "'a', which is not declared"),
        (lambda: saltus.Hybrid(["a", "b", "a"]), ValueError, "named 'a'"),
        (lambda: saltus.Hybrid(["k"], {"k": 1.0}), ValueError, "named 'k'"),
        (lambda: ball().mode("flight", lambda t, x: x), TypeError, r"the flow of flight takes \(t, x\), and is called with \(t, x, p\)"),
        (lambda: saltus.Hybrid(1).edge("m", "m", lambda x: x[0]), TypeError, r"takes \(x\), and is called with \(t, x\)"),
        (lambda: ball().run("flight", [1.0, 0.0], 6.0), TypeError, r"the span 6.0 is no \(start, end\)"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1), rtol="1e-9"), TypeError, "rtol is a str and no number"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1), most_jumps=2.5), TypeError, "most_jumps is a float and no whole number"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1), most_jumps=-1), ValueError, "most_jumps is -1"),
        (lambda: ball().run("flight", {"height": 1.0}, (0, 1)), ValueError, "'velocity' is missing from the state"),
        (lambda: ball().gradient("flight", {"height": 1.0}, (0, 1)), ValueError, "'velocity' is missing from the state"),
        (lambda: ball().gradient("flight", [1.0, 0.0], 6.0), TypeError, r"the span 6.0 is no \(start, end\)"),
        (lambda: ball().run("flight", {"height": 1.0, "speed": 0.0, "velocity": 0.0}, (0, 1)), ValueError, "'speed' is no coordinate"),
        (lambda: ball().run("flight", [1.0, 0.0], (0, 1)).plot("height", "speed"), ValueError, "no coordinate 'speed'"),
        (lambda: saltus.Hybrid(1, ["k"]).mode("m", lambda t, x, p: [p.k]).run("m", [1], (0, 1)), ValueError, "without a value: k"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_in_words(given, error, says):
    with pytest.raises(error, match=says):
        given()


def test_a_limit_on_bytes_ends_a_run():
    swing = saltus.Hybrid(2).mode("swing", lambda t, x: [x[1], -x[0]])
    run = swing.run("swing", [1.0, 0.0], (0, math.inf), most_bytes=1_000_000)
    assert run.stop == "bytes" and run.t > 1.0


def test_the_trace_shares_what_is_the_same():
    formula = trace(lambda t, x: [np.sin(x[0]) * np.sin(x[0]), np.sin(x[0])], 2, [], False)
    ops, _, _, _ = formula.__reduce__()[1]
    assert len(ops) == 3
