"""Measures of behaviour, computed again with numpy and scipy from the raw.log of synthetic reaches.

Usage: measures_test.py PROGRAM, from the project's folder.
"""
import csv
import ctypes
import glob
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

try:
    from scipy import stats
except ImportError:  # not installed on every machine; numpy then computes the same
    stats = None

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/dihaptic"

SCENE = """bodies:
  - { name: table, shape: box, size_mm: [600, 400, 50], position_mm: [0, 0, -25], fixed: yes }
fingers:
  - { name: index, shape: sphere, radius_mm: 6, mass_g: 1 }
"""
EXPERIMENT = """title: Reaches in a field
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  regions:
    - { name: start, position_mm: [0, 0, 120], radius_mm: 6 }
    - { name: target, position_mm: [60, 0, 120], radius_mm: 6 }
    - { name: beside, position_mm: [60, 8, 120] }
  perturbations:
    - name: field
      field: { kind: curl, on: index, damping_Ns_m: 6, axis: [0, 0, 1] }
    - name: channel
      field: { kind: channel, on: index, from: start, to: beside, stiffness_N_m: 300, damping_Ns_m: 3 }
  states:
    - name: home
      perturbed: no
      exits: [{ when: time, after_s: 0.8, to: reach }]
      simulated_hand: [{ duration_s: 0.4, reach: start }]
    - name: reach
      exits: [{ when: time, after_s: 0.3, to: stay }]
      simulated_hand: [{ duration_s: 0.5, reach: target }]
    - name: stay
      exits: [{ when: time, after_s: 0.7, outcome: reached }]
  measures: [reaction_time, movement_time, peak_speed, time_of_peak_speed, path_length, lateral_deviation,
             early_lateral_deviation, largest_lateral_deviation, end_point_error, initial_direction, spectral_arc_length, channel_force, adaptation_index]
  movement: { of: index, from: start, to: target, during: [reach, stay], go: reach, onset_speed_mm_s: 30, ideal: field }
  conditions:
    - { name: right }
    - name: away
      regions:
        - { name: target, position_mm: [10, 70, 120] }
        - { name: beside, position_mm: [20, 70, 120] }
  blocks:
    - { name: before, kind: baseline, repeats: 1 }
    - name: learn
      kind: perturbed
      perturb: field
      repeats: 2
      insert: [{ kind: force_channel, perturb: channel, count: 2 }]
    - { name: held, kind: force_channel, perturb: channel, repeats: 1 }
"""


class RawLog:
    """What a reader needs who has nothing but the file: its schema says what its records are made of."""

    SIZES = {"float64": "d", "int64": "q", "int32": "i", "uint32": "I", "float64[3]": "3d", "float64[4]": "4d"}

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        first = b"DIHAPTIC LOG 3\n"
        assert data.startswith(first)
        self.zstd = ctypes.CDLL("libzstd.so.1")
        self.zstd.ZSTD_getFrameContentSize.restype = ctypes.c_ulonglong
        self.zstd.ZSTD_decompress.restype = ctypes.c_size_t
        self.zstd.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
        at = len(first)
        self.frames = []
        while at < len(data):
            kind, size = struct.unpack_from("<4sI", data, at)
            payload = data[at + 24:at + 24 + size]
            at += 24 + size
            if kind == b"HEAD":
                (line,) = [one for one in payload.decode().splitlines() if one.startswith("schema: ")]
                self.schema = self.fields(json.loads(line[len("schema: "):]))
            elif kind == b"PACK":
                for record in self.records(payload):
                    self.frames.append(self.read(self.schema, record, 0)[0])

    @staticmethod
    def fields(text):
        """(name, type) or (name, how the list is written, fields of an item), in order."""
        out = []
        for line in text.splitlines():
            name, kind = line.split()[:2]
            if line.startswith("  "):
                out[-1][2].append((name, kind))
            elif "uint16 count" in line:
                out.append((name, "changed" if "index" in line else "each", []))
            else:
                out.append((name, kind))
        return out

    def records(self, packed):
        size = self.zstd.ZSTD_getFrameContentSize(packed, len(packed))
        blocks = ctypes.create_string_buffer(size)
        assert self.zstd.ZSTD_decompress(blocks, size, packed, len(packed)) == size
        blocks, at = blocks.raw, 0
        while at < size:
            count, length = struct.unpack_from("<2I", blocks, at)
            table = np.frombuffer(blocks, np.uint8, count * length, at + 8).reshape(length, count)
            at += 8 + count * length
            for record in table.T:
                yield record.tobytes()

    def read(self, fields, record, at):
        out = {}
        for field in fields:
            if len(field) == 2:
                form = "<" + self.SIZES[field[1]]
                value = struct.unpack_from(form, record, at)
                at += struct.calcsize(form)
                out[field[0]] = value[0] if len(value) == 1 else np.array(value)
                continue
            (count,) = struct.unpack_from("<H", record, at)
            at += 2
            items = []
            for _ in range(count):
                at += 2 if field[1] == "changed" else 0
                item, at = self.read(field[2], record, at)
                items.append(item)
            out[field[0]] = items
        return out, at


