"""Dihaptic from Python: read sessions, fit, run experiments, step worlds.

    import dihaptic as dh

    session = dh.load("sessions/2026-11-26_lift-block")
    session.lifts                                   # pandas tables, units in attrs
    session["grip_force"], session["block.position"], session.t       # numpy arrays
    session.plot("grip_force", "load_force", align="lift_off")

docs/python.md shows what can be done, and help(dh) lists it.
"""

try:
    from . import _native
    from . import env
    from .between import Attempt, BetweenTrials, Next
    from .charts import plot
    from .errors import Error, NotThere, Problem
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
    from .program import check, recover, replay, report, resume, run, shipped
    from .rehearsal import Rehearsal, rehearse
    from .vocabulary import Quantity, quantities, quantity
    from .session import Session, load
    from .tables import read_table
    from .world import Body, Finger, World, step_all
except ImportError as _why:
    from ._remedy import explain

    raise ImportError(explain(_why)) from None

__version__: str = _native.version.split()[-1]

__all__ = [
    "Attempt", "BetweenTrials", "Body", "Error", "Experiment", "Finger", "LearningCurveFit", "Live", "Moment", "Next", "NotThere",
    "Part", "Person", "Problem", "PsychometricFit", "Quantity", "Rehearsal", "Rig", "Scene", "Seen", "Session",
    "SingleRateFit", "TwoRateFit", "World", "check", "env", "find_lift", "fit_learning_curve", "fit_psychometric",
    "fit_single_rate", "fit_two_rate", "load", "observe", "plot", "quantities", "quantity", "read_table", "recover", "rehearse",
    "replay", "report", "resume", "run", "shipped", "step_all",
]  # fmt: skip
