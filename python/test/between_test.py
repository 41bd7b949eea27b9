"""What is decided between trials in Python acts, is recorded, and never holds a session up."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import dihaptic as dh
from dihaptic.between import listening
from dihaptic.program import program
from stranger import stranger

THRESHOLD = 1.3
TRIALS = 25


def experiment(**task):
    """Trials of a tenth of a second that are seen if their size is above a threshold."""
    return dh.Experiment(
        title="Seen or not",
        scene=str(pathlib.Path("scenes/block-on-table.yaml").absolute()),
        hand={"centre_mm": [0, 0, 60], "aperture_mm": 85},
        task={
            "states": [
                {
                    "name": "look",
                    "exits": [
                        {"when": f"time_in_state > 0.05 and size > {THRESHOLD}", "outcome": "seen"},
                        {"when": "time", "after_s": 0.1, "outcome": "unseen"},
                    ],
                }
            ],
            "feedback_s": 0.2,
            **task,
        },
    )


def with_variable(blocks=None):
    return experiment(
        variables=[{"name": "size"}, {"name": "force_N"}],
        blocks=blocks or [{"name": "trials", "kind": "baseline", "repeats": TRIALS}],
    )


class Quest:
    """QUEST as Watson and Pelli (1983) have it, on a grid of 0.01 about 0, with its usual settings."""

    def __init__(self, mean, sd, target=0.82, slope=3.5, guess=0.5, blind=0.01, grain=0.01, cells=500):
        at = np.arange(-cells // 2, cells // 2 + 1) * grain
        self.grain, self.mean, self.thresholds = grain, mean, mean + at
        self.posterior = np.exp(-0.5 * (at / sd) ** 2)
        self.posterior /= self.posterior.sum()
        lapse = blind * (1 - guess)
        x = np.arange(-cells, cells + 1) * grain
        yes = lambda x: guess + (1 - guess - lapse) * (1 - np.exp(-(10 ** (slope * x))))
        shift = np.interp(target, yes(x), x)
        self.x, self.yes = x, yes(x + shift)
        low, high = self.yes[0], self.yes[-1]
        entropy = lambda p: -sum(q * np.log(q) for q in (p, 1 - p) if q > 0)
        best = 1 / (1 + np.exp((entropy(high) - entropy(low)) / (high - low)))
        self.quantile = (best - low) / (high - low)

    def level(self):
        below = np.concatenate([[0], np.cumsum(self.posterior)])
        i = int(np.flatnonzero((below[1:] >= self.quantile) & (self.posterior > 0))[0])
        step = self.thresholds[i] - self.thresholds[i - 1]
        return self.thresholds[i - 1] + step * (self.quantile - below[i]) / self.posterior[i]

    def answer(self, level, seen):
        nearest = self.mean + round((level - self.mean) / self.grain) * self.grain
        p = np.interp(nearest - self.thresholds, self.x, self.yes)
        self.posterior *= p if seen else 1 - p
        self.posterior /= self.posterior.sum()


class ByQuest(dh.BetweenTrials):
    def __init__(self):
        self.quest = Quest(0.3, 0.3, guess=0.0)
        self.level = None

    def decide(self, last):
        if last.trial_num:
            self.quest.answer(self.level, last.outcome == "seen")
        self.level = self.quest.level()
        return dh.Next(variables={"size": 10**self.level})


class Deciding(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_it(self, what, rules, **options):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            session = dh.run(what, out=self.folder.name, between=rules, progress=False, **options)
        return session, "\n".join(str(warning.message) for warning in told)

    def test_quest_is_the_built_in_one(self):
        """With the same answers, the same levels."""
        built_in = experiment(
            procedures=[
                {
                    "name": "size", "level": "size", "yes": "seen", "no": "unseen", "trials": TRIALS, "guess": 0,
                    "logarithmic": True, "quest": {"prior_mean": 0.3, "prior_sd": 0.3, "lowest": -2, "highest": 2},
                }
            ],
            blocks=[{"name": "trials", "kind": "baseline", "procedures": ["size"]}],
        )  # fmt: skip
        rules = ByQuest()
        ours, told = self.run_it(with_variable(), rules)
        theirs, _ = self.run_it(built_in, None)
        self.assertEqual(told, "")
        self.assertEqual(list(ours.trials.outcome), list(theirs.trials.outcome))
        self.assertEqual({"seen", "unseen"}, set(ours.trials.outcome))
        level = next(c for c in theirs.trials.columns if c.startswith("size") or c == "level")
        np.testing.assert_allclose(ours.trials["size"], theirs.trials[level], rtol=1e-6)
        self.assertEqual(len(rules.attempts), TRIALS)

    def test_what_was_decided_is_recorded_for_replay_and_resume(self):
        class Units(dh.BetweenTrials):
            def decide(self, last):
                return dh.Next(variables={"force_N": 2.5 + last.trial_num, "size": 1})

        session, told = self.run_it(with_variable(), Units())
        self.assertEqual(told, "")
        np.testing.assert_allclose(session.trials.force_N, 2.5 + np.arange(TRIALS))
        after = next(c for c in session.trials.columns if "force" in c and c != "force_N")
        np.testing.assert_allclose(session.trials[after][:-1], 3.5 + np.arange(TRIALS - 1))
        self.assertTrue(dh.replay(session, progress=False))

    def test_a_trial_of_the_block_is_chosen(self):
        class Backward(dh.BetweenTrials):
            def decide(self, last):
                block = 1 if last.trial_num not in (1, 5, 6, 7, 8) else 2
                left = self.trials.query(f"block_num == {block}").trial_num.tolist()
                done = [attempt.trial_num for attempt in self.attempts]
                return dh.Next(trial_num=max(set(left) - set(done)))

        blocks = [{"name": name, "kind": "baseline", "repeats": 4} for name in ("first", "second")]
        rules = Backward()
        session, told = self.run_it(with_variable(blocks), rules)
        self.assertEqual(list(session.trials.trial_num), [4, 3, 2, 1, 8, 7, 6, 5])
        self.assertEqual(told, "")
        self.assertEqual(len(rules.failures), 0)

    def test_a_choice_that_cannot_be_is_told(self):
        class Wrong(dh.BetweenTrials):
            messages = ["one"]

            def decide(self, last):
                return [
                    dh.Next(trial_num=7),  # of the second block
                    dh.Next(trial_num=1),  # done already
                    dh.Next(trial_num=99),
                    dh.Next(variables={"weight": 3}),
                    dh.Next(message="two"),
                    dh.Next(variables={"size": float("nan")}),
                    dh.Next(variables={"size": "large"}),
                    None,
                ][last.trial_num]

        blocks = [{"name": name, "kind": "baseline", "repeats": 4} for name in ("first", "second")]
        session, told = self.run_it(with_variable(blocks), Wrong())
        self.assertEqual(list(session.trials.trial_num), list(range(1, 9)))
        for what in (
            "chose 2 times a trial that was not left in the block",
            "chooses trial 99, which does not exist, after trial 2",
            "sets 'weight', which is not a variable of the task, after trial 3",
            "sends an invalid answer, after trial 5",
            "failed (ValueError: 'two' is not in list)",
            "failed (ValueError: could not convert string to float: 'large')",
        ):
            self.assertIn(what, told)
            self.assertIn(what, "\n".join(session.info["notes"]))

    def test_one_that_raises_does_not_end_the_session(self):
        class Raises(dh.BetweenTrials):
            def decide(self, last):
                return 1 / last.trial_num

        rules = Raises()
        session, told = self.run_it(with_variable(), rules)
        self.assertEqual(session.info["state"], "complete")
        self.assertEqual(len(session.trials), TRIALS)
        self.assertIn("failed (ZeroDivisionError: division by zero)", told)
        self.assertIn("in decide", rules.failures[0])

    def test_a_reason_is_not_lost_whatever_is_in_it(self):
        class Odd(Exception):
            def __str__(self):
                raise ValueError

        class Raises(dh.BetweenTrials):
            messages = ("caf\udce9",)

            def decide(self, last):
                raise [
                    ValueError("no file caf\udce9\nhere \x1b[1m"),
                    Odd(),
                    ValueError("\u00fc" * 300),
                    KeyError("x"),
                ][last.trial_num % 4]

        session, told = self.run_it(with_variable([{"name": "trials", "kind": "baseline", "repeats": 3}]), Raises())
        for what in (
            r"failed (ValueError: no file caf\udce9 here \ufffd[1m)",
            "failed (Odd: its text is not available (ValueError))",
            "failed (ValueError: \u00fc\u00fc\u00fc",
        ):
            self.assertIn(what.replace(r"\ufffd", "\ufffd"), told)
        self.assertIn(r"caf\udce9", "\n".join(session.info["notes"]))
        self.assertEqual(dh.load(session.folder).info["state"], "complete")

    def test_one_that_never_answers_is_told_of_while_the_session_waits(self):
        def silent(server):
            connection, _ = server.accept()
            connection.sendall(b'{"messages": []}\n')
            time.sleep(8)
            connection.close()

        done = self.against(silent)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(
            "waiting: The program that decides between trials has not answered for 5 s, after trial 0.", done.stderr
        )

    @unittest.skipUnless(os.geteuid() == 0, "wants to be another user")
    def test_another_users_program_decides_nothing(self):
        os.chmod(self.folder.name, 0o755)
        path = f"{self.folder.name}/there/between"
        pathlib.Path(path).parent.mkdir()
        os.chown(pathlib.Path(path).parent, 65534, -1)
        answers = (
            "s = socket.socket(socket.AF_UNIX); s.bind(sys.argv[1]); s.listen();"
            "print('there', flush=True); s.accept()[0].send(b'{\"messages\": []}\\n')"
        )
        stranger(self, answers, path)
        done = subprocess.run([program(), "run", self.file(), "--between", path], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertRegex(done.stderr, r"belongs to another user: python3.* \(process \d+ of user nobody")

    def test_in_real_time_a_slow_one_holds_nothing_up(self):
        """One that takes 50 ms is waited for; one that takes longer than the patience is not."""

        class Slow(dh.BetweenTrials):
            def __init__(self, slow):
                self.slow = slow

            def decide(self, last):
                time.sleep(self.slow)
                return dh.Next(variables={"size": 2.0 + last.trial_num})

        blocks = [{"name": "trials", "kind": "baseline", "repeats": 3}]
        for slow, late in ((0.05, False), (1.2, True)):
            with self.subTest(slow):
                for _ in range(20):  # on a busy machine, the quick one may be late too
                    found, told = self.run_in_real_time(with_variable(blocks), Slow(slow))
                    self.assertEqual(len(found.trials), 3)
                    if ("too late" in told) == late:
                        break
                self.assertEqual("too late" in told, late)
                if not late:
                    np.testing.assert_allclose(found.trials["size"], [2, 3, 4])
                # a busy machine misses ticks, but none for as long as decide() takes
                self.assertLess(np.diff(found.t).max(), 0.6)

    def run_in_real_time(self, what, rules):
        file = what.save(f"{self.folder.name}/real.yaml")
        with listening(rules) as asking:
            command = [program(), "run", file, "--clock", "real", "--out", self.folder.name, *asking]
            done = subprocess.run(command, capture_output=True, text=True)
        self.assertIn("session: ", done.stdout, done.stderr)
        return dh.load(done.stdout.split("session: ")[1].strip()), done.stdout

    def test_one_that_goes_away_does_not_end_the_session(self):
        def leave(server):
            connection, _ = server.accept()
            connection.sendall(b'{"messages": []}\n')
            lines = connection.makefile("r")
            for _ in range(2):
                lines.readline()
            connection.close()
            lines.close()

        done = self.against(leave)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("left: the trials continued as in the file", done.stdout)
        self.assertIn("session: ", done.stdout)

    def test_what_decides_nothing_is_refused(self):
        class Wordy(ByQuest):
            messages = "abc"

        for rules, what in ((dh.BetweenTrials, "cannot decide"), (3, "cannot decide"), (Wordy(), "messages: are not a list")):
            with self.subTest(what), self.assertRaisesRegex(dh.Error, what):
                dh.run(with_variable(), between=rules, progress=False)
        with self.assertRaisesRegex(dh.Error, "no session has started"):
            ByQuest().session

    def test_ctrl_c_ends_the_session_in_order(self):
        """Though decide() never returns, and the signal comes to Python alone."""
        file = self.file()
        code = (
            "import time, dihaptic as dh\n"
            "class Never(dh.BetweenTrials):\n"
            "    def decide(self, last):\n"
            "        print('asked', flush=True)\n"
            "        time.sleep(1000)\n"
            f"dh.run('{file}', out='{self.folder.name}', between=Never(), progress=False)\n"
        )
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.assertEqual(process.stdout.readline(), "asked\n")
            process.send_signal(signal.SIGINT)
            said = process.communicate(timeout=100)[1]
        self.assertIn("KeyboardInterrupt", said)
        self.assertNotIn("Exception in thread", said)
        session = dh.load(next(pathlib.Path(self.folder.name).glob("*_experiment")))
        self.assertEqual(session.info["state"], "interrupted")

    def test_nonsense_is_refused(self):
        for said, what in [
            (b"hello\n", "does not start with its messages"),
            (b'{"messages": 3}\n', "does not start with its messages"),
            (b'{"messages": [3]}\n', "has a message that is not text"),
            (b"", "sent no greeting"),
            (b"x" * 100_000, "sent no greeting"),
        ]:
            with self.subTest(said[:20]):
                done = self.against(lambda server: self.say_and_close(server, said))
                self.assertEqual(done.returncode, 2)
                self.assertIn(what, done.stderr)
        answers = b'{"messages": []}\n' + b"no json\n[]\n{}\n" + b'{"number": 1, "set": 3, "next": "x", "message": 1.5}\n'
        done = self.against(lambda server: self.say_and_close(server, answers))
        self.assertEqual(done.returncode, 0)
        self.assertIn("sends an invalid answer", done.stdout)
        done = subprocess.run([program(), "run", self.file(), "--between", "/nowhere"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("/nowhere: error: does not answer: No such file or directory", done.stderr)

    def test_without_trials_there_is_nothing_to_decide(self):
        with self.assertRaisesRegex(dh.Error, "there is nothing to decide"):
            dh.run("scenes/block-on-table.yaml", out=self.folder.name, between=ByQuest(), progress=False)

    def say_and_close(self, server, said):
        connection, _ = server.accept()
        with connection:
            try:
                connection.sendall(said)
            except OSError:
                pass

    def file(self):
        return with_variable().save(f"{self.folder.name}/experiment.yaml")

    def against(self, serve):
        with socket.socket(socket.AF_UNIX) as server:
            path = f"{self.folder.name}/socket-{time.monotonic_ns()}"
            server.bind(path)
            server.listen(1)
            thread = threading.Thread(target=serve, args=(server,))
            thread.start()
            command = [program(), "run", self.file(), "--out", self.folder.name, "--between", path]
            done = subprocess.run(command, capture_output=True, text=True, timeout=100)
            thread.join()
        return done


if __name__ == "__main__":
    unittest.main()
