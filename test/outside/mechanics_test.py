"""Mechanics that other engines got wrong in public, with their right values. docs/outside.md has the sources.

Usage: outside/mechanics_test.py PROGRAM, from the project's folder.
"""
import math
import os
import pathlib
import sys
import tempfile
import unittest

import made_meshes as made
import numpy as np

sys.path.append("test/cli")
from program import PROGRAM, dihaptic, session_of
import soak  # program.py adds its folder to the path

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(PROGRAM)), "python"))
import dihaptic as dh  # noqa: E402

SOLVERS = ("newton", "staggered_projections", "stewart_trinkle", "sequential_impulse")
G = 9.81


def scene(bodies, gravity=(0, 0, -G), **more):
    """Bodies alone: the hand stays far away."""
    return dh.Scene(title="outside", gravity_m_s2=list(gravity), bodies=bodies, object=bodies[-1].name,
                    hand=dh.Part(centre_mm=[0, 0, 2000], aperture_mm=400, script=[dh.Part(name="wait", duration_s=1)]), **more)


def world(bodies, solver="newton", **more):
    return dh.World(scene(bodies, **more), settings={"dynamics.solver": solver})


def rotation(quaternion):
    w, x, y, z = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def about(axis, angle):
    return (math.cos(angle / 2), *(math.sin(angle / 2) * np.asarray(axis, float)))


TABLE = dh.Part(name="table", shape="box", size_mm=[8000, 2000, 50], position_mm=[0, 0, -25], fixed=True, friction=0.8)
PLANE = dh.Part(name="plane", shape="plane", fixed=True, friction=0.8)
SIDEWAYS = about([1, 0, 0], math.pi / 2)
UPRIGHT = (1, 0, 0, 0)


class FreeRotation(unittest.TestCase):
    def test_a_brick_that_tumbles_keeps_momentum_and_energy(self):
        moments = 0.2 / 12 * np.array([0.06**2 + 0.02**2, 0.1**2 + 0.02**2, 0.1**2 + 0.06**2])
        for speed in (10, 30):
            for axis in range(3):
                with self.subTest(speed=speed, axis=axis):
                    w = world([dh.Part(name="brick", shape="box", size_mm=[100, 60, 20], mass_g=200, position_mm=[0, 0, 500])],
                              gravity=(0, 0, 0))
                    begins = np.full(3, 0.01 * speed)
                    begins[axis] = speed
                    brick = w.bodies["brick"]
                    brick.place((0, 0, 0.5), angular_velocity=tuple(begins))
                    energy, momentum = [], []
                    for _ in range(400):
                        w.step(50)
                        R = rotation(brick.orientation)
                        local = R.T @ brick.angular_velocity
                        energy.append(local @ (moments * local) / 2)
                        momentum.append(R @ (moments * local))
                    energy, momentum = np.array(energy), np.array(momentum)
                    size = np.linalg.norm(momentum[0])
                    self.assertLess(np.linalg.norm(momentum - momentum[0], axis=1).max(), 1e-9 * size)
                    self.assertLess(abs(energy / energy[0] - 1).max(), 1e-4)
                    self.assertLess(abs(energy[:100].mean() / energy[-100:].mean() - 1), 1e-6)

    @soak.alone
    def test_a_top_on_its_tip_precesses_steadily(self):
        radius, height, arm, tip, mass, tilt = 0.03, 0.01, 0.05, 0.002, 0.2, math.radians(20)
        disc, ball = math.pi * radius**2 * height, 4 / 3 * math.pi * tip**3
        of_disc, of_ball = mass * disc / (disc + ball), mass * ball / (disc + ball)
        centre = of_disc * arm / mass
        along = of_disc * radius**2 / 2 + 0.4 * of_ball * tip**2
        across = (of_disc * (3 * radius**2 + height**2) / 12 + of_disc * (arm - centre)**2 + 0.4 * of_ball * tip**2
                  + of_ball * centre**2)
        axis = np.array([math.sin(tilt), 0, math.cos(tilt)])
        for solver in SOLVERS:
            for spin in (150, 250, 400):
                with self.subTest(solver=solver, spin=spin):
                    a, b, c = across * math.cos(tilt), along * spin, mass * G * centre
                    precession = (b - math.sqrt(b * b - 4 * a * c)) / (2 * a)
                    turns = np.array([0, 0, precession]) + (spin - precession * math.cos(tilt)) * axis
                    w = world([dh.Part(name="plane", shape="plane", fixed=True, friction=0),
                               dh.Part(name="top", shape="compound", mass_g=1e3 * mass, friction=0, position_mm=[0, 0, 2], parts=[
                                   dh.Part(shape="cylinder", radius_mm=30, length_mm=10, position_mm=[0, 0, 50]),
                                   dh.Part(shape="sphere", radius_mm=2)])], solver)
                    top = w.bodies["top"]
                    origin = np.array([0, 0, tip + centre * math.cos(tilt)]) - centre * axis
                    top.place(tuple(origin), about([0, 1, 0], tilt), tuple(np.cross(turns, -centre * axis)), tuple(turns))
                    azimuth = []
                    for _ in range(200):
                        w.step(50)
                        now = rotation(top.orientation)[:, 2]
                        self.assertAlmostEqual(math.degrees(math.acos(now[2])), 20, delta=0.5)
                        azimuth.append(math.atan2(now[1], now[0]))
                    turned = np.unwrap(azimuth)[-1]
                    self.assertAlmostEqual(math.degrees(turned - precession * 10), 0, delta=0.5)


