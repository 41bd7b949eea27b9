"""Names that other programs keep for themselves, as those of factors, draws, variables and measures: each is refused before
the session, or the session has all of its tables, with a column of that name.

Words of BIDS (bids-standard/bids-specification, schema/objects/columns.yaml), NWB (NeurodataWithoutBorders/nwb-schema,
hdmf-common-schema), HDF5, SQL:2016, R, MATLAB, Python, JSON and CSV; and columns of this program's own tables.

Usage: names_test.py PROGRAM, from the project's folder.
"""
import csv
import os
import pathlib
import re
import sys
import tempfile
import unittest

import h5py

sys.path.insert(0, "test/cli")
from program import dihaptic, session_of

import soak

WORDS = """
onset duration trial_type value response_time HED stim_file sample channel identifier database participant_id age sex
handedness strain strain_rrid filename acq_time session_id species group type units description sampling_frequency
low_cutoff high_cutoff software_filters status status_description component tracked_point reference_frame placement
id colnames columns name namespace neurodata_type object_id tags tags_index timeseries timeseries_index start_time
stop_time data timestamps unit resolution conversion comments control rate starting_time subject genotype intervals
trials acquisition analysis processing scratch stimulus general file_create_date identifier2 session_description source
parent children fields modified data_type container target table index idx neurodata VectorData VectorIndex
root attrs attributes links dataset datasets space dtype shape chunks compression maxshape fillvalue track_order
select from where order by table join inner outer left right full on union all distinct insert update delete create drop
alter primary key foreign references default check unique null not and or in is like between exists case when then else
end as asc desc having limit offset values set grant revoke commit rollback transaction cast date time timestamp interval
user role schema view trigger cursor fetch row rows column count sum avg min max first last
if else2 repeat while function for next break TRUE FALSE NULL Inf NaN NA NA_integer_ NA_real_ NA_character_ T F c t q
data_frame factor levels names row_names class dim length mean median sd var range summary library require return
switch otherwise case2 try catch parfor classdef properties methods events enumeration global persistent continue pi i j
eps ans nargin nargout varargin varargout struct cell double single char logical
def class2 lambda yield import with pass raise None True False async await del elif except finally is2 nonlocal print len
list dict tuple object str int float bool bytes open input map filter zip sorted format property super self cls
key2 keys items values2 get pop copy index2 loc iloc at iat size ndim T2 empty dtypes head tail apply
seed ppid session_num trial_num block_num block trial_num_in_block kind round condition perturbation share procedure
attempt outcome peak_grip_N peak_force_N reach_time_s hand_angle_deg shown_angle_deg hand_extent_mm wanted_extent_mm
not_measured simulated moved_by experiment person people participant next_score lift_mark time tick frame
x y z w X Y a b1 A1 _a a_ a__b CON PRN AUX NUL com1 lpt1
""".split()
WORDS = list(dict.fromkeys(WORDS))

EXPERIMENT = """title: names
scene: {folder}/scenes/reach-in-space.yaml
task:
  {what}
  states: [{{ name: s, exits: [{{ when: time, after_s: 0.05, outcome: done }}] }}]
  {conditions}
  blocks: [{{ name: b, repeats: 1 }}]
"""
AS = {
    "draws": lambda word: f"{{ name: {word}, uniform: {{ from: 1, to: 2 }} }}",
    "variables": lambda word: f"{{ name: {word}, start: 3 }}",
    "custom_measures": lambda word: f"{{ name: {word}, of: '4', take: last }}",
    "factors": lambda word: f"{word}: 5",
}


class Names(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, kind, words):
        quoted = [f'"{word}"' for word in words]
        listed = ", ".join(AS[kind](word) for word in quoted)
        factors = kind == "factors"
        text = EXPERIMENT.format(
            folder=os.getcwd(),
            what="" if factors else f"{kind}: [{listed}]",
            conditions=f"conditions: [{{ name: only, factors: {{ {listed} }} }}]" if factors else "",
        )
        path = self.folder / f"{kind}.yaml"
        path.write_text(text)
        return path

    def accepted(self, kind, words):
        """Those that check lets pass, after all rounds of complaints."""
        while True:
            checked = dihaptic("check", str(self.file(kind, words)))
            if checked.returncode == 0:
                return words
            refused = set()
            for line in checked.stdout.splitlines():
                if ": error: " in line:
                    self.assertRegex(line, r"\. \w.*\.$", "a remedy")
                    refused |= {word for word in words if re.search(rf"\b{re.escape(word)}\b", line.split(": error: ")[1])}
            self.assertTrue(refused, checked.stdout)
            words = [word for word in words if word not in refused]

    def test_are_refused_or_all_tables_are_written(self):
        self.assertGreaterEqual(len(WORDS), 300)
        for kind, at_once in (("draws", 400), ("factors", 400), ("custom_measures", 400), ("variables", 12)):
            begins = range(0, len(WORDS), at_once)
            for begin in soak.of(begins[::4], begins):
                words = self.accepted(kind, WORDS[begin:begin + at_once])
                with self.subTest(kind, words=words[:3]):
                    if words:
                        self.session(kind, words)

    def session(self, kind, words):
        out = self.folder / f"{kind}-{words[0]}"
        ran = dihaptic("run", str(self.file(kind, words)), "--simulate", "--participant", "S1", "--out", str(out))
        self.assertEqual(ran.returncode, 0, ran.stderr)
        session = pathlib.Path(session_of(str(out)))
        with (session / "trials.csv").open(newline="") as file:
            (row,) = csv.DictReader(file)
        with (session / "trials.csv").open(newline="") as file:
            head = next(csv.reader(file))
        self.assertEqual(len(head), len(set(head)))
        value = {"variables": 3, "custom_measures": 4, "factors": 5}.get(kind)
        for word in words:
            self.assertTrue(float(row[word]) == value if value else 1 <= float(row[word]) <= 2, word)
        with h5py.File(session / "session.nwb", "r") as nwb:
            trials = nwb["intervals/trials"]
            for word in words:
                self.assertEqual(trials[word][:].tolist(), [float(row[word])] if value else trials[word][:].tolist())
            self.assertEqual(trials["id"][:].tolist(), [0])
        # a page takes seconds, and only factors and custom measures have figures of their own
        page = () if kind in soak.of(("factors",), ("factors", "custom_measures")) else ("--tables",)
        for command in (("report", *page), ("export", "--bids", str(out / "bids"))):
            done = dihaptic(command[0], str(session), *command[1:])
            self.assertEqual(done.returncode, 0, done.stderr)
        (events,) = out.glob("bids/sub-*/motion/*_events.tsv")
        columns = events.read_text().splitlines()[0].split("\t")
        self.assertEqual(len(columns), len(set(columns)))
        self.assertEqual(set(words) - set(columns), set())


if __name__ == "__main__":
    unittest.main()
