# SPDX-License-Identifier: BSD-3-Clause
"""The Python package: motions against closed forms, and what happens when something is wrong."""

import ast
import base64
import gc
import inspect
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest
import unittest.mock
from html import unescape

import numpy

import se3d

VIEWER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "viewer"

G = 9.81


def pendulum(system, length=1.0):
    """A slender bar of 1 kg, hinged at its end, that lies level."""
    bar = system.body(name="bar", mass=1, inertia=(1e-3, length**2 / 12, length**2 / 12),
                      position=(length / 2, 0, 0))
    pin = system.joint("revolute", system.ground, bar, at=(0, 0, 0), axis=(0, 1, 0), name="pin")
    return bar, pin


class Motion(unittest.TestCase):
    def test_bar_speed_follows_from_energy(self):
        with se3d.System() as system:
            bar, pin = pendulum(system)
            se3d.Solver(system, tolerance=1e-10).run(0.5)
            drop = -bar.position[2]
            self.assertAlmostEqual(pin.angle_rate**2, 3 * G * 2 * drop, delta=1e-7)
            self.assertAlmostEqual(system.energy.total, 0.0, delta=1e-8)
            self.assertLess(max(system.violation), 1e-9)

    def test_oscillator_is_a_cosine(self):
        with se3d.System(gravity=(0, 0, 0)) as system:
            block = system.body(mass=2, inertia=numpy.eye(3), position=(1.5, 0, 0))
            slide = system.joint("prismatic", system.ground, block, at=(0, 0, 0), axis=(1, 0, 0))
            spring = system.tsda(system.ground, block, k=8, l0=1)
            se3d.Solver(system, tolerance=1e-10).run(2.0)
            self.assertAlmostEqual(block.position[0], 1 + 0.5 * numpy.cos(4), delta=1e-8)
            self.assertAlmostEqual(spring.coordinate, block.position[0], delta=1e-12)
            self.assertAlmostEqual(slide.displacement_rate, -numpy.sin(4), delta=1e-7)
            spring.set("k", 2)
            self.assertEqual(spring.get("k"), 2)

    def test_driver_by_text_callable_and_table_agree(self):
        t = numpy.linspace(0, 1, 2001)
        functions = ("0.3*sin(2*t)",
                     lambda t: (0.3 * numpy.sin(2 * t), 0.6 * numpy.cos(2 * t),
                                -1.2 * numpy.sin(2 * t)),
                     (t, 0.3 * numpy.sin(2 * t)))
        efforts = []
        for function in functions:
            with se3d.System() as system:
                _, pin = pendulum(system)
                driver = system.driver(pin, "angle", function)
                se3d.Solver(system, "inverse_dynamics", step=0.01).run(0.5)
                efforts.append(driver.effort)
                angle, acceleration = 0.3 * numpy.sin(1), -1.2 * numpy.sin(1)
                self.assertAlmostEqual(driver.effort, acceleration / 3 - G / 2 * numpy.cos(angle),
                                       delta=1e-4)
        self.assertAlmostEqual(efforts[0], efforts[1], delta=1e-12)

    def test_force_callback_is_a_spring(self):
        def pull(_time, _i, j):
            wrench = numpy.zeros(12)
            wrench[6:9] = -8 * j.r
            return wrench

        with se3d.System(gravity=(0, 0, 0)) as system:
            block = system.body(mass=2, inertia=(1, 1, 1), position=(0.5, 0, 0))
            system.force_callback(pull, system.ground, block,
                                  energy=lambda _time, _i, j: 4 * j.r @ j.r)
            self.assertAlmostEqual(system.energy.potential, 1.0, delta=1e-15)
            se3d.Solver(system, tolerance=1e-10).run(2.0)
            self.assertAlmostEqual(block.position[0], 0.5 * numpy.cos(4), delta=1e-8)
            self.assertAlmostEqual(system.energy.total, 1.0, delta=1e-8)
            self.assertAlmostEqual(system.work.actuators, 0.0, delta=1e-8)

    def test_user_constraint_keeps_a_distance(self):
        def sphere(_time, body):
            jacobian = numpy.zeros(6)
            jacobian[:3] = 2 * body.r
            return body.r @ body.r - 1, jacobian, 0.0, -2 * body.v @ body.v

        with se3d.System() as system, se3d.System() as other:
            ball = system.body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0))
            system.user_constraint(sphere, [ball])
            twin = other.body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0))
            other.joint("distance", other.ground, twin, distance=1)
            for s in (system, other):
                se3d.Solver(s, tolerance=1e-10).run(0.7)
            numpy.testing.assert_allclose(ball.position, twin.position, atol=1e-8)

    def test_efforts_in_bulk_hold_a_pendulum(self):
        with se3d.System() as system:
            _, pin = pendulum(system)
            effort = system.effort(pin, name="motor")
            system.efforts = [-G / 2]
            solver = se3d.Solver(system)
            for _ in range(50):
                solver.step(0.01)
            self.assertAlmostEqual(pin.angle, 0, delta=1e-9)
            self.assertEqual(effort.value, -G / 2)
            numpy.testing.assert_array_equal(system.efforts, [-G / 2])

    def test_coordinates_give_the_equations(self):
        with se3d.System() as system:
            bar, _ = pendulum(system)
            tip = system.marker(name="tip", body=bar, position=(0.5, 0, 0))
            tree = se3d.Coordinates(system)
            self.assertAlmostEqual(tree.mass_matrix()[0, 0], 1 / 3, delta=1e-12)
            self.assertAlmostEqual(tree.accelerations()[0], 1.5 * G, delta=1e-10)
            self.assertAlmostEqual(tree.efforts()[0], -G / 2, delta=1e-12)
            numpy.testing.assert_allclose(tree.jacobian(tip)[:, 0], (0, 1, 0, 0, 0, -1),
                                          atol=1e-12)
            tree.set([0.5], [2.0])
            q, qdot = tree.get()
            self.assertAlmostEqual(q[0], 0.5, delta=1e-12)
            self.assertAlmostEqual(qdot[0], 2.0, delta=1e-12)

    def test_states_of_a_batch_move_on_their_own(self):
        with se3d.System() as system:
            bar, _ = pendulum(system)
            batch = se3d.Batch(system, 11, threads=2)
        weights = numpy.zeros((11, 3))
        weights[:, 2] = -numpy.arange(11.0)
        batch.set_gravity(weights)
        batch.set_efforts(numpy.full((11, 1), 0.5))
        self.assertEqual((batch.velocity_count, batch.position_count), (1, 1))
        expected = (0.5 + 0.5 * numpy.arange(11.0)) * 3
        numpy.testing.assert_allclose(batch.accelerations()[:, 0], expected, rtol=1e-12)
        numpy.testing.assert_allclose(batch.efforts(batch.accelerations()), 0.5, atol=1e-12)
        batch.set_mass(bar, [2.0], [2e-4, 2 / 12, 2 / 12, 0, 0, 0], first=3)
        self.assertAlmostEqual(batch.accelerations()[3, 0], 0.75 + 4.5, delta=1e-12)
        batch.set(q=[[0.1]], qdot=[[0.2]], first=7)
        batch.time = 1.0
        batch.step(0.01, 10)
        numpy.testing.assert_allclose(batch.time, 1.1, rtol=1e-15)
        q, qdot = batch.get()
        self.assertEqual(q.shape, (11, 1))
        self.assertAlmostEqual(q[0, 0], 0.5 * 1.5 * 0.1**2, delta=1e-15)
        self.assertGreater(qdot[7, 0], 0.2)
        self.assertFalse(batch.status.any())
        with self.assertRaisesRegex(se3d.Error, "within the 11 states"):
            batch.set(q=[[0.0]], first=11)

    def test_events_are_found_and_may_stop(self):
        with se3d.System() as system:
            _, pin = pendulum(system)
            solver = se3d.Solver(system)
            seen = []
            solver.event(lambda: pin.angle, level=0.5, name="half", direction="rising",
                         motion_only=True, callback=seen.append)
            solver.event(lambda: pin.angle, level=1.0, action="stop", name="one")
            self.assertEqual(solver.run(2.0), se3d.STATUS["INFO_EVENT"])
            self.assertEqual([event.name for event in solver.events], ["half", "one"])
            self.assertEqual(seen[0].time, solver.events[0].time)
            self.assertAlmostEqual(pin.angle, 1.0, delta=1e-12)
            self.assertTrue(solver.events[1].stopped)

    def test_ball_rests_on_a_plane(self):
        with se3d.System() as system:
            rubber = system.material(density=1000, stiffness=1e4, restitution=0.3)
            ball = system.body(mass=1, inertia=(0.004,) * 3, position=(0, 0, 0.0995))
            system.shape("plane", material=rubber)
            system.shape("sphere", body=ball, material=rubber, radius=0.1)
            se3d.Solver(system).run(2.0)
            force, _ = ball.contact_wrench
            self.assertAlmostEqual(force[2], G, delta=1e-3)
            self.assertEqual(len(system.contacts), 1)
            numpy.testing.assert_allclose(abs(system.contacts[0].normal), (0, 0, 1), atol=1e-12)

    def test_every_type_of_the_library_is_there(self):
        self.assertIn("revolute_cylindrical", se3d.system.JOINTS)
        self.assertNotIn("gear", se3d.system.JOINTS)
        self.assertIn("heightfield", se3d.system.SHAPES)
        with se3d.System() as system:
            ramp = system.shape("heightfield", heights=[[0, 1, 2], [0, 1, 2]], spacing=(1, 1))
            _, normal, distance = ramp.nearest((0, 0, 1 + 2 ** 0.5))
        numpy.testing.assert_allclose(normal, (-0.5 ** 0.5, 0, 0.5 ** 0.5), atol=1e-12)
        self.assertAlmostEqual(distance, 1)

    def test_equilibrium(self):
        with se3d.System() as system:
            block = system.body(mass=1, inertia=(1, 1, 1), position=(0, 0, -1))
            system.joint("prismatic", system.ground, block, axis=(0, 0, 1))
            system.tsda(system.ground, block, k=100, l0=1)
            se3d.Solver(system, "equilibrium").run(0)
            self.assertAlmostEqual(block.position[2], -1 - G / 100, delta=1e-9)


