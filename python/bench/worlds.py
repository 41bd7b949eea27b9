"""What it costs to step worlds from Python, beside the program's own steps in the same run.

Usage: PYTHONPATH=build/release/python python3 python/bench/worlds.py
"""

import time

import numpy as np

import dihaptic as dh

BLOCK = "scenes/block-on-table.yaml"


def best(call, times=5):
    """Shortest of several runs [s]: the others were disturbed."""
    taken = []
    for _ in range(times):
        begin = time.perf_counter()
        call()
        taken.append(time.perf_counter() - begin)
    return min(taken)


def ticks(step):
    """Time of a tick of two fingers that hold the block, from 1.5 s on [us]."""
    world = dh.World(BLOCK)
    n = 1000

    def run():
        world.reset()
        world.step(1500)
        begin = time.perf_counter()
        step(world, n)
        return time.perf_counter() - begin

    return min(run() for _ in range(7)) / n * 1e6


def one_by_one(world, n):
    for _ in range(n):
        world.step()


def directed(world, n):
    world.step(n, lambda w: None)


def grasps(n=100, seconds=1.0):
    """Seconds for so many environments, and for the same worlds without Python between steps."""
    many = dh.env.Grasps("lift", n)
    still = np.zeros((n, 6))
    steps = round(seconds / many.step_time)

    def environment():
        many.reset()
        begin = time.perf_counter()
        for _ in range(steps):
            many.step(still)
        return time.perf_counter() - begin

    def alone():
        many.reset()
        begin = time.perf_counter()
        dh.step_all(many.worlds, steps * many.ticks)
        return time.perf_counter() - begin

    return min(environment() for _ in range(3)), min(alone() for _ in range(3)), n * steps


def main():
    own = ticks(lambda world, n: world.step(n))
    print(f"a tick of the program's own: {own:.2f} us")
    print(f"stepped one by one: {ticks(one_by_one) - own:+.2f} us; with a director that does nothing: {ticks(directed) - own:+.2f} us")
    environment, alone, steps = grasps()
    print(f"100 environments, 1 s: {steps / environment:.0f} steps a second, {steps / alone:.0f} without Python: {environment / alone:.2f} times the time")


if __name__ == "__main__":
    main()