class RoundShapes(unittest.TestCase):
    def test_a_can_that_is_nudged_goes_on_as_it_was(self):
        for solver in SOLVERS:
            for ground in (TABLE, PLANE):
                for speed in (0.02, 0.35):
                    with self.subTest(solver=solver, ground=ground.name, speed=speed):
                        w = world([ground, dh.Part(name="can", shape="cylinder", radius_mm=20, length_mm=60, mass_g=100,
                                                   position_mm=[-1000, 0, 20], friction=0.8)], solver)
                        can = w.bodies["can"]
                        can.place((-1, 0, 0.02), SIDEWAYS, (speed, 0, 0), (0, speed / 0.02, 0))
                        w.step(6000)
                        self.assertAlmostEqual(can.velocity[0], speed, delta=1e-4 * speed)
                        heading = math.degrees(math.atan2(can.velocity[1], can.velocity[0]))
                        self.assertLess(abs(heading), 0.01)

    def test_small_fast_things_do_not_pass_through_thin_plates(self):
        shapes = {"capsule": dict(shape="capsule", radius_mm=0.5, length_mm=2), "pen": dict(shape="cylinder", radius_mm=4, length_mm=100),
                  "ball": dict(shape="sphere", radius_mm=0.3), "cube": dict(shape="box", size_mm=[2, 2, 2]),
                  "cone": dict(shape="cone", radius_mm=1, length_mm=3), "peg": dict(shape="cone", radius_mm=4, length_mm=100)}
        random = np.random.default_rng(1)
        for name, shape in shapes.items():
            for speed in (5, 20, 60, 99):
                for thickness in (1, 0.1):
                    with self.subTest(name, speed=speed, thickness=thickness):
                        w = world([dh.Part(name="plate", shape="box", size_mm=[thickness, 400, 400], fixed=True, position_mm=[0, 0, 500]),
                                   dh.Part(name="thing", mass_g=1, position_mm=[-200, 0, 500], **shape)], gravity=(0, 0, 0))
                        thing = w.bodies["thing"]
                        turn = random.normal(size=3)
                        thing.place((-0.2 - 1e-3 * random.random(), *(0.05 * random.random(2) + (0, 0.5))),
                                    about(turn / np.linalg.norm(turn), 3 * random.random()), (speed, 0, 0), tuple(20 * random.normal(size=3)))
                        for _ in range(100):
                            w.step(1)
                            self.assertLess(thing.position[0], 0)

    @soak.alone
    def test_two_that_meet_at_fifty_metres_a_second_do_not_pass_through_each_other(self):
        for shape in (dict(shape="sphere", radius_mm=1), dict(shape="box", size_mm=[2, 2, 2]), dict(shape="capsule", radius_mm=1, length_mm=3),
                      dict(shape="cone", radius_mm=1, length_mm=3)):
            with self.subTest(shape["shape"]):
                w = world([dh.Part(name=name, mass_g=1, position_mm=[x, 0, 500], **shape) for name, x in (("a", -90), ("b", 90))],
                          gravity=(0, 0, 0))
                for name, sign in (("a", 1), ("b", -1)):
                    # one cone's base meets the other's tip; if it met it off-centre, each would spin thousands of times a second
                    turned = about([0, 1, 0], math.pi / 2) if shape["shape"] == "cone" else UPRIGHT
                    w.bodies[name].place((-0.09 * sign, 0, 0.5), turned, (50 * sign, 0, 0))
                w.step(20)
                self.assertLess(w.bodies["a"].position[0], w.bodies["b"].position[0])

    @soak.alone
    def test_seams_between_flush_boxes_are_not_felt(self):
        tiles = [dh.Part(name=f"tile{i}", shape="box", size_mm=[40, 200, 20], position_mm=[40 * i, 0, -10], fixed=True, friction=0.8)
                 for i in range(10)]
        rollers = {"block": dict(shape="box", size_mm=[40, 40, 40], friction=0), "ball": dict(shape="sphere", radius_mm=20),
                   "capsule": dict(shape="capsule", radius_mm=20, length_mm=60),
                   "can": dict(shape="cylinder", radius_mm=20, length_mm=60),
                   "cone": dict(shape="cone", radius_mm=20, length_mm=40, friction=0)}
        for name, roller in rollers.items():
            with self.subTest(name):
                w = world([*tiles, dh.Part(name=name, mass_g=100, position_mm=[0, 0, 20], **{"friction": 0.8, **roller})])
                body = w.bodies[name]
                turned = SIDEWAYS if name in ("capsule", "can") else UPRIGHT
                body.place((0, 0, 0.02), turned, (0.35, 0, 0), (0, 0 if name in ("block", "cone") else 0.35 / 0.02, 0))
                for _ in range(95):
                    w.step(10)
                    self.assertAlmostEqual(body.velocity[0], 0.35, delta=3.5e-4)
                    self.assertAlmostEqual(body.position[2], 0.02, delta=1e-5)


    @soak.alone
    def test_a_cone_rolls_on_its_side_about_its_tip(self):
        for radius, height, rate in ((0.02, 0.06, 1), (0.03, 0.02, 2), (0.01, 0.1, 1)):
            for ground in (TABLE, PLANE):
                for solver in SOLVERS:
                    with self.subTest(radius=radius, height=height, ground=ground.name, solver=solver):
                        lean = math.atan(radius / height)
                        w = world([ground, dh.Part(name="cone", shape="cone", radius_mm=1e3 * radius, length_mm=1e3 * height, mass_g=100,
                                                   position_mm=[0, 0, 100], friction=0.8)], solver)
                        lies = about([0, 1, 0], -math.pi / 2 - lean)
                        begin = rotation(lies) @ (0, 0, -height / 2)
                        turns = np.array([-rate / math.tan(lean), 0, 0])
                        cone = w.bodies["cone"]
                        cone.place(tuple(begin), lies, tuple(np.cross(turns, begin)), tuple(turns))
                        w.step(2000)
                        there = (begin[0] * math.cos(2 * rate), begin[0] * math.sin(2 * rate), begin[2])
                        self.assertLess(np.linalg.norm(np.array(cone.position) - there), 5e-4 * height)

    @soak.alone
    def test_a_tippe_top_turns_over_and_keeps_jelletts_invariant(self):
        # a ball with a smaller one inside, of twice the density
        radius, inner, off, spin = 0.02, 0.014, 0.005, 220
        share = inner**3 / (radius**3 + inner**3)
        centre = off * share / radius
        along = 0.4 * (radius**2 * (1 - share) + inner**2 * share)
        for solver in SOLVERS:
            with self.subTest(solver):
                w = world([PLANE, dh.Part(name="top", shape="compound", mass_g=30, friction=0.2, position_mm=[0, 0, 20], parts=[
                    dh.Part(shape="sphere", radius_mm=1e3 * radius),
                    dh.Part(shape="sphere", radius_mm=1e3 * inner, position_mm=[0, 0, -1e3 * off])])], solver)
                top = w.bodies["top"]
                top.place((0, 0, radius), about([1, 0, 0], 0.1), (0, 0, 0), (0, 0, spin))
                w.step(10000)
                self.assertLess(rotation(top.orientation)[2, 2], -0.99)
                across = along + (1 - share) * share * off**2
                axis = np.array([0, -math.sin(0.1), math.cos(0.1)])
                momentum = across * np.array([0, 0, spin]) + (along - across) * spin * axis[2] * axis
                kept = momentum @ ((0, 0, 1) - centre * axis) / (1 + centre)
                self.assertAlmostEqual(along * np.linalg.norm(top.angular_velocity) / kept, 1, delta=2e-3)

    @soak.alone
    def test_eulers_disc_begins_as_its_equation_says(self):
        radius, thickness = 0.03, 0.0005
        for tilt in (0.15, 0.4, 0.8):
            with self.subTest(tilt=tilt):
                w = world([PLANE, dh.Part(name="disc", shape="cylinder", radius_mm=1e3 * radius, length_mm=1e3 * thickness, mass_g=50,
                                          position_mm=[0, 0, 100], friction=1)])
                turned = about([1, 0, 0], tilt)
                rate = math.sqrt(4 * G / (radius * math.sin(tilt)))
                disc = w.bodies["disc"]
                disc.place((0, 0, radius * math.sin(tilt) + thickness / 2 * math.cos(tilt)), turned, (0, 0, 0),
                           tuple(rate * math.sin(tilt) * rotation(turned)[:, 1]))
                azimuth = []
                for _ in range(50):
                    w.step(1)
                    axis = rotation(disc.orientation)[:, 2]
                    azimuth.append(math.atan2(axis[1], axis[0]))
                self.assertAlmostEqual((np.unwrap(azimuth)[-1] - azimuth[0]) / 0.049 / rate, 1, delta=0.03)
                self.assertAlmostEqual(math.acos(axis[2]) / tilt, 1, delta=0.03)


