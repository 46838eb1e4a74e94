"""Three systems against heyoka.py and SciPy, at equal error: needs both, and the wheel.

P1: ten impacts of a ball without air. P2: twenty with drag k v |v|. P5: the 1000 zeros of cos.
"""

import time

import heyoka as hy
import numpy as np
from scipy.integrate import solve_ivp

import saltus

G = 9.8


BATCH = 2e-3
"""Seconds of a batch of calls, in which the clock of the processor (0.5 us a look) is nothing."""


def usual(run, budget=0.4):
    """What it gives, and the time that it takes on the processor, in s: the median of batches.

    Not the least of single calls: the clock of the processor now and then loses some of its time, as
    when the process moves to another core, and the least of many would be such a call.
    """
    value, times, count = run(), [], 1
    end = time.perf_counter() + budget
    while len(times) < 3 or time.perf_counter() < end:
        start = time.process_time_ns()
        for _ in range(count):
            value = run()
        took = (time.process_time_ns() - start) * 1e-9
        if took < BATCH:
            count *= 2
        else:
            times.append(took / count)
    return value, float(np.median(times))


def row(name, run, times, reference):
    value, took = usual(run)
    error = np.max(np.abs(np.asarray(times(value))[: len(reference)] - reference))
    print(f"{name:42s} {1e6 * took:12.2f} us  error {error:.1e}")


def falls(height, e, count):
    first = np.sqrt(2 * height / G)
    return first * (1 + 2 * np.cumsum([0.0, *e ** np.arange(1, count)]))


def drag_falls(height, k, e, count):
    """The closed form: falls with speed √(g/k) tanh, rises with √(g/k) tan."""
    t, times, a, u = 0.0, [], np.sqrt(G * k), np.sqrt(G / k)
    for _ in range(count):
        t += np.arccosh(np.exp(k * height)) / a
        times.append(t)
        v = e * u * np.sqrt(-np.expm1(-2 * k * height))
        t += np.arctan(v / u) / a
        height = np.log1p((v / u) ** 2) / (2 * k)
    return np.array(times)


def bounces(flow, height, e, count, method, rtol):
    """The same by `solve_ivp`, started again after each event."""

    def ground(t, x):
        return x[0]

    ground.terminal, ground.direction = True, -1

    def run():
        t, x, times = 0.0, [height, 0.0], []
        while len(times) < count:
            part = solve_ivp(flow, (t, t + 100.0), x, method=method, events=ground, rtol=rtol, atol=rtol)
            t = part.t_events[0][-1]
            times.append(t)
            x = [0.0, -e * part.y_events[0][-1][1]]
        return times

    return run


def heyoka_ball(k, e, count, tol, height):
    h, v = hy.make_vars("h", "v")
    times = []

    def impact(ta, sign):
        times.append(ta.time)
        ta.state[0], ta.state[1] = 0.0, -e * ta.state[1]
        if k:
            ta.pars[0] = 1.0
        return len(times) < count

    def top(ta, sign):
        ta.pars[0] = -1.0
        return True

    down = hy.event_direction.negative
    events = [hy.t_event(h, callback=impact, direction=down)]
    if k:
        events.append(hy.t_event(v, callback=top, direction=down))
    speed = -G - k * hy.par[0] * v * v if k else hy.expression(-G)
    ta = hy.taylor_adaptive([(h, v), (v, speed)], [height, 0.0], pars=[-1.0] if k else [], t_events=events, tol=tol)

    def run():
        times.clear()
        ta.time, ta.state[:] = 0.0, [height, 0.0]
        if k:
            ta.pars[0] = -1.0
        ta.reset_cooldowns()
        ta.propagate_until(1000.0)
        return times

    return run


