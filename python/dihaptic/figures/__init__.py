"""Draws a session, a rehearsal or a study as figures for a paper.

    from dihaptic import figures

    figures.draw("rehearsals/grip-and-lift_1")       # all figures that its experiment calls for, into figures/

Each figure is saved as SVG, PDF and PNG, with the points that are drawn (CSV), and with a script of a few lines, which
draws it anew from the tables and can be changed for a paper. Each kind of figure has a pair of functions: one makes a table
with a row for each item that is drawn, and the other draws such a table. `python3 -m dihaptic.figures FOLDER` does what
draw() does. If the people are simulated, points.attrs["mark"] of a table has the word that its figures show in a corner.
Figures need matplotlib and SciPy.
"""

try:
    import matplotlib  # noqa: F401
    import scipy  # noqa: F401
except ImportError as _why:
    from .._remedy import explain

    raise ImportError(explain(_why)) from None

from .conditions import draw_conditions, means_by_condition
from .data import Data, Measure, read
from .drawing import draw
from .fitts import draw_fitts_law, fitts_law
from .learning import (
    draw_generalisation,
    draw_laboratory_curves,
    draw_learning_curve,
    draw_learning_windows,
    draw_measures_over_trials,
    generalisation_curve,
    laboratory_curves,
    learning_curve,
    learning_windows,
    measures_over_trials,
)
from .lifts import (
    draw_grip_against_load,
    draw_lift_curves,
    draw_lift_phases,
    draw_successive_lifts,
    grip_against_load,
    lift_curves,
    lift_phases,
    successive_lifts,
)
from .paths import (
    channel_forces,
    draw_channel_forces,
    draw_reach_paths,
    draw_speed_profiles,
    reach_paths,
    speed_profiles,
)
from .psychophysics import (
    answers_by_level,
    draw_answers,
    draw_procedure_courses,
    draw_psychometric_functions,
    draw_thresholds,
    procedure_courses,
    psychometric_functions,
    thresholds_by_procedure,
)
from .quality import draw_timing_and_force, draw_trial_outcomes, timing_and_force, trial_outcomes
from .people import write_means
from .saving import Plan, save
from .sessions import Sample, samples_in
from .statistics import write_analyses
from .style import COLOURS, canvas

__all__ = [
    "COLOURS", "Data", "Measure", "Plan", "Sample", "answers_by_level", "canvas", "channel_forces", "draw",
    "draw_answers", "draw_channel_forces", "draw_conditions", "draw_fitts_law", "draw_generalisation", "draw_grip_against_load",
    "draw_laboratory_curves", "draw_learning_curve", "draw_learning_windows", "draw_lift_curves", "draw_lift_phases",
    "draw_measures_over_trials", "draw_procedure_courses", "draw_psychometric_functions", "draw_reach_paths",
    "draw_speed_profiles", "draw_successive_lifts", "draw_thresholds", "draw_timing_and_force",
    "draw_trial_outcomes", "fitts_law", "generalisation_curve", "grip_against_load", "laboratory_curves", "learning_curve",
    "learning_windows",
    "lift_curves", "lift_phases", "means_by_condition", "measures_over_trials", "procedure_courses",
    "psychometric_functions", "reach_paths", "read", "samples_in", "save", "speed_profiles", "successive_lifts",
    "thresholds_by_procedure", "timing_and_force", "trial_outcomes", "write_analyses", "write_means",
]  # fmt: skip