class Impacts(unittest.TestCase):
    def test_a_cradle_keeps_its_energy_whatever_its_gaps(self):
        radius, length, angle = 0.02, 0.3, math.radians(20)
        speed = math.sqrt(2 * G * length * (1 - math.cos(angle)))
        for gap in (0, 0.0001, 0.0005, 0.002):
            with self.subTest(gap=gap):
                balls, strings = [], []
                for i in range(5):
                    x = i * (2 * radius + gap)
                    lifted = angle if i == 0 else 0
                    place = [1e3 * (x - length * math.sin(lifted)), 0, 500 - 1e3 * length * math.cos(lifted)]
                    balls.append(dh.Part(name=f"ball{i}", shape="sphere", radius_mm=20, mass_g=100, friction=0, position_mm=place,
                                         surface=dh.Part(restitution=1)))
                    strings += [dh.Part(name=f"string{i}{side}", kind="distance", between=[f"ball{i}"], recorded=False,
                                        position_mm=[1e3 * x, 100 * side, 500], second_position_mm=place) for side in (-1, 1)]
                w = world(balls, joints=strings)
                w.step(2)
                while w.bodies["ball4"].velocity[0] < 0.1 * speed:
                    w.step(2)
                w.step(6)
                v = np.array([w.bodies[f"ball{i}"].velocity[0] for i in range(5)]) / speed
                self.assertAlmostEqual((v**2).sum(), 1, delta=0.01)
                self.assertAlmostEqual(v.sum(), 1, delta=0.01)
                if gap >= 0.0005:
                    self.assertAlmostEqual(v[4], 1, delta=0.01)

    @soak.alone
    def test_a_heavy_block_rests_on_a_light_one(self):
        for light_g, heavy_g in ((1, 1e3), (1, 1e5)):
            with self.subTest(light_g=light_g, heavy_g=heavy_g):
                w = world([TABLE, dh.Part(name="light", shape="box", size_mm=[40, 40, 40], position_mm=[0, 0, 20], mass_g=light_g, friction=0.8),
                           dh.Part(name="heavy", shape="box", size_mm=[40, 40, 40], position_mm=[6, -5, 60], mass_g=heavy_g, friction=0.8)])
                w.step(3000)
                self.assertAlmostEqual(w.bodies["heavy"].position[2], 0.06, delta=1e-6)
                self.assertAlmostEqual(w.bodies["heavy"].position[0], 0.006, delta=1e-6)


    def test_a_box_bounces_as_high_from_a_smaller_one(self):
        small = dh.Part(name="small", shape="box", size_mm=[75, 75, 20], position_mm=[0, 0, -10], fixed=True, friction=0)
        for solver in SOLVERS:
            for restitution in (1, 0.5):
                with self.subTest(solver=solver, restitution=restitution):
                    w = world([small, dh.Part(name="box", shape="box", size_mm=[100, 100, 100], mass_g=500, friction=0,
                                              position_mm=[0, 0, 150], surface=dh.Part(restitution=restitution))], solver)
                    w.step(145)
                    height = []
                    for _ in range(290):
                        w.step(1)
                        height.append(w.bodies["box"].position[2] - 0.05)
                    self.assertAlmostEqual(max(height), 0.1 * restitution**2, delta=2e-5)
                    self.assertLess(np.abs(w.bodies["box"].angular_velocity).max(), 1e-3)

    @soak.alone
    def test_a_body_that_may_go_one_way_is_hit_obliquely(self):
        normal = np.array([math.cos(math.radians(35)), math.sin(math.radians(35)), 0])
        for solver in SOLVERS:
            for restitution in (0, 0.5, 1):
                with self.subTest(solver=solver, restitution=restitution):
                    w = world([dh.Part(name="carriage", shape="sphere", radius_mm=30, mass_g=300, position_mm=[0, 0, 500], moves="x",
                                       turns="none", friction=0),
                               dh.Part(name="ball", shape="sphere", radius_mm=10, mass_g=100, position_mm=[-200, 0, 500], friction=0,
                                       surface=dh.Part(restitution=restitution))], solver, gravity=(0, 0, 0))
                    ball = w.bodies["ball"]
                    ball.place(tuple(np.array([0, 0, 0.5]) - 0.041 * normal), UPRIGHT, tuple(normal))
                    w.step(30)
                    impulse = (1 + restitution) / (1 / 0.1 + normal[0]**2 / 0.3)
                    self.assertLess(abs(w.bodies["carriage"].velocity - [impulse * normal[0] / 0.3, 0, 0]).max(), 1e-6)
                    self.assertLess(abs(ball.velocity - (1 - impulse / 0.1) * normal).max(), 1e-6)


