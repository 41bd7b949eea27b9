"""A study that is done in a moment: two groups, two days, trials of a tenth of a second."""

import pathlib

from dihaptic.program import call

STUDY = """title: Two days of lifting
groups: [{ name: light, people: 2 }, { name: heavy, people: 2 }]
facts: [{ name: vision, values: [normal, corrected] }, { name: years }]
conditions: [slow, fast]
sessions:
  - { name: day1, experiment: "{condition}.yaml" }
  - { name: day2, experiment: "{condition}.yaml" }
"""
TRIALS = 3
EXPERIMENT = f"""title: Look
scene: scenes/block-on-table.yaml
hand: {{ centre_mm: [0, 0, 60], aperture_mm: 85 }}
task:
  states:
    - name: look
      exits:
        - {{ when: key, key: y, outcome: seen }}
        - {{ when: key, key: e, outcome: enough, ends_session: yes }}
        - {{ when: time, after_s: 0.1, outcome: missed, redo: yes }}
  most_attempts: 2
  blocks: [{{ name: all, repeats: {TRIALS} }}]
"""


def write(folder, more=""):
    """Writes the study into a folder; returns its file."""
    for name in ("slow", "fast"):
        pathlib.Path(folder, f"{name}.yaml").write_text(EXPERIMENT)
    file = pathlib.Path(folder, "two-days.yaml")
    file.write_text(STUDY + more)
    return file


def dihaptic(*words):
    """Runs a command of the program; returns what it printed. Raises dh.Error."""
    answer = call([str(word) for word in words], progress=False)
    if answer.code != 0:
        raise AssertionError("\n".join(answer.said + answer.output))
    return "\n".join(answer.output)


def rehearse(folder):
    """Writes the study into a folder, rehearses it there, and collects the rehearsal's tables."""
    file = write(folder)
    dihaptic("rehearse", file)
    dihaptic("collect", file, "--rehearsed", file.with_name("rehearsal"))