class State(unittest.TestCase):
    def test_snapshots_and_clones_go_on_with_the_same_bits(self):
        with se3d.System() as system:
            bar, _ = pendulum(system)
            solver = se3d.Solver(system)
            solver.run(0.2)
            saved, copy = system.snapshot(), system.clone()
            solver.run(0.4)
            first = system.hash()
            system.restore(saved)
            solver.run(0.4)
            self.assertEqual(system.hash(), first)
            se3d.Solver(copy).run(0.4)
            self.assertEqual(copy.hash(), first)
            numpy.testing.assert_array_equal(copy.element_of(bar).position, bar.position)
            copy.close()

    def test_a_state_in_bytes_goes_on_in_another_system(self):
        with se3d.System() as system, se3d.System() as other:
            pendulum(system)
            pendulum(other)
            solver = se3d.Solver(system)
            solver.run(0.2)
            data = system.save()
            solver.run(0.4)
            other.load(data)
            se3d.Solver(other).run(0.4)
            self.assertEqual(other.hash(), system.hash())
            self.assertRaises(se3d.Error, other.load, data[:-1])

    def test_states_of_all_bodies_are_filled_in_place(self):
        with se3d.System() as system:
            bar, _ = pendulum(system)
            state = system.get_state()
            self.assertIs(system.get_state(out=state), state)
            numpy.testing.assert_array_equal(state.r[1], bar.position)
            state.r[1] = (0, 0, -0.5)
            state.p[1] = (numpy.sqrt(0.5), 0, numpy.sqrt(0.5), 0)
            system.set_state(r=state.r, p=state.p)
            numpy.testing.assert_allclose(bar.position, (0, 0, -0.5))
            with self.assertRaises(ValueError):
                system.get_state(out=se3d.State(*[numpy.empty((1, 3))] * 4))

    def test_elements_are_found_and_compared(self):
        with se3d.System() as system:
            bar, pin = pendulum(system)
            self.assertEqual(system.find_body("bar"), bar)
            sand = system.material(density=1000, stiffness=1e5, name="sand")
            self.assertEqual(system.find_material("sand"), sand)
            self.assertEqual(sand.name, "sand")
            self.assertEqual(system.bodies, [system.ground, bar])
            self.assertEqual(pin.bodies, [system.ground, bar])
            self.assertEqual([c.type for c in system.constraints], ["revolute"])
            self.assertIn("bar", system._repr_html_())
            self.assertEqual(repr(bar), "<Body 'bar'>")
            summary, messages = system.report()
            self.assertEqual((summary.freedoms, summary.redundant), (1, 0))
            self.assertTrue(messages)


