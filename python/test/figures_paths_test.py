"""Figures of recorded reaches: paths, speed, force on channels."""

import shutil
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "test"))

import h5py  # noqa: E402
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import soak  # noqa: E402
from boxes import faults  # noqa: E402
from drawn import Drawn, rehearsed  # noqa: E402

import dihaptic as dh  # noqa: E402
from dihaptic import figures  # noqa: E402
from dihaptic.figures import paths  # noqa: E402
from dihaptic.figures.paths.reaches import reaches_of  # noqa: E402

TICK = 0.001
#: Fewer reaches of curl-field, with as many panels.
CURL = [("repeats: 28", "repeats: 12"), ("count: 4, gap: 6", "count: 2, gap: 4"), ("repeats: 70", "repeats: 28"),
    ("count: 10, gap: 6", "count: 9, gap: 2")]  # fmt: skip


def of_phase(session, phase):
    """Trial number, first and last tick of each visit to a state, from phases.csv alone."""
    phases = pd.read_csv(session / "phases.csv")
    own = phases[phases.phase == phase]
    return [(int(t), round(a / TICK), round(b / TICK)) for t, a, b in zip(own.trial, own.start_time, own.stop_time)]


def quantity(session, name):
    with h5py.File(session / "session.nwb") as file:
        return np.asarray(file[f"acquisition/{name}/data"], float)