class Friction(unittest.TestCase):
    def test_stops_a_block_after_the_same_way_in_every_direction(self):
        wanted = 1 / (2 * 0.5 * G) - 0.5e-3  # less half of the distance travelled in a tick
        for solver in SOLVERS:
            for direction in (0, 15, 45, 70):
                for yaw in (0, 0.5):
                    with self.subTest(solver=solver, direction=direction, yaw=yaw):
                        way = np.array([math.cos(math.radians(direction)), math.sin(math.radians(direction)), 0])
                        w = world([dh.Part(name="table", shape="plane", fixed=True, friction=0.5),
                                   dh.Part(name="block", shape="box", size_mm=[80, 20, 20], mass_g=100, position_mm=[0, 0, 10],
                                           friction=0.5)], solver)
                        block = w.bodies["block"]
                        block.place((0, 0, 0.01), about([0, 0, 1], yaw), tuple(way))
                        w.step(400)
                        self.assertAlmostEqual(block.position @ way, wanted, delta=1e-5)
                        self.assertLess(abs(np.cross(way, block.position)[2]), 1e-7)

    @soak.alone
    def test_holds_up_to_its_limit_and_no_further(self):
        for solver in SOLVERS:
            for ratio in (0.95, 0.999, 1.001):
                with self.subTest(solver=solver, ratio=ratio):
                    slope = math.atan(0.8 * ratio)
                    down = G * math.sin(slope) * np.array([math.cos(1), math.sin(1), 0])
                    w = world([PLANE, dh.Part(name="block", shape="box", size_mm=[80, 80, 10], mass_g=100, position_mm=[0, 0, 5],
                                              friction=0.8)], solver, gravity=(down[0], down[1], -G * math.cos(slope)))
                    w.step(3000)
                    speed = max(0, 3 * G * (math.sin(slope) - 0.8 * math.cos(slope)))
                    self.assertLess(abs(w.bodies["block"].velocity - speed * down / np.linalg.norm(down)).max(), 1e-5)
                    if ratio < 1:
                        self.assertLess(abs(w.bodies["block"].position - [0, 0, 0.005]).max(), 1e-6)

    def test_holds_a_drawer_on_a_slanting_rail(self):
        for solver in SOLVERS:
            for axis in ([0, 0, 1], [1, 2, 3]):
                for stop, friction in ((-100, 1 / 0.97), (0, 0)):
                    with self.subTest(solver=solver, axis=axis, stop=stop):
                        load = 0.1 * G * axis[2] / np.linalg.norm(axis)
                        w = world([dh.Part(name="drawer", shape="box", size_mm=[40, 40, 20], mass_g=100, position_mm=[0, 0, 500])], solver,
                                  joints=[dh.Part(name="rail", kind="slider", between=["drawer"], position_mm=[30, 10, 500], axis=axis,
                                                  friction_N=friction * load, low_mm=stop, high_mm=100)])
                        w.step(10000)
                        self.assertLess(abs(w.bodies["drawer"].position - [0, 0, 0.5]).max(), 1e-8)


