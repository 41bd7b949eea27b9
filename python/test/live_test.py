"""A session that runs can be watched and steered from another process, which holds nobody up."""

import json
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np

import dihaptic as dh
from dihaptic.program import program
from stranger import stranger

TASK = """scene: SCENE
hand: { centre_mm: [0, 0, 60], aperture_mm: 85 }
task:
  states:
    - name: wait
      exits:
        - { when: key, key: y, to: hold }
        - { when: time, after_s: 20, outcome: nobody came }
    - name: hold
      exits:
        - { when: trigger, code: 7, outcome: triggered }
        - { when: time, after_s: 20, outcome: nobody came }
  blocks: [{ name: all, repeats: REPEATS }]
"""
SHORT = """scene: SCENE
hand: { centre_mm: [0, 0, 60], aperture_mm: 85 }
task:
  states: [{ name: wait, exits: [{ when: time, after_s: 0.05, outcome: done }] }]
  feedback_s: 0
  blocks: [{ name: all, repeats: 1000 }]
"""


class Live(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.out = self.folder / "sessions"

    def start(self, *arguments):
        """A session in real time."""
        command = [program(), "run", *arguments, "--clock", "real", "--out", str(self.out)]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def task(self, repeats=1):
        file = self.folder / "task.yaml"
        scene = str(pathlib.Path("scenes/block-on-table.yaml").absolute())
        file.write_text(TASK.replace("SCENE", scene).replace("REPEATS", str(repeats)))
        return str(file)

    def session(self, run):
        said = run.communicate(timeout=120)[0]
        (folder,) = self.out.iterdir()
        self.assertIn(str(folder), said)
        return dh.load(folder), said

    def address(self, folder):
        return b"\0" + (folder / "observers").read_bytes()

    def until(self, live, end_s):
        """What is seen of a session that is then ended."""
        moments = []
        for now in live:
            moments.append(now)
            if now.time_s > end_s:
                live.end()
        return moments

    def raw(self, folder):
        connection = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        connection.settimeout(30)
        connection.connect(self.address(folder))
        self.addCleanup(connection.close)
        self.assertIn("session", json.loads(connection.recv(1 << 20)))
        return connection

    def test_is_watched_as_it_is_recorded(self):
        run = self.start("experiments/lift-block.yaml", "--seed", "3")
        with dh.observe(self.out, "grip_force", "block.z - 20 mm", every_ms=10) as live:
            self.assertEqual(live.units, {"grip_force": "N", "block.z - 20 mm": "mm"})
            moments = self.until(live, 3)
        session, _ = self.session(run)
        self.assertEqual(live.session, session.folder)
        self.assertGreater(len(moments), 100)  # of 300
        ticks = [now.tick for now in moments]
        self.assertEqual(ticks, sorted(set(ticks)))
        rows = np.searchsorted(session.t, [now.time_s - 1e-7 for now in moments])
        for row, now in zip(rows, moments):
            self.assertAlmostEqual(now.time_s, session.t[row], places=9)
            self.assertAlmostEqual(now.values["grip_force"], session["grip_force"][row], places=6)
            self.assertAlmostEqual(now.values["block.z - 20 mm"], 1e3 * float(session["block.position"][row, 2]) - 20, places=5)
        self.assertEqual([state for state in live.states if state in {now.state for now in moments}], live.states[:4])
        with self.assertRaisesRegex(dh.Error, "has no running session"):
            dh.observe(self.out, patience_s=0)

    def test_keys_that_are_sent_at_once_all_arrive(self):
        states = [f"{{ name: key {i}, exits: [{{ when: key, key: {key}, to: key {i + 1} }}] }}" for i, key in enumerate("yny1")]
        file = self.folder / "keys.yaml"
        scene = pathlib.Path("scenes/block-on-table.yaml").absolute()
        end = "{ name: key 4, exits: [{ when: time, after_s: 0.01, outcome: all }] }"
        file.write_text(f"scene: {scene}\ntask:\n  states: [{', '.join([*states, end])}]\n  blocks: [{{ name: all }}]\n")
        run = self.start(str(file))
        with dh.observe(self.out, "grip_force") as live:
            next(iter(live))
            for key in "yny1":
                live.press(key)
        self.assertEqual(list(self.session(run)[0].trials.outcome), ["all"])

    def test_is_steered(self):
        run = self.start(self.task(repeats=3))
        ends = []
        with dh.observe(self.out, "stiffness") as live:
            live.turn(stiffness=700, friction_scale=2, damping=None)
            for now in live:
                if now.outcome is not None:
                    ends.append((now.trial_num, now.attempt, now.outcome))
                elif now.state == "wait":
                    if now.values["stiffness"] == 700:  # turned within 0.2 s
                        live.press("y")
                elif now.state == "hold":
                    live.trigger(7)
        self.assertEqual(ends, [(i, 1, "triggered") for i in (1, 2, 3)])
        session, _ = self.session(run)
        self.assertEqual(list(session.trials.outcome), ["triggered"] * 3)
        self.assertEqual(session["stiffness"][-1], 700)
        self.assertEqual(session["friction_scale"][-1], 2)
        text = (session.folder / "session.yaml").read_text()
        self.assertRegex(text, r"Other programs that watched the session steered it: \d+ keys?, \d+ triggers?, 1 turn of knobs\.")
        self.assertTrue(dh.replay(session, progress=False))

    def test_is_ended(self):
        run = self.start("experiments/lift-block.yaml")
        with dh.observe(self.out) as live:
            live.end()
            self.assertEqual([now for now in live if now.time_s > 5], [])
        session, _ = self.session(run)
        self.assertLess(session.t[-1], 5)
        self.assertIn("and its end", (session.folder / "session.yaml").read_text())

    def test_refuses_what_cannot_be_done_and_goes_on(self):
        run = self.start(self.task())
        with self.assertRaisesRegex(dh.Error, "grip_forc: column 1: 'grip_forc' is not a quantity. Did you mean grip_force"):
            dh.observe(self.out, "grip_forc")
        with dh.observe(self.out) as live:
            for steer, why in [
                (lambda: live.turn(stifness=1), "There is no knob stifness. Known: coupling, stiffness"),
                (lambda: live.turn(stiffness=1e9), "stiffness must be a number from 1 to 20000 N/m"),
                (lambda: live.turn(stiffness="stiff"), "must be a number"),
                (lambda: live.turn(solver="bisection"), "solver must be one of"),
                (lambda: live.press("yes"), 'key: "yes" is not understood'),
                (lambda: live.trigger(256), "trigger: 256 is not understood"),
                (lambda: live.watch("grip_force", every_ms=-1), "'every_ms' a number"),
            ]:
                with self.subTest(why), self.assertRaisesRegex(dh.Error, why):
                    steer()
                    for _ in live:
                        pass
        raw = self.raw(live.session)
        for nonsense in [b"\0", b"[]", b"{", b'{"watch": 3}', b'{"end": 1}', b"{\"turn\": []}", b"x" * 60000, b'{"watch": ["\xff"]}']:
            raw.send(nonsense)
            self.assertIn("refused", json.loads(raw.recv(1 << 20)), nonsense)
        with dh.observe(self.out) as live:
            live.end()
            self.assertEqual([now.outcome for now in live if now.outcome], [])
        self.session(run)

    def test_is_not_held_up_by_one_who_does_not_read_nor_by_many_who_come_and_go(self):
        run = self.start("experiments/lift-block.yaml")
        with dh.observe(self.out):
            pass
        (folder,) = self.out.iterdir()
        idle = self.raw(folder)
        idle.send(b'{"watch": ["grip_force"], "every_ms": 0}')
        crowd = [self.raw(folder) for _ in range(15)]
        late = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        late.connect(self.address(folder))
        self.assertIn("16 observers already watch", json.loads(late.recv(1 << 20))["refused"])
        late.close()
        for one in crowd:
            one.close()
        for _ in range(20):
            self.raw(folder).close()
        with dh.observe(self.out) as last:
            self.assertGreater(self.until(last, 2)[-1].time_s, 2)
        session, said = self.session(run)
        self.assertNotIn("WARNING", said)
        self.assertTrue((np.diff(session.t) > 0).all())

    def test_has_an_address_that_its_user_alone_can_read_while_it_runs(self):
        run = self.start("experiments/lift-block.yaml")
        with dh.observe(self.out) as live:
            file = live.session / "observers"
            self.assertEqual(file.stat().st_mode & 0o777, 0o600)
            self.assertRegex(file.read_text(), "^dihaptic/session/[0-9a-f]{32}$")
            shutil.copytree(live.session, self.folder / "copy")
            live.end()
        self.assertFalse(self.session(run)[0].folder.joinpath("observers").exists())

    @unittest.skipUnless(os.geteuid() == 0, "wants to be another user")
    def test_is_not_taken_from_another_users_program(self):
        name = f"dihaptic/session/{os.getpid():032x}"
        answers = (
            "s = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET);"
            "s.bind('\\0' + sys.argv[1]); s.listen(); print('there', flush=True);"
            "s.accept()[0].send(b'{\"session\": \"x\", \"states\": [], \"outcomes\": []}')"
        )
        stranger(self, answers, name)
        self.out.mkdir()
        (self.out / "observers").write_text(name)
        with self.assertRaisesRegex(dh.Error, "is answered by another user's program"):
            dh.observe(self.out, patience_s=0)

    @unittest.skipUnless(os.geteuid() == 0, "wants to be another user")
    def test_is_seen_by_no_other_user(self):
        run = self.start("experiments/lift-block.yaml")
        with dh.observe(self.out) as live:
            read = (
                "import socket, sys; s = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET);"
                "s.connect('\\0' + sys.argv[1]); print(s.recv(1000))"
            )
            told = subprocess.run(
                ["/usr/bin/python3", "-c", read, self.address(live.session)[1:]],
                user=65534, capture_output=True, text=True,
            )  # fmt: skip
            self.assertNotIn("sessions", told.stdout)
            self.assertIn("ConnectionResetError" if told.returncode else "b''", told.stderr + told.stdout)
            live.end()
        self.session(run)

    def test_tells_every_end_to_one_who_reads_late(self):
        file = self.folder / "short.yaml"
        scene = str(pathlib.Path("scenes/block-on-table.yaml").absolute())
        file.write_text(SHORT.replace("SCENE", scene))
        run = self.start(str(file))
        with dh.observe(self.out) as live:
            late = self.raw(live.session)
            late.send(b'{"watch": ["grip_force"], "every_ms": 0}')
            time.sleep(1.5)  # by then there is no room for more messages
            ends, moments = [], 0
            while (text := late.recv(1 << 20)) and "over" not in (message := json.loads(text)):
                moments += "values" in message
                if "ended" in message:
                    ends.append(message["ended"]["trial_num"])
                if len(ends) == 60:
                    live.end()
        session, _ = self.session(run)
        trials = session.trials
        self.assertEqual(ends, trials.trial_num[(trials.outcome == "done") & (trials.trial_num >= ends[0])].tolist())
        self.assertLess(moments, 0.9 * session.t[-1] / 0.002)  # those of more than half a second were missed

    def test_may_be_in_a_folder_with_a_long_path(self):
        self.out = self.folder / ("long" * 40) / "sessions"
        run = self.start("experiments/lift-block.yaml")
        with dh.observe(self.out) as live:
            live.end()
        self.session(run)

    def test_is_waited_for_and_told_where_there_is_none(self):
        self.out.mkdir()
        with self.assertRaisesRegex(dh.Error, "has no running session"):
            dh.observe(self.out, patience_s=0.1)
        found = []
        waits = threading.Thread(target=lambda: found.append(dh.observe(self.out, patience_s=60)))
        waits.start()
        time.sleep(0.3)
        run = self.start("experiments/lift-block.yaml")
        waits.join()
        with found[0] as live:
            live.end()
        self.session(run)


if __name__ == "__main__":
    unittest.main()
