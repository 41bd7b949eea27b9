"""Reads all of a session. Usage: try.py SESSION"""

import sys

import dihaptic as dh

session = dh.load(sys.argv[1])
tables = {name: session.table(name) for name in session.tables}
for name in session:
    values = session[name]
    assert len(values) > 0, name
    assert len(values) == len(session.t) or hasattr(values, "columns"), name
for name in session.bodies:
    assert session.unit(f"{name}.position.z") == "m"
assert len(session.trials) > 0 and session.trials.attrs["meanings"]
print("Python", sys.version.split()[0], "reads", session, len(tables), "tables,", len(session.keys()), "quantities")