class Rest(unittest.TestCase):
    def test_what_lost_its_support_while_it_slept_falls(self):
        for solver in SOLVERS:
            with self.subTest(solver=solver):
                w = world([PLANE, dh.Part(name="below", shape="box", size_mm=[100, 100, 40], mass_g=500, position_mm=[0, 0, 20]),
                           dh.Part(name="above", shape="box", size_mm=[40, 40, 40], mass_g=100, position_mm=[0, 0, 60])], solver)
                w.step(2000)
                w.bodies["below"].place((0.5, 0, 0.02))
                w.step(50)
                self.assertAlmostEqual(w.bodies["above"].position[2], 0.06 - G / 2 * 0.05**2, delta=3e-4)

    @soak.alone
    def test_a_pan_rises_when_its_load_is_taken_away(self):
        w = world([dh.Part(name="pan", shape="box", size_mm=[100, 100, 20], mass_g=100, position_mm=[0, 0, 500]),
                   dh.Part(name="load", shape="box", size_mm=[40, 40, 40], mass_g=200, position_mm=[0, 0, 530])],
                  joints=[dh.Part(name="spring", kind="slider", between=["pan"], position_mm=[0, 0, 500], axis=[0, 0, 1], stiffness_N_m=200,
                                  damping_Ns_m=5)])
        for mass, load_at in ((0.3, None), (0.1, (0.5, 0, 0.5))):
            if load_at:
                w.bodies["load"].place(load_at)
            w.step(10000 if not load_at else 3000)
            self.assertAlmostEqual(w.bodies["pan"].position[2], 0.5 - mass * G / 200, delta=1e-6)

    @soak.alone
    def test_small_cylinders_neither_roll_nor_sink(self):
        for solver in SOLVERS:
            for radius, length in ((7.5, 20), (0.5, 1.3)):
                for far in (0, 95000):
                    with self.subTest(solver=solver, radius=radius, far=far):
                        ground = dh.Part(name="table", shape="box", size_mm=[2500, 2500, 50], position_mm=[far, 0, -25], fixed=True)
                        w = world([ground, dh.Part(name="pin", shape="cylinder", radius_mm=radius, length_mm=length, density_g_cm3=1,
                                                   position_mm=[far, 0, radius])], solver)
                        begins = (far / 1e3, 0, radius / 1e3)
                        w.bodies["pin"].place(begins, SIDEWAYS)
                        w.step(3000)
                        self.assertLess(abs(w.bodies["pin"].position - begins).max(), 1e-9)