class Wrong(unittest.TestCase):
    def test_messages_name_what_is_wrong(self):
        with se3d.System() as system:
            with self.assertRaises(se3d.Error) as caught:
                system.body(mass=-1, inertia=(1, 1, 1))
            self.assertEqual(caught.exception.field, "mass")
            self.assertEqual(caught.exception.status, se3d.STATUS["INVALID_ARGUMENT"])
            for call, what in ((lambda: system.body(mas=1), TypeError),
                               (lambda: system.body(position=(1, 2)), ValueError),
                               (lambda: system.joint("hinge", system.ground, system.ground),
                                ValueError),
                               (lambda: se3d.Solver(system, method="rk5"), ValueError),
                               (lambda: se3d.Solver(system, "motion"), ValueError),
                               (lambda: system.tsda(system.ground, "bar"), TypeError),
                               (lambda: system.function("sin("), se3d.Error),
                               (lambda: system.find_body("nobody"), se3d.Error),
                               (lambda: system.shape("ball"), ValueError)):
                self.assertRaises(what, call)

    def test_destroyed_elements_and_systems_are_noticed(self):
        system = se3d.System()
        bar = system.body(mass=1, inertia=(1, 1, 1))
        bar.destroy()
        self.assertRaises(se3d.Error, lambda: bar.position)
        solver = se3d.Solver(system)
        system.close()
        self.assertRaises(se3d.Error, solver.run, 1.0)
        self.assertRaises(se3d.Error, lambda: bar.position)
        self.assertRaises(se3d.Error, lambda: system.time)
        system.close()

    def test_elements_of_another_system_are_refused(self):
        with se3d.System() as a, se3d.System() as b:
            bar = a.body(mass=1, inertia=(1, 1, 1))
            self.assertRaises(ValueError, b.joint, "revolute", b.ground, bar)

    def test_exceptions_of_callbacks_come_back(self):
        def bad(_time, _i, _j):
            raise KeyError("mine")

        with se3d.System() as system:
            bar, _ = pendulum(system)
            element = system.force_callback(bad, system.ground, bar)
            solver = se3d.Solver(system)
            with self.assertRaises(KeyError):
                solver.run(0.1)
            element.destroy()
            solver.run(0.1)
            system.force_callback(lambda *_: [1, 2], system.ground, bar)
            self.assertRaises(ValueError, solver.run, 0.2)

    def test_exceptions_beyond_the_end_of_a_run_are_its_own_affair(self):
        def known(time, _i, _j, end=0.1, error=KeyError):
            if time > end:
                raised.append(time)
                raise error("beyond")
            return [0.0] * 12

        raised = []
        with se3d.System() as system:
            bar, _ = pendulum(system)
            element = system.force_callback(known, system.ground, bar)
            solver = se3d.Solver(system, method="dop853")
            solver.run(0.1)
            self.assertTrue(raised)
            self.assertEqual(system.time, 0.1)
            self.assertRaises(KeyError, solver.run, 0.2)
            element.destroy()
            system.force_callback(lambda *a: known(*a, 0.3, KeyboardInterrupt), system.ground, bar)
            self.assertRaises(KeyboardInterrupt, solver.run, 0.3)

    def test_nan_of_a_callback_ends_the_run(self):
        with se3d.System() as system:
            bar, _ = pendulum(system)
            system.force_callback(lambda *_: [float("nan")] * 12, system.ground, bar)
            self.assertRaises(se3d.Error, se3d.Solver(system).run, 0.1)

    def test_interrupts(self):
        with se3d.System() as system:
            pendulum(system)
            asked = []
            solver = se3d.Solver(system, method="rk4", step=1e-5,
                                 interrupt=lambda: len(asked) > 10 or asked.append(1))
            with self.assertRaises(se3d.Error) as caught:
                solver.run(1.0)
            self.assertEqual(caught.exception.status, se3d.STATUS["INTERRUPTED"])
            endless = se3d.Solver(system, method="rk4", step=1e-6)
            threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
            self.assertRaises(KeyboardInterrupt, endless.run, 900.0)

    def test_many_systems_leave_nothing(self):
        def work():
            for _ in range(200):
                system = se3d.System()
                _, pin = pendulum(system)
                system.driver(pin, "angle", lambda t: (t, 1, 0))
                se3d.Solver(system, "kinematics", step=0.1).run(0.1)
            gc.collect()

        def used():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1])

        if not os.path.exists("/proc/self/statm"):
            self.skipTest("no /proc")
        work()
        before = used()
        for _ in range(5):
            work()
        self.assertLess(used() - before, 400)  # pages: 1000 systems would take ten times that


