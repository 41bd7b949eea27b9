"""Figures of how sessions went: their numbers are those of pandas, and their texts can be read, whatever is missing."""

import re
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "test"))

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import soak  # noqa: E402
from boxes import faults  # noqa: E402
from drawn import Drawn, drawn_again, rehearsed  # noqa: E402

from dihaptic import figures  # noqa: E402
from dihaptic.errors import Error  # noqa: E402
from dihaptic.figures import quality  # noqa: E402

TIGHT = {"rtol": 0, "atol": 1e-12}
#: All figures of how sessions went.
NAMES = ["outcomes", "timing-and-force"]


class Few:
    """Data that consist only of tables, as the functions that make points need them."""

    def __init__(self, trials, sessions=(), blocks=()):
        self.trials, self.sittings, self.blocks, self.mark = trials, list(sessions), list(blocks), "simulated"

    @property
    def sessions(self):
        return self.sittings

    def table(self, name):
        assert name == "trials"
        return self.trials.copy()

    def has(self, name):
        return name == "trials" and len(self.trials) > 0

    @property
    def people(self):
        return list(dict.fromkeys(self.trials["person"]))


class Sitting:
    """A session of which the program has said this."""

    def __init__(self, person, info, events=None):
        self.folder, self.tables, self._events = Path(person), ["trials"] if events is None else ["events", "trials"], events
        self.person, self.session = person, self
        self.info = {"participant": {"id": person}, **info}

    def table(self, name):
        return pd.DataFrame(self._events, columns=["event", "detail"])