class Drives(unittest.TestCase):
    def on_a_plate(self, folder, bodies, states):
        """An experiment whose states drive a plate with bodies on it."""
        pathlib.Path(folder, "scene.yaml").write_text(f"""object: block
bodies:
  - {{ name: plate, shape: box, size_mm: [500, 500, 20], position_mm: [0, 0, -10], driven: yes, friction: 0.5 }}
{bodies}hand: {{ centre_mm: [0, 0, 1500], aperture_mm: 400, script: [{{ name: wait, duration_s: 1 }}] }}
""")
        file = pathlib.Path(folder, "driven.yaml")
        file.write_text(f"""title: driven
scene: scene.yaml
task:
  states:
{states}  blocks: [{{ name: b, kind: baseline, repeats: 1 }}]
""")
        return file

    def test_a_block_stays_where_it_lies_on_a_turntable(self):
        """With another one on top; the plate speeds up and slows down so gently that friction holds both.

        Lemke's method takes 6 ms for a tick of this: its turn speeds up as fast, and ends sooner."""
        for solver in soak.of(["newton", "sequential_impulse"], SOLVERS):
            share = 0.25 if solver == "stewart_trinkle" else 1
            with self.subTest(solver=solver), tempfile.TemporaryDirectory() as name:
                file = self.on_a_plate(name, """\
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [50, 0, 20], friction: 0.5 }
  - { name: above, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [60, 10, 60], friction: 0.5 }
""", f"""\
    - {{ name: turn, exits: [{{ when: time, after_s: {6 * share ** 0.5 + 1}, outcome: done }}],
        drive: [{{ body: plate, axis: [0, 0, 1], angle_deg: {720 * share}, duration_s: {6 * share ** 0.5} }}] }}
""")
                result = dihaptic("run", str(file), "--out", name, "--solver", solver)
                self.assertEqual(result.returncode, 0, result.stderr)
                session = dh.load(session_of(name))
                side = -1 if share == 0.25 else 1  # the plate ends after half a turn
                for body, at in (("block", (0.05, 0, 0.02)), ("above", (0.06, 0.01, 0.06))):
                    self.assertLess(abs(session[body + ".position"][-2] - np.multiply(at, (side, side, 1))).max(), 1e-5)

    @soak.alone
    def test_that_follow_the_time_in_a_state_begin_at_its_beginning(self):
        """What lies on the plate is carried along without a slip: it needs less than friction gives."""
        with tempfile.TemporaryDirectory() as name:
            file = self.on_a_plate(name, """\
  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [100, 0, 20], friction: 0.5 }
""", """\
    - { name: rest, exits: [{ when: time, after_s: 1, to: shake }] }
    - name: shake
      drive: [{ body: plate, along: [30 mm * (1 - cos(11.3 * time_in_state / (1 s))), 0 mm, 0 mm] }]
      exits: [{ when: time, after_s: 1, outcome: done }]
""")
            result = dihaptic("run", str(file), "--out", name)
            self.assertEqual(result.returncode, 0, result.stderr)
            session = dh.load(session_of(name))
            plate, block = session["plate.position"][:-1, 0], session["block.position"][:-1, 0] - 0.1
            self.assertLess(np.abs(np.diff(plate)).max(), 1.01e-3 * 0.03 * 11.3)
            self.assertGreater(plate.max(), 0.0599)
            self.assertLess(np.abs(plate - block).max(), 1e-7)