class Models(unittest.TestCase):
    TEXT = """se3d: 1
parameters: {m: 1}
bodies: [{name: bar, mass: m, inertia: [1, 1, 1], position: [0, 0, -1]}]
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 1, 0]}
analysis: {type: dynamics, duration: 0.5}
output:
  - {file: r.csv, every: 0.1, channels: [pin.angle, bar.position]}
"""

    def test_tables_are_read_from_hdf5(self):
        try:
            import h5py  # noqa: F401
        except ImportError:
            self.skipTest("no h5py")
        with tempfile.TemporaryDirectory() as folder:
            text = self.TEXT + "  - {file: r.h5, every: 0.1, channels: [pin.angle, energy.kinetic]}\n"
            run = se3d.Model(text=text, parameters={"m": 3}).run(folder)
            table = run.table("r.h5")
            self.assertEqual(list(table), ["time", "pin.angle", "energy.kinetic"])
            numpy.testing.assert_array_equal(table["pin.angle"], run.table("r.csv")["pin.angle"])

    def test_text_runs_and_its_table_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            model = se3d.Model(text=self.TEXT, parameters={"m": 3}, method="radau")
            self.assertEqual(model.parameter("m"), 3)
            self.assertEqual(model.system.find_body("bar").mass, 3)
            times = []
            run = model.run(folder, progress=lambda _k, time, _f: times.append(time))
            table = run.table("r.csv")
            self.assertEqual(list(table)[:2], ["time", "pin.angle"])
            numpy.testing.assert_allclose(table["time"], numpy.linspace(0, 0.5, 6), atol=1e-12)
            numpy.testing.assert_array_equal(table["time"], run.table()["time"])
            self.assertEqual(times[-1], 0.5)
            self.assertEqual(run.analyses[0].method, "radau")
            model.write_scene(os.path.join(folder, "x.glb"))
            self.assertGreater(os.path.getsize(os.path.join(folder, "x.glb")), 100)
            self.assertIn("bar", model._repr_html_())
            self.assertEqual(len(se3d.Model(text=self.TEXT).run(
                folder, progress=lambda _k, time, _f: time > 0.15).table()["time"]), 3)

    def test_system_outlives_its_model(self):
        system = se3d.Model(text=self.TEXT).system
        gc.collect()
        se3d.Solver(system).run(0.1)
        self.assertAlmostEqual(system.time, 0.1)

    def test_mistakes_are_told_at_once(self):
        with self.assertRaises(se3d.ModelError) as caught:
            se3d.Model(text="se3d: 1\nbodies:\n  - {name: a, mas: 1}\n  - {name: b, mass: -1, "
                            "inertia: [1, 1, 1]}\n")
        self.assertGreater(caught.exception.line, 0)
        self.assertGreaterEqual(len(caught.exception.mistakes), 2)
        with self.assertRaises(se3d.ModelError):
            se3d.Model("/nowhere/model.yaml")
        with self.assertRaises(se3d.ModelError):
            se3d.Model(text=self.TEXT, parameters={"n": 3})