def line_through(x, y):
    """Slope, offset and r squared."""
    if stats is not None:
        fit = stats.linregress(x, y)
        return fit.slope, fit.intercept, fit.rvalue ** 2
    slope, offset = np.polyfit(x, y, 1)
    return slope, offset, np.corrcoef(x, y)[0, 1] ** 2


def sparc(speed, rate):
    """Spectral arc length by the fast Fourier transform."""
    size = 2 ** (int(np.ceil(np.log2(len(speed)))) + 4)
    frequency = np.arange(size) * rate / size
    amplitude = np.abs(np.fft.fft(speed, size))
    amplitude = (amplitude / amplitude.max())[frequency <= 10]
    last = np.nonzero(amplitude >= 0.05)[0][-1]
    amplitude = amplitude[:last + 1]
    return -np.sum(np.hypot(1 / last, np.diff(amplitude)))


def first_peak(speed):
    """Index of the largest speed of the first stroke: before the first valley that is 20 % below it, and from which the
    speed rises by 10 % of the largest; peaks below a quarter of the largest do not count."""
    for valley in np.flatnonzero((speed[1:-1] <= speed[:-2]) & (speed[1:-1] < speed[2:])) + 1:
        before = speed[:valley + 1].max()
        # up to where the speed falls below this valley, which would then not be the lowest
        deeper = np.flatnonzero(speed[valley + 1:] < speed[valley])
        after = speed[valley:valley + 1 + (deeper[0] if len(deeper) else len(speed))].max()
        if before >= speed.max() / 4 and speed[valley] <= 0.8 * before and after - speed[valley] >= 0.1 * speed.max():
            return int(np.argmax(speed[:valley + 1]))
    return int(np.argmax(speed))


def first_turn(off):
    """The value at which off first turns back, after and before changes of a tenth of its range, and 2 mm."""
    least = max(0.002, 0.1 * np.ptp(off))
    for i in range(1, len(off) - 1):
        for sign in (1, -1):
            x = sign * off
            if x[i] - x[0] >= least and x[i] == x[:i + 1].max():
                higher = np.flatnonzero(x[i:] > x[i])
                until = i + (higher[0] if len(higher) else len(x) - i)
                if x[i] - x[i:until].min() >= least:
                    return off[i]
    return off[np.argmax(np.abs(off))]