def attempts(people=3, blocks=("one", "two"), trials=6, outcomes=("hit", "missed"), seed=1):
    """Attempts at trials, some of them repeated."""
    random = np.random.default_rng(seed)
    rows = []
    for person in range(people):
        number, time = 0, 0.0
        for block in blocks:
            for _ in range(trials):
                number += 1
                for attempt in range(1, 2 + int(random.random() < 0.3)):
                    length = random.uniform(1, 4)
                    rows.append((
                        f"p{person}", "", 1, number, block, "baseline", "c", "", attempt, str(random.choice(outcomes)), time,
                        time + length, random.uniform(1, 5), np.nan,
                    ))  # fmt: skip
                    time += length
    columns = [
        "person", "group", "seed", "trial_num", "block", "kind", "condition", "perturbation", "attempt", "outcome", "start_time",
        "stop_time", "peak_force_N", "not_measured",
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


class Rehearsed(Drawn):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        fewer = [("repeats: 5", "repeats: 1"), ("repeats: 10", "repeats: 2")]
        cls.people = rehearsed("fragile-object", cls.folder.name, 2, fewer)

    def test_numbers_are_those_of_pandas(self):
        points = figures.trial_outcomes(figures.read(self.people))
        trials = pd.read_csv(self.people / "trials.csv")
        last = trials.drop_duplicates(["id", "trial_num"], keep="last")
        shares = last.groupby("block").outcome.value_counts(normalize=True).sort_index()
        own = points[points.of == "block"].set_index(["block", "outcome"]).share.sort_index()
        pd.testing.assert_series_equal(own, shares, check_names=False, **TIGHT)
        first = trials[trials.attempt == 1]
        shares = first.groupby("id").outcome.value_counts(normalize=True).sort_index()
        own = points[points.of == "person"].set_index(["person", "outcome"]).share.sort_index()
        pd.testing.assert_series_equal(own, shares, check_names=False, **TIGHT)
        mean = pd.crosstab(first.id, first.outcome, normalize="index").mean()
        own = points[points.of == "mean"].set_index("outcome").share.sort_index()
        pd.testing.assert_series_equal(own, mean, check_names=False, **TIGHT)
        self.assertEqual(points[points.of == "repeated"].n.sum(), len(trials) - len(last))
        dropped = last.not_measured.fillna("").str.contains("lift: not put down").sum()
        self.assertEqual(points[points.reason == "lift: not put down"].n.tolist(), [dropped] if dropped else [])

    def test_times_and_forces_are_those_of_pandas(self):
        data = figures.read(self.people)
        points = figures.timing_and_force(data)
        trials = pd.read_csv(self.people / "trials.csv").eval("duration_s = stop_time - start_time")
        for of in ("duration_s", "peak_force_N"):
            for by, own in (("block", points.person == ""), (["block", "id"], points.person.notna() & (points.person != ""))):
                found = points[(points.of == of) & own].set_index(["block"] if by == "block" else ["block", "person"])
                known = trials.groupby(by)[of]
                for column, number in (
                    ("n", known.count()), ("low", known.min()), ("q25", known.quantile(0.25)), ("median", known.median()),
                    ("q75", known.quantile(0.75)), ("high", known.max()),
                ):  # fmt: skip
                    compared = found[column].sort_index().astype(float)
                    pd.testing.assert_series_equal(compared, number.astype(float), check_names=False, **TIGHT)
        ticks = points[points.of == "ticks"].set_index("person")
        self.assertEqual(ticks.ticks.to_dict(), {s.folder.name: int(s.info["ticks"]) for s in data.sessions})
        self.assertEqual(ticks.missed.to_dict(), {s.folder.name: int(s.info["convergence"]["missed"]) for s in data.sessions})
        self.assertTrue(ticks.late.isna().all())  # no real clock
        self.assertEqual(points[points.of == "largest_force_N"]["median"].tolist(), [8.5])

    def test_can_be_read_of_several_and_of_one(self):
        for path in (self.people, self.people / "sim-001"):
            data = figures.read(path)
            for plan, points, _ in self.check(quality, data, NAMES).values():
                # points that were kept in a file give the same figure, to the last sign
                files = [Path(self.folder.name, f"{which}.svg") for which in ("made", "kept")]
                for file, drawn in zip(files, (plan.make(data)[1], drawn_again(plan, points, data))):
                    figures.save(drawn, file)
                # names of clipping paths differ with the last digit of the layout
                self.assertEqual(*(re.sub(rb"\bp[0-9a-f]{10}\b", b"", file.read_bytes()) for file in files), plan.name)


class Made(Drawn):
    def check(self, data, names=NAMES):
        return [plan for plan, _, _ in super().check(quality, data, list(names)).values()]

    def sessions(self, people, **info):
        told = {
            "ticks": 1234567, "clock": "real", "finished": "1234567 ticks, 12 overruns, 0 frames not recorded",
            "convergence": {"missed": 7}, "devices": [{"peak_force_N": 8.5}, {"peak_force_N": 3.3}], **info,
        }  # fmt: skip
        events = [("limit", "a force or a torque was cut to the largest allowed")] * 3
        events += [("limit", "force was off, after a fault"), ("limit", "the recording ended"), ("touch", "index block")]
        return [Sitting(f"p{person}", told, events) for person in range(people)]

    def test_late_ticks_limits_and_faults(self):
        data = Few(attempts(), self.sessions(3))
        points = quality.timing_and_force(data)
        ticks = points[points["of"] == "ticks"]
        self.assertEqual(ticks[["missed", "late", "limited", "faults"]].values.tolist(), [[7, 12, 3, 1]] * 3)
        self.assertEqual(points[points["of"] == "largest_force_N"]["median"].tolist(), [3.3])
        self.check(data)

    def test_many_of_all(self):
        """People, blocks with long names, outcomes and reasons beyond what has a row of its own: each caption says so."""
        blocks = [f"block {i} with quite a long name, in which much happens" for i in range(20)]
        trials = attempts(12, blocks, 4, [f"an outcome that is called {i}" for i in range(11)])
        words = np.array(["slow", "lost", "late", "off", "short", "long", "high", "low", "near", "far"])
        trials["not_measured"] = "movement_time: it was too " + pd.Series(words[np.arange(len(trials)) % 10])
        trials.loc[::4, "not_measured"] = np.nan
        data = Few(trials, self.sessions(12))
        outcomes, timing = self.check(data)
        self.assertIn("Of 20 blocks, the last 6 are one bar", outcomes.caption)
        self.assertIn("The 5 rarest of 11 outcomes have one colour", outcomes.caption)
        self.assertIn("The 6 most frequent of 10 reasons have bars of their own", outcomes.caption)
        self.assertIn("The first 14 of 20 blocks are shown", timing.caption)
        self.assertIn("The 8 of 12 people with the most of these have rows of their own", timing.caption)

    def test_one_column(self):
        data = Few(attempts(), self.sessions(3))
        for points, drawing in (
            (quality.trial_outcomes(data), quality.draw_trial_outcomes),
            (quality.timing_and_force(data), quality.draw_timing_and_force),
        ):  # fmt: skip
            self.assertEqual(faults(drawing(points, size="one column")), [])

    def test_reasons(self):
        """What is asked for in no trial like it is not missing; the same reason with other numbers is the same."""
        trials = attempts(2, ("reaches", "rating"), 4)
        trials = trials.drop_duplicates(["person", "trial_num"], keep="last").reset_index(drop=True)
        reaches = trials["block"] == "reaches"
        trials.loc[reaches, "not_measured"] = "tlx: not measured"
        trials.loc[1, "not_measured"] = (
            "tlx: not measured; speed: the movement covered 1 % of the way, less than 10 %; time: lift: dropped")
        trials.loc[2, "not_measured"] = "tlx: not measured; speed: the movement covered 2 % of the way, less than 10 %"
        own = quality.trial_outcomes(Few(trials))
        own = own[own["of"] == "not measured"].set_index("reason")
        self.assertEqual(own["n"].to_dict(), {"the movement covered ... % of the way, less than 10 %": 2, "lift: dropped": 1})
        self.assertEqual(own["measures"].to_dict()["lift: dropped"], "time")
        trials["not_measured"] = "tlx: not measured"  # nowhere: that must be seen
        own = quality.trial_outcomes(Few(trials))
        self.assertEqual(own[own["of"] == "not measured"]["n"].tolist(), [len(trials)])

    def test_what_is_missing(self):
        whole = attempts()
        cases = {
            "no times": whole.assign(start_time=np.nan),
            "no forces": whole.assign(peak_force_N=np.nan),
            "forces of zero": whole.assign(peak_force_N=0.0),
            "no outcomes": whole.assign(outcome=np.nan),
            "some outcomes": whole.assign(outcome=whole["outcome"].where(whole.index % 3 > 0)),
            "no blocks": whole.assign(block=np.nan),
            "a single trial": whole[:1],
            "reasons that nobody has written so": whole.assign(not_measured="?"),
            "nothing measured": whole.assign(not_measured="speed: no movement"),
        }
        for name in soak.of(list(cases)[::2], cases):
            with self.subTest(name):
                self.check(Few(cases[name], self.sessions(cases[name]["person"].nunique())))
        with self.subTest("nothing known of sessions"):
            self.check(Few(whole, [Sitting("p0", {}), Sitting("p1", {"convergence": None, "finished": None, "devices": None})]))
        with self.subTest("no rows"):
            self.check(Few(whole[:0]), ())
        with self.subTest("no column that is needed"):
            self.check(Few(whole.drop(columns="start_time")), ())
        with self.subTest("no task"):
            plain = whole[:4].drop(columns=["block", "attempt", "kind", "condition"])
            plain = plain.assign(outcome="done", block_num=1, trial_num=range(4))
            self.check(Few(plain, self.sessions(1)), ["timing-and-force"])
            self.check(Few(plain[:1], self.sessions(1)), ())
        with self.assertRaises(Error):
            quality.draw_trial_outcomes(pd.DataFrame(columns=["of", "outcome"]))
        with self.assertRaises(Error):
            quality.draw_timing_and_force(pd.DataFrame(columns=["of", "block"]))


if __name__ == "__main__":
    unittest.main()