class Arriving(unittest.TestCase):
    def test_a_ball_that_bounces_obliquely_is_turned_by_the_friction_at_its_surface(self):
        """Wherever in a tick it arrives: dw = mu (1 + e) v m r / I while it slips, and 5 v / 7 r once it rolls."""
        mu, across, speed = 0.1, 4, 2
        for solver in soak.of(["newton", "sequential_impulse"], SOLVERS):
            for radius in (0.005, 0.02):
                for gap in (1e-5, 5e-4, 1.9e-3):
                    for restitution in (0, 0.7):
                        with self.subTest(solver=solver, radius=radius, gap=gap, restitution=restitution):
                            w = world([dh.Part(name="plane", shape="plane", fixed=True, friction=mu),
                                       dh.Part(name="ball", shape="sphere", radius_mm=1e3 * radius, mass_g=50, friction=mu,
                                               position_mm=[0, 0, 500], surface={"restitution": restitution})],
                                      solver, gravity=(0, 0, 0))  # fmt: skip
                            ball = w.bodies["ball"]
                            ball.place((0, 0, radius + gap), UPRIGHT, (across, 0, -speed), (0, 0, 0))
                            w.step(20)
                            lost = min(mu * (1 + restitution) * speed, across * 2 / 7)
                            self.assertAlmostEqual(ball.velocity[0], across - lost, delta=1e-6)
                            self.assertAlmostEqual(ball.angular_velocity[1] * radius / (2.5 * lost), 1, delta=1e-6)

    def test_two_balls_that_meet_obliquely_are_turned_alike(self):
        radius, mu, speed, across = 0.005, 0.02, 1, 0.3
        for gap in (1e-5, 9e-4):
            with self.subTest(gap=gap):
                balls = [dh.Part(name=name, shape="sphere", radius_mm=1e3 * radius, mass_g=50, friction=mu, position_mm=[x, 0, 500])
                         for name, x in (("left", 0), ("right", 100))]  # fmt: skip
                w = world(balls, gravity=(0, 0, 0))
                left, right = w.bodies["left"], w.bodies["right"]
                left.place((0, 0, 0.5), UPRIGHT, (speed / 2, across / 2, 0), (0, 0, 0))
                right.place((2 * radius + gap, 0, 0.5), UPRIGHT, (-speed / 2, -across / 2, 0), (0, 0, 0))
                w.step(20)
                lost = mu * speed / 2  # each: the impulse is that of the reduced mass
                for ball in (left, right):  # their normal turns by 0.03 in a tick
                    self.assertAlmostEqual(ball.angular_velocity[2] * radius / (-2.5 * lost), 1, delta=0.04)