class Measures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = pathlib.Path(cls.folder.name)
        (root / "scene.yaml").write_text(SCENE)
        (root / "reaches.yaml").write_text(EXPERIMENT)
        subprocess.run([PROGRAM, "run", str(root / "reaches.yaml"), "--out", str(root / "out")], check=True,
                       capture_output=True)
        (name,) = glob.glob(str(root / "out" / "*" / "raw.log"))
        cls.session = pathlib.Path(name).parent
        cls.frames = RawLog(name).frames
        with open(cls.session / "trial-list.csv", newline="") as file:
            cls.list = list(csv.DictReader(file))
        with open(cls.session / "trials.csv", newline="") as file:
            cls.csv = list(csv.DictReader(file))
        # a CSV file has nine digits; the table of an NWB file has them all
        with h5py.File(cls.session / "session.nwb", "r") as nwb:
            cls.trials = {key: np.asarray(column) for key, column in nwb["intervals/trials"].items()
                          if isinstance(column, h5py.Dataset) and column.dtype.kind == "f"}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def expected(self, trial):
        """What the measures of the trial with that number, from 1, should be."""
        own = [f for f in self.frames if f["trial"] == trial and f["phase"] > 0]
        phases = np.array([f["phase"] for f in own])
        run = phases >= 2  # the states reach and stay
        time = np.array([f["time"] for f in own])[run] * 1e-9
        finger = [f["fingers"][0] for f in own]
        place = np.array([f["handle_position"] for f in finger])[run]
        velocity = np.array([f["handle_velocity"] for f in finger])[run]
        hand = -np.array([f["force_sent"] for f in finger])[run]
        row = self.list[trial - 1]
        start, target = [np.array([float(row[f"movement_{end}_{k}_mm"]) for k in "xyz"]) * 1e-3 for end in ("from",
                                                                                                      "to")]
        along = (target - start) / np.linalg.norm(target - start)
        left = np.cross([0, 0, 1], along)
        held = row["kind"] == "force_channel"
        speed = np.abs(velocity @ along) if held else np.linalg.norm(velocity, axis=1)
        peak = first_peak(speed)
        moves = speed >= 0.03
        onset = peak - int(np.argmin(moves[peak::-1])) + 1
        end = peak + int(np.argmin(moves[peak:]))
        part = slice(onset, end + 1)
        off = (place - start) @ left
        way = place[onset + int(round(0.1 / (time[1] - time[0])))] - place[onset]
        error = place[end] - target
        out = {
            "reaction_time_s": time[onset] - time[0],
            "movement_time_s": time[end] - time[onset],
            "peak_speed_m_s": speed[peak],
            "time_of_peak_speed_s": time[peak] - time[onset],
            "path_length_mm": 1e3 * np.sum(np.linalg.norm(np.diff(place[part], axis=0), axis=1)),
            "lateral_deviation_mm": 1e3 * first_turn(off[part]),
            "early_lateral_deviation_mm": 1e3 * off[onset + int(round(0.15 / (time[1] - time[0])))],
            "largest_lateral_deviation_mm": 1e3 * off[part][np.argmax(np.abs(off[part]))],
            "lateral_deviation_at_peak_speed_mm": 1e3 * off[peak],
            "lateral_deviation_area_mm2": 1e6 * np.trapz(off[part], (place[part] - start) @ along),
            "end_point_error_mm": 1e3 * np.linalg.norm(error),
            "end_point_extent_error_mm": 1e3 * error @ along,
            "end_point_lateral_error_mm": 1e3 * error @ left,
            "initial_direction_deg": np.degrees(np.arctan2(way @ left, way @ along)),
            "spectral_arc_length": sparc(speed[part], 1 / (time[1] - time[0])),
        }
        if not held:
            return out | {"field_share": 1.0 if row["perturbation"] == "field" else 0.0}
        pressed = (hand @ left)[part]
        ideal = -(6 * np.cross([0, 0, 1], velocity) @ left)[part]
        slope, offset, r2 = line_through(ideal, pressed)
        return out | {
            "channel_force_N": pressed[np.argmax(np.abs(pressed))],
            "channel_force_at_peak_speed_N": pressed[peak - onset],
            "channel_force_impulse_Ns": np.trapz(pressed, time[part]),
            "adaptation_index": np.linalg.lstsq(ideal[:, None], pressed, rcond=None)[0][0],
            "adaptation_index_slope": slope,
            "adaptation_index_offset_N": offset,
            "adaptation_index_r2": r2,
        }

    def test_are_those_of_numpy_and_scipy(self):
        kinds = set()
        for i, row in enumerate(self.csv):
            self.assertEqual(row["outcome"], "reached")
            kinds.add(row["kind"])
            for name, value in self.expected(int(row["trial_num"])).items():
                measured = self.trials[name][i]
                self.assertLessEqual(abs(measured - value), 1e-9 * max(1, abs(value)), (i, row["kind"], name))
                self.assertAlmostEqual(float(row[name]), value, delta=1e-8 * max(1, abs(value)))
        self.assertEqual(kinds, {"baseline", "perturbed", "force_channel"})
        self.assertEqual(len(self.csv), 10)

    def test_say_what_is_missing(self):
        for row in self.csv:
            if row["kind"] == "force_channel":
                self.assertEqual((row["not_measured"], row["field_share"]), ("", ""))
                self.assertGreater(abs(float(row["channel_force_N"])), 0.05)
            else:
                self.assertEqual(row["not_measured"], "channel_force: no channel; adaptation_index: no channel")
                self.assertEqual(row["adaptation_index"], "")

    def test_are_in_the_report(self):
        subprocess.run([PROGRAM, "report", str(self.session)], check=True, capture_output=True)
        page = (self.session / "report.html").read_text()
        for text in ["By condition</h2>", "lateral deviation [mm]"]:
            self.assertIn(text, page)
        self.assertNotIn("no channel (6)", page)  # trials without a channel are not listed as unmeasured
        with open(self.session / "adaptation.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row, trial in zip(rows, self.csv):
            index = trial["adaptation_index"]
            self.assertEqual(row["unit"], "%")
            self.assertEqual(bool(row["compensation"]), bool(index))
            if index:
                self.assertAlmostEqual(float(row["compensation"]), 100 * float(index), places=4)


if __name__ == "__main__":
    unittest.main()