class Paths(Drawn):
    @classmethod
    def setUpClass(cls):
        warnings.simplefilter("error", FutureWarning)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        # more reaches than are drawn
        cls.tone = rehearsed("reach-at-tone", cls.folder.name, 2, [("repeats: 40", "repeats: 24")], keep_recordings=True)
        cls.curl = rehearsed("curl-field", cls.folder.name, 1, CURL, keep_recordings=True)

    def sessions(self, folder):
        return [sitting.session.folder for sitting in figures.read(folder).recorded]

    def test_paths_are_those_of_the_recording(self):
        points = figures.reach_paths(figures.read(self.tone), most=1000)
        drawn = points[points.of == "path"]
        count = 0
        for session in self.sessions(self.tone):
            trials = pd.read_csv(session / "trials.csv").drop_duplicates("trial_num", keep="last")
            counting = trials[(trials.kind == "baseline") & (trials.outcome != "interrupted")]
            position = 1000 * quantity(session, "index_handle_position")
            visits = {trial: (first, last) for trial, first, last in of_phase(session, "go")}  # the last visit
            for trial in counting.trial_num:
                first, last = visits[trial]
                own = drawn[(drawn.session == session.name) & (drawn.trial_num == trial)]
                np.testing.assert_allclose(own[["across_mm", "up_mm"]], position[first : last + 1 : 5, :2], rtol=1e-12)
                count += 1
        self.assertEqual(drawn.groupby(["session", "trial_num"]).ngroups, count)
        target = points[points.of == "target"]
        self.assertEqual(target[["across_mm", "up_mm", "radius_mm"]].values.tolist(), [[0, 0, 10]])

    def test_speed_is_that_of_pandas(self):
        rows = []
        for session in self.sessions(self.tone):
            trials = pd.read_csv(session / "trials.csv").drop_duplicates("trial_num", keep="last")
            speed = np.linalg.norm(quantity(session, "index_handle_velocity"), axis=1)
            visits = {trial: (first, last) for trial, first, last in of_phase(session, "go")}
            for row in trials[trials.kind == "baseline"].itertuples():
                first, last = visits[row.trial_num]
                if np.isnan(row.reaction_time_s):
                    continue  # an onset without an end has a reaction time, too
                onset = first + round(row.reaction_time_s / TICK)
                for k in range(-20, 400):
                    if first <= onset + 5 * k <= last:
                        rows.append((k, speed[onset + 5 * k]))
        table = pd.DataFrame(rows, columns=["k", "speed"]).groupby("k").speed
        expected = table.quantile([0.25, 0.5, 0.75]).unstack()
        expected = expected[table.count() >= 0.75 * table.count().max()]
        points = figures.speed_profiles(figures.read(self.tone))
        self.assertEqual(points.of_n.unique().tolist(), [table.count().max()])
        np.testing.assert_allclose(points.time_s, 0.005 * expected.index, atol=1e-9)
        np.testing.assert_allclose(points[["lower_m_s", "median_m_s", "upper_m_s"]], expected, rtol=1e-12, atol=1e-15)

    def test_force_on_channels_is_that_of_the_measures(self):
        data = figures.read(self.curl)
        (session,) = self.sessions(self.curl)
        trials = pd.read_csv(session / "trials.csv").set_index("trial_num")
        sent, velocity = (quantity(session, f"index_{name}") for name in ("force_sent", "handle_velocity"))
        position = quantity(session, "index_handle_position")
        field, curves = trials[(trials.block == "field") & (trials.kind == "force_channel")].index[:3], {}
        for trial, first, last in of_phase(session, "reach"):
            if trial not in field:
                continue
            forward = np.abs(velocity[first : last + 1, 1])
            peak = int(forward.argmax())
            onset = peak - int((forward[:peak][::-1] < 0.05 * forward[peak]).argmax())
            # left of the way, which leads away from the body, is -x; the field 13 Ns/m pushes to the right
            force, ideal = sent[first : last + 1, 0], 13 * velocity[first : last + 1, 1]
            at_peak = trials.channel_force_at_peak_speed_N[trial]
            self.assertAlmostEqual(force[peak], at_peak, delta=1e-4 * abs(at_peak) + 1e-5)
            self.assertTrue(np.isfinite(position[first : last + 1]).all())
            for k in range(-20, 200):
                if 0 <= onset + 5 * k < len(force):
                    curves.setdefault(k, []).append((force[onset + 5 * k], ideal[onset + 5 * k]))
        points = figures.channel_forces(data)
        panel = points[points.panel == "field, first 3 channels"]
        kept = sorted(k for k, values in curves.items() if len(values) == 3)
        for column, name in enumerate(["on the channel", "ideal"]):
            own = panel[panel.force == name]
            np.testing.assert_allclose(own.time_s, [0.005 * k for k in kept], atol=1e-9)
            median = [pd.Series([value[column] for value in curves[k]]).median() for k in kept]
            np.testing.assert_allclose(own.median_N, median, rtol=1e-12, atol=1e-15)

    def test_onsets_are_those_of_the_program(self):
        data = figures.read(self.tone)
        trials = data.table("trials").drop_duplicates(["person", "trial_num"], keep="last")
        found = {(reach.person, reach.trial_num): len(reach.speed) > 0 for reach in reaches_of(data)}
        for row in trials[trials.outcome != "interrupted"].itertuples():
            self.assertEqual(found[row.person, row.trial_num], not np.isnan(row.reaction_time_s), row.trial_num)

    def test_stages_are_panels(self):
        plans = {plan.name: plan for plan in paths.plans(figures.read(self.curl))}
        self.assertEqual(list(plans), ["reach-paths", "reach-speed", "channel-force"])
        points, figure = plans["reach-paths"].make(figures.read(self.curl))
        names = ["without the field", "field, first 8", "field, last 8", "washout, first 8"]
        self.assertEqual(list(dict.fromkeys(points.panel)), names)
        paths_of = points[points.of == "path"].groupby("panel").trial_num.nunique()
        self.assertEqual(paths_of[names].tolist(), [21, 8, 8, 8])
        limits = {(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes}
        self.assertEqual(len(limits), 1)
        self.assertTrue(all(axes.get_aspect() == 1 for axes in figure.axes))

    def test_what_is_cut_is_said(self):
        data = figures.read(self.tone)
        plan = next(iter(paths.plans(data)))
        points = plan.points(data)
        self.assertEqual(points[points.of == "path"].groupby(["session", "trial_num"]).ngroups, 40)
        self.assertIn("The figure shows 40 of 48", plan.caption)
        self.assertIn("2 people", plan.caption)

    def test_texts(self):
        for folder in (self.tone, self.curl, self.sessions(self.tone)[0]):
            with self.subTest(folder):
                self.check(paths, figures.read(folder), kept=True)

    def test_many_and_long_names(self):
        long = "a condition whose name is about as long as names can be in an experiment"
        everything = [(count, size) for count in (1, 2, 12) for size in ("one column", "two columns")]
        for count, size in soak.of([everything[0], everything[-1]], everything):
            names = [f"{long} {i}" for i in range(count)]
            lines = [(name, i, colour) for name in names for i, colour in enumerate(names[:7])]
            rows = [(name, colour, 0.005 * k, k + i, 2 * k) for name, i, colour in lines for k in range(9)]
            points = pd.DataFrame(rows, columns=["panel", "colour", "time_s", "across_mm", "up_mm"])
            points = points.assign(of="path", person="p", session="s", trial_num=1, radius_mm=np.nan)
            speed = points.assign(median_m_s=points.up_mm, lower_m_s=points.up_mm - 1, upper_m_s=points.up_mm + 1)
            force = speed.rename(columns=lambda name: name.replace("_m_s", "_N")).assign(force="ideal")
            with self.subTest(count, size=size):
                self.assertEqual(faults(figures.draw_reach_paths(points, size=size)), [])
                self.assertEqual(faults(figures.draw_speed_profiles(speed, size=size)), [])
                self.assertEqual(faults(figures.draw_channel_forces(force, size=size)), [])

    def damaged(self, name):
        """A copy of a session of the tone, to be damaged."""
        copy = Path(self.folder.name, name)
        shutil.copytree(self.sessions(self.tone)[0], copy)
        return copy

    def drawn(self, folder):
        """Names of the figures of a damaged session, all of which can be drawn."""
        return list(self.check(paths, figures.read(folder), damaged=True))

    def test_tables_that_lack_something(self):
        copy = self.damaged("few")
        trials, phases, listed = (pd.read_csv(copy / f"{name}.csv") for name in ("trials", "phases", "trial-list"))
        last = trials[trials.kind == "baseline"].trial_num.iloc[-1]
        trials[trials.trial_num == last].to_csv(copy / "trials.csv", index=False)
        self.assertEqual(self.drawn(copy), ["reach-paths", "reach-speed"])  # of a single trial
        phases.assign(stop_time=np.nan).to_csv(copy / "phases.csv", index=False)
        self.assertEqual(self.drawn(copy), [])
        phases.to_csv(copy / "phases.csv", index=False)
        listed.assign(movement_to_x_mm=np.nan).to_csv(copy / "trial-list.csv", index=False)
        self.assertEqual(self.drawn(copy), [])
        listed.head(0).to_csv(copy / "trial-list.csv", index=False)
        self.assertEqual(self.drawn(copy), [])
        listed.to_csv(copy / "trial-list.csv", index=False)
        trials.head(0).to_csv(copy / "trials.csv", index=False)
        self.assertEqual(self.drawn(copy), [])
        for make in (figures.reach_paths, figures.speed_profiles, figures.channel_forces):
            with self.assertRaises(dh.Error), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                make(figures.read(copy))

    def test_a_damaged_recording_is_told(self):
        copy = self.damaged("cut")
        (copy / "session.nwb").write_bytes((copy / "session.nwb").read_bytes()[:100_000])
        with self.assertWarnsRegex(UserWarning, "reaches of cut are not drawn"):
            self.assertEqual(list(paths.plans(figures.read(copy))), [])

    def test_values_that_are_missing(self):
        copy = self.damaged("missing")
        with h5py.File(copy / "session.nwb", "r+") as file:
            position = file["acquisition/index_handle_position/data"]
            trial, first, last = of_phase(copy, "go")[-1]
            position[first:last] = np.nan
        self.assertEqual(self.drawn(copy), ["reach-paths", "reach-speed"])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            points = figures.reach_paths(figures.read(copy))
        self.assertNotIn(trial, points.trial_num.dropna().tolist())

    def test_tables_alone_have_no_such_figures(self):
        (folder := Path(self.folder.name, "tables")).mkdir()
        out = rehearsed("reach-at-tone", folder, 1, [("repeats: 40", "repeats: 4")])
        self.assertEqual(list(paths.plans(figures.read(out))), [])


if __name__ == "__main__":
    unittest.main()