class Rods(unittest.TestCase):
    def circles(self, length, speed, high=None):
        """A ball on a rod, or on a rope, that circles about a point; its largest and its smallest distance, and its speed."""
        rope = {} if high is None else {"high_mm": 1e3 * high}
        joint = dh.Part(name="rod", kind="distance", between=["ball"], position_mm=[0, 0, 500],
                        second_position_mm=[1e3 * length, 0, 500], **rope)  # fmt: skip
        w = world([dh.Part(name="ball", shape="sphere", radius_mm=5, mass_g=100, position_mm=[1e3 * length, 0, 500])],
                  gravity=(0, 0, 0), joints=[joint])  # fmt: skip
        ball = w.bodies["ball"]
        ball.place((length, 0, 0.5), UPRIGHT, (0, speed, 0), (0, 0, 0))
        distances = []
        for _ in range(300):
            w.step(1)
            distances.append(np.linalg.norm(np.subtract(ball.position, (0, 0, 0.5))))
        return min(distances[1:]), max(distances), np.linalg.norm(ball.velocity)

    def test_a_rod_keeps_its_length_however_fast_it_turns(self):
        for length, speed in ((0.01, 2), (0.1, 9.5), (0.1, 12), (0.1, 20), (0.1, 30), (1, 40)):
            with self.subTest(length=length, speed=speed):
                shortest, longest, now = self.circles(length, speed)
                self.assertAlmostEqual(shortest, length, delta=1e-6)
                self.assertAlmostEqual(longest, length, delta=1e-6)
                # velocities are those in the middle of a step
                self.assertAlmostEqual(now / speed, 1, delta=0.02)

    def test_a_rope_is_not_stretched_by_what_circles_on_it(self):
        for length, speed in ((0.1, 9.5), (0.1, 20)):
            with self.subTest(length=length, speed=speed):
                _, longest, _ = self.circles(length, speed, high=length)
                self.assertLess(longest, length + 1e-5)


class Concave(unittest.TestCase):
    @soak.alone
    def test_a_ring_lies_flat_on_a_table(self):
        """Its pieces have corners in line and faces that are hardly as thick as rounding."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "ring.obj")
            file.write_bytes(made.obj(made.torus(30, 8, 16, 8)))
            for solver in SOLVERS:
                with self.subTest(solver=solver):
                    w = world([TABLE, dh.Part(name="ring", shape="mesh", file=str(file), unit="mm", concave=True, mass_g=100,
                                              position_mm=[0, 0, 9])], solver)
                    w.step(500)
                    self.assertLess(abs(w.bodies["ring"].position - (0, 0, 0.008)).max(), 1e-5)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