class Pictures(unittest.TestCase):
    """What notebooks show: the page of `se3d view`, else a sketch, else why there is neither."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        three = self.path("three.js")
        with open(VIEWER / "three_entry.js", encoding="utf-8") as entry:
            stamp = subprocess.run(["cksum"], stdin=entry, capture_output=True, text=True,
                                   check=True).stdout
        with open(three, "w", encoding="utf-8") as file:
            file.write(f"/* three 0.187 uplot 1.6.32 {stamp}*/ var three;")
        self.set(SE3D_THREE=three, SE3D_CACHE=self.path("cache"))
        self.model = se3d.Model(text=Models.TEXT, name="<bar>")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def set(self, **values):
        patch = unittest.mock.patch.dict(os.environ, values)
        patch.start()
        self.addCleanup(patch.stop)

    def program(self, text):
        """Let a shell script stand in for the program."""
        path = self.path("se3d.sh")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\n{text}\n")
        os.chmod(path, 0o755)
        self.set(SE3D_PROGRAM=path)

    def real(self):
        if not os.access(os.environ.get("SE3D_PROGRAM", ""), os.X_OK):
            self.skipTest("the program is not built")

    @staticmethod
    def frame(html):
        """The page in the frame, as browsers read it."""
        return unescape(html.split('<iframe srcdoc="')[1].split('"')[0])

    @staticmethod
    def motion(page):
        """The scene of a page: how often poses were recorded."""
        glb = base64.b64decode(page.split('id="glb">')[1].split("<")[0])
        scene = json.loads(glb[20:20 + int.from_bytes(glb[12:16], "little")])
        times = [scene["accessors"][one["samplers"][0]["input"]]["count"]
                 for one in scene.get("animations", ())]
        return times[0] if times else 0

    def test_model_and_run_show_their_scene(self):
        self.real()
        html = self.model._repr_html_()
        self.assertIn("<h4>&lt;bar&gt;</h4>", html)
        self.assertIn("<td>bar</td>", html)
        self.assertEqual(self.motion(self.frame(html)), 0)
        run = self.model.run(self.path("results"))
        page = self.frame(run._repr_html_())
        self.assertEqual(self.motion(page), 6)
        self.assertIn("pin.angle", page)
        still = self.model.run(self.path("results"), scene=False)
        self.assertEqual(self.motion(self.frame(still._repr_html_())), 0)
        del self.model
        gc.collect()
        run.write_scene(self.path("x.glb"))

    def test_large_page_gives_way_to_a_sketch(self):
        self.real()
        with unittest.mock.patch("se3d.page.LIMIT", 1000):
            html = self.model._repr_html_()
        self.assertIn("a notebook gets at most 1000", html)
        self.assertNotIn("iframe", html)
        svg = base64.b64decode(html.split("image/svg+xml;base64,")[1].split('"')[0])
        self.assertIn(b"bar", svg)

    def test_system_shows_a_sketch(self):
        self.real()
        with se3d.System() as system:
            bar, _ = pendulum(system)
            system.force_callback(lambda *_: [0] * 12, system.ground, bar)
            html = system._repr_html_()
        self.assertIn("image/svg+xml", html)
        self.assertNotIn("no sketch", html)

    def test_what_fails_says_why(self):
        self.set(SE3D_PROGRAM="", PATH=self.folder.name)
        html = self.model._repr_html_()
        self.assertIn("no scene: the program se3d is not found", html)
        self.assertIn("<td>bar</td>", html)
        self.set(SE3D_PROGRAM="/nowhere/se3d")
        self.assertIn("no scene: /nowhere/se3d: No such file", self.model._repr_html_())
        self.program("echo first; echo 'a <reason>' >&2; exit 1")
        html = self.model._repr_html_()
        self.assertIn("no scene: first; a &lt;reason&gt;", html)
        self.assertIn("no sketch: first; a &lt;reason&gt;", html)

    def test_program_that_hangs_is_ended(self):
        self.program("sleep 60 & wait")
        with unittest.mock.patch("se3d.page.WAIT", 0.2):
            html = self.model._repr_html_()
        self.assertIn("no scene: se3d view took longer than 0.2 s", html)


class Studies(unittest.TestCase):
    TEXT = """se3d: 1