def main():
    p1, p2, p5 = falls(1.0, 0.8, 10), drag_falls(10.0, 0.1, 0.9, 20), (np.arange(1000) + 0.5) * np.pi
    ball = saltus.Hybrid(2, ["g", "e"]).mode("f", lambda t, x, p: [x[1], -p.g])
    ball.edge("f", "f", lambda t, x, p: x[0], lambda t, x, p: [0.0, -p.e * x[1]])
    given = {"g": G, "e": 0.8}
    row("P1 saltus", lambda: ball.run("f", [1.0, 0.0], (0, 100), given, most_jumps=10), lambda r: r.jumps["t"], p1)
    for tol in (1e-6, 1e-10):
        row(f"P1 heyoka {tol:g}", heyoka_ball(0, 0.8, 10, tol, 1.0), list, p1)
    row("P1 scipy RK45 1e-6", bounces(lambda t, x: [x[1], -G], 1.0, 0.8, 10, "RK45", 1e-6), list, p1)

    drag = saltus.Hybrid(2, ["k", "e"]).mode("f", lambda t, x, p: [x[1], -G - p.k * x[1] * abs(x[1])])
    drag.edge("f", "f", lambda t, x, p: x[0], lambda t, x, p: [0.0, -p.e * x[1]])
    given = {"k": 0.1, "e": 0.9}
    for tol in (1e-7, 1e-9, 1e-11, 1e-13):
        run = lambda: drag.run("f", [10.0, 0.0], (0, 100), given, rtol=tol, most_jumps=20)  # noqa: B023, E731
        row(f"P2 saltus {tol:g}", run, lambda r: r.jumps["t"], p2)
    for tol in (1e-6, 1e-10):
        row(f"P2 heyoka {tol:g}", heyoka_ball(0.1, 0.9, 20, tol, 10.0), list, p2)
    flow = lambda t, x: [x[1], -G - 0.1 * x[1] * abs(x[1])]  # noqa: E731
    for tol in (1e-8, 1e-11):
        row(f"P2 scipy DOP853 {tol:g}", bounces(flow, 10.0, 0.9, 20, "DOP853", tol), list, p2)

    swing = lambda t, x: [x[1], -x[0]]  # noqa: E731
    zeros = saltus.Hybrid(2).mode("p", swing).mode("n", swing)
    zeros.edge("p", "n", lambda t, x: x[0]).edge("n", "p", lambda t, x: -x[0])
    for tol in (1e-7, 1e-9, 1e-11, 1e-13):
        # heyoka.py allows each coordinate an error relative to the largest.
        run = lambda: zeros.run("p", [1.0, 0.0], (0, 1000 * np.pi), rtol=tol, atol=tol)  # noqa: B023, E731
        row(f"P5 saltus {tol:g}", run, lambda r: r.jumps["t"], p5)
    h, v = hy.make_vars("h", "v")
    for tol in (1e-8, 1e-12):
        times = []
        event = hy.nt_event(h, lambda ta, t, sign: times.append(t))  # noqa: B023
        ta = hy.taylor_adaptive([(h, v), (v, -h)], [1.0, 0.0], nt_events=[event], tol=tol)

        def run():
            times.clear()  # noqa: B023
            ta.time, ta.state[:] = 0.0, [1.0, 0.0]  # noqa: B023
            ta.propagate_until(1000 * np.pi)  # noqa: B023
            return times  # noqa: B023

        row(f"P5 heyoka {tol:g}", run, list, p5)
    peer = lambda: solve_ivp(swing, (0, 1000 * np.pi), [1.0, 0.0], "DOP853", events=lambda t, x: x[0], rtol=1e-10, atol=1e-10)  # noqa: E731
    row("P5 scipy DOP853 1e-10", peer, lambda r: r.t_events[0], p5)

    still = saltus.Hybrid(2).mode("m", lambda t, x: [0.0, 0.0])
    print(f"a call that does nothing: {1e6 * usual(lambda: still.run('m', [1.0, 0.0], (0.0, 1.0)))[1]:.2f} us")
    e = np.linspace(0.5, 0.9, 20_000)
    many, took = usual(lambda: drag.ensemble("f", [[10.0, 0.0]], (0, 5), {"k": 0.1, "e": e}), 2.0)
    print(f"ensemble: {1e6 * took / many.jumps.sum():.2f} us of the processors a jump, {len(e)} runs")


if __name__ == "__main__":
    main()
