"""Dihaptic from Python: read sessions, fit, run experiments, step worlds.

    import dihaptic as dh

    session = dh.load("sessions/2026-11-26_lift-block")
    session.lifts                                   # pandas tables, units in attrs
    session["grip_force"], session["block.position"], session.t       # numpy arrays
    session.plot("grip_force", "load_force", align="lift_off")

docs/python.md shows what is possible, and help(dh) lists them. Reading works on any computer (dihaptic-read).
There, functions that need the program, or its module `_native`, raise an ImportError that gives the remedy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

try:
    from . import _facts
    from .charts import plot
    from .errors import Error, NotThere, Problem
    from .rehearsal import Rehearsal
    from .session import Session, load
    from .study import Study
    from .tables import read_table
    from .vocabulary import Quantity, quantities, quantity
except ImportError as _why:
    from ._remedy import explain

    raise ImportError(explain(_why)) from None

try:
    from . import env
    from .between import Attempt, BetweenTrials, Next
    from .calibration import Calibration, calibrate_population
    from .files import Experiment, Part, Rig, Scene
    from .fits import (
        LearningCurveFit,
        PsychometricFit,
        SingleRateFit,
        TwoRateFit,
        fit_learning_curve,
        fit_psychometric,
        fit_single_rate,
        fit_two_rate,
    )
    from .lifts import find_lift
    from .live import Live, Moment, observe
    from .person import Person, Seen
    from .power_analysis import power
    from .program import check, recover, replay, report, resume, run, shipped
    from .rehearsing import rehearse
    from .world import Body, Finger, World, step_all
except ImportError as _why:  # all of these need the program, or its module
    _missing: ImportError | None = _why
else:
    _missing = None

__version__: str = _facts.version()

__all__ = [
    "Attempt", "BetweenTrials", "Body", "Calibration", "Error", "Experiment", "Finger", "LearningCurveFit", "Live", "Moment", "Next", "NotThere",
    "Part", "Person", "Problem", "PsychometricFit", "Quantity", "Rehearsal", "Rig", "Scene", "Seen", "Session",
    "SingleRateFit", "Study", "TwoRateFit", "World", "calibrate_population", "check", "env", "find_lift", "fit_learning_curve", "fit_psychometric",
    "fit_single_rate", "fit_two_rate", "load", "observe", "plot", "power", "quantities", "quantity", "read_table", "recover",
    "rehearse", "replay", "report", "resume", "run", "shipped", "step_all",
]  # fmt: skip

if _missing is not None and not TYPE_CHECKING:
    from ._remedy import needs_program

    _whole, __all__ = __all__, [name for name in __all__ if name in globals()]

    def __getattr__(name: str) -> object:
        if name in _whole:
            raise ImportError(needs_program(name, _missing))
        raise AttributeError(f"module 'dihaptic' has no attribute '{name}'")
