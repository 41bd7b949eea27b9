"""The cost of stepping worlds from Python, compared with the program's own steps in the same run.

Usage: PYTHONPATH=build/release/python python3 python/bench/worlds.py
"""

import time

import numpy as np

import dihaptic as dh

BLOCK = "scenes/block-on-table.yaml"


def ticks(step):
    """Duration of a tick in which two fingers hold the block, from 1.5 s on [us]."""
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
    """Seconds for this many environments that hold the block, and for stepping the same worlds without environments."""
    many = dh.env.Grasps("lift", n)
    close = np.tile([1.0, 0, 0, -1.0, 0, 0], (n, 1)) / 2
    still = np.zeros((n, 6))
    steps = round(seconds / many.step_time)

    def held():
        many.reset()
        for _ in range(16):  # 24 mm each
            many.step(close)
        for _ in range(50):
            many.step(still)
        assert all(world["grip_force"] > 0.5 for world in many.worlds)
        return time.perf_counter()

    def environment():
        begin = held()
        for _ in range(steps):
            many.step(still)
        return time.perf_counter() - begin

    def alone():
        begin = held()
        for _ in range(steps):
            dh.step_all(many.worlds, many.ticks)
        return time.perf_counter() - begin

    # alternates them, and takes the shortest run of each: longer runs were disturbed
    taken = [(environment(), alone()) for _ in range(5)]
    return min(e for e, _ in taken), min(a for _, a in taken), n * steps


def main():
    own = ticks(lambda world, n: world.step(n))
    print(f"a tick of the program's own: {own:.2f} us")
    print(f"stepped one by one: {ticks(one_by_one) - own:+.2f} us; with a director that does nothing: {ticks(directed) - own:+.2f} us")
    environment, alone, steps = grasps()
    print(f"100 environments, 1 s: {steps / environment:.0f} steps a second, {steps / alone:.0f} of the worlds alone: {environment / alone:.2f} times the time")


if __name__ == "__main__":
    main()