gravity: [0, 0, 0]
parameters: {m: 2, v: 3}
bodies: [{name: block, mass: m, inertia: [1, 1, 1], velocity: [v, 0, 0]}]
analysis: {type: dynamics, duration: 1}
study:
  parameters: {m: [1, 2, 4], v: [3, 5]}
  method: grid
  measures:
    energy: {at: energy.kinetic, time: 1}
    way: {at: block.position.x, time: 1}
"""

    def test_samples_are_arrays(self):
        study = se3d.Study(se3d.Model(text=self.TEXT))
        self.assertEqual((study.parameters, study.measures, len(study)),
                         (("m", "v"), ("energy", "way"), 6))
        told = []
        done = study.run(progress=lambda k, of: told.append((k, of)))
        numpy.testing.assert_array_equal(done.parameters, study.samples())
        m, v = done.parameters.T
        self.assertEqual(sorted(zip(m, v)), [(a, b) for a in (1, 2, 4) for b in (3, 5)])
        numpy.testing.assert_allclose(done.measures, numpy.transpose([m * v**2 / 2, v]),
                                      rtol=1e-12)
        self.assertEqual((done.failures, told[-1]), ({}, (6, 6)))
        some = study.run([4, 1])
        numpy.testing.assert_array_equal(some.measures, done.measures[[4, 1]])
        self.assertEqual(len(study.run(progress=lambda k, of: k == 2).numbers), 2)

    def test_other_parameters_are_measured(self):
        study = se3d.Study(se3d.Model(text=self.TEXT))
        numpy.testing.assert_allclose(study.eval([10, 2]), [20, 2], rtol=1e-12)
        rows = study.eval([[10, 2], [-1, 2], [1, 4]])
        numpy.testing.assert_allclose(rows[[0, 2]], [[20, 2], [8, 4]], rtol=1e-12)
        self.assertTrue(numpy.isnan(rows[1]).all())
        with self.assertRaises(se3d.ModelError) as caught:
            study.eval([-1, 2])
        self.assertIn("mass", str(caught.exception))
        with self.assertRaises(ValueError):
            study.eval([1, 2, 3])
        with self.assertRaises(se3d.Error):
            study.sample(6)

    def test_derivatives(self):
        nominal, slopes, names = se3d.Study(se3d.Model(text=self.TEXT)).sensitivities()
        self.assertEqual(names, ("m", "v"))
        numpy.testing.assert_allclose(nominal, [9, 3], rtol=1e-9)
        numpy.testing.assert_allclose(slopes, [[4.5, 6], [0, 1]], atol=1e-6)

    def test_stubs_say_what_there_is(self):
        with open(os.path.join(os.path.dirname(se3d.__file__), "study.pyi"),
                  encoding="utf-8") as file:
            stubs = ast.parse(file.read())
        stub = next(node for node in stubs.body if getattr(node, "name", "") == "Study")
        told = {each.name: [a.arg for a in each.args.args + each.args.kwonlyargs]
                for each in stub.body if isinstance(each, ast.FunctionDef)}
        there = {name: list(inspect.signature(call).parameters)
                 for name, call in vars(se3d.Study).items()
                 if inspect.isfunction(call) and (not name.startswith("_") or name in told)}
        self.assertEqual(told, there)
        fields = next(node for node in stubs.body if getattr(node, "name", "") == "Samples").body
        self.assertEqual(tuple(field.target.id for field in fields), se3d.Samples._fields)

    def test_a_study_keeps_its_model_and_needs_one(self):
        study = se3d.Study(se3d.Model(text=self.TEXT))
        gc.collect()
        self.assertAlmostEqual(study.eval([1, 2])[1], 2)
        with self.assertRaises(se3d.ModelError):
            se3d.Study(se3d.Model(text=Models.TEXT))


if __name__ == "__main__":
    unittest.main()
