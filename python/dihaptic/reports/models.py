"""The models of learning that were fitted, and notes on fits whose parameters mean little."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from ..figures.data import Data, sitting_columns
from ..figures.words import counted
from .page import in_short, with_interval, without_empty

#: Parameters in fits.csv.
_PARAMETERS = {
    "A_slow": "slow retention", "B_slow": "slow learning", "A_fast": "fast retention", "B_fast": "fast learning",
    "A": "single-rate retention", "B": "single-rate learning",
}  # fmt: skip
#: Columns of adaptation.csv with the models' curves, and what they are.
_CURVES = {"two_rate": "two-rate model", "single_rate": "single-rate model"}
#: A parameter that is this close to a bound, or to the other retention, counts as equal to it (fits.csv has nine digits).
_NEAR = 1e-3
#: The share of the variance below which a model explains little.
_LITTLE = 0.2
#: Maximum number of notes; the most frequent ones are kept.
_MOST_NOTES = 6


def models_table(fits: pd.DataFrame, single: bool) -> pd.DataFrame:
    """The parameters of fits.csv, with a row for each group and round.

    For a `single` person, they are given with their intervals; for several people, as medians with quartiles.
    """
    rows = []
    several = fits["group"].nunique() > 1
    for (group, part), own in fits.groupby(["group", "round"], sort=False):
        row: dict[str, Any] = {"group": group if several else "", "round": part}
        for name, words in _PARAMETERS.items():
            if name not in own or own[name].notna().sum() == 0:
                continue
            if single:
                between = f" ({own[f'{name}_95'].iloc[0]})" if f"{name}_95" in own else ""
                row[words] = in_short(own[name].iloc[0]) + between
            else:
                # rates lie between 0 and 1, and are far from normally distributed over people
                low, middle, high = own.groupby("person")[name].mean().quantile([0.25, 0.5, 0.75])
                row[words] = with_interval(middle, low, high)
        if len(row) > 2:
            rows.append(row)
    return without_empty(pd.DataFrame(rows))


def notes_on_models(data: Data) -> str:
    """Sentences on fits whose parameters mean little, with the number of people, or of curves, that they hold for: a
    parameter, or the end of one person's interval, lies at its bound (0 or 1), the two retentions are equal, or the model
    explains little of the variance, or less than a constant. If there are many, only the most frequent ones. "" without any."""
    fits = data.table("fits")
    said = []
    for name, words in _PARAMETERS.items():
        known = fits[name].dropna() if name in fits else pd.Series(dtype=float)
        for bound in (0, 1):
            at = int(((known - bound).abs() < _NEAR).sum())
            if at:
                said.append((at, len(known), f"{words} lies at its bound {bound}"))
        reaching = sum(_reaches_bound(text) for text in fits.get(f"{name}_95", pd.Series(dtype=str)).dropna())
        if reaching and len(data.people) == 1:  # for one person, the intervals are on the page
            said.append((reaching, len(known), f"the interval of {words} reaches a bound"))
    if {"A_slow", "A_fast"} <= set(fits):
        known = (fits["A_slow"] - fits["A_fast"]).dropna()
        same = int((known < _NEAR).sum())
        if same:
            said.append((same, len(known), "slow and fast retention are equal, so that two processes cannot be told apart"))
    for column, words in _CURVES.items():
        shares = explained(data.table("adaptation"), column) if data.has("adaptation") else pd.Series(dtype=float)
        worse, little = int((shares <= 0).sum()), int(((shares > 0) & (shares < _LITTLE)).sum())
        if worse:
            said.append((worse, len(shares), f"the {words} fits no better than a constant"))
        if little:
            said.append((little, len(shares), f"the {words} explains less than {100 * _LITTLE:.0f} % of the variance"))
    one_each = not fits.duplicated("person").any()
    of = ("person", "people") if one_each else ("curve", "curves")
    said.sort(key=lambda each: -each[0] / each[1])
    texts = [f"in {n} of {counted(count, *of)} {what}" for n, count, what in said[:_MOST_NOTES]]
    return f"Read these parameters with care: {'; '.join(texts)}." if texts else ""


def _reaches_bound(interval: str) -> bool:
    """Whether an interval of fits.csv, such as "0.93 to 1", ends at 0 or 1, between which a rate lies."""
    low, _, high = interval.partition(" to ")
    return float(low) < _NEAR or float(high) > 1 - _NEAR


def explained(adaptation: pd.DataFrame, column: str) -> pd.Series:
    """The share of the variance of the measured compensation that a model's curve in adaptation.csv explains (R²), for each
    person and round; at most 0 where the model is no better than a constant."""
    if not {column, "compensation"} <= set(adaptation):
        return pd.Series(dtype=float)
    known = adaptation[adaptation[["compensation", column]].notna().all(axis=1)]
    shares = []
    for _, own in known.groupby([*sitting_columns(known), "round"], dropna=False, sort=False):
        rest = ((own["compensation"] - own[column]) ** 2).sum()
        whole = ((own["compensation"] - own["compensation"].mean()) ** 2).sum()
        shares.append(1 - rest / whole if whole > 0 else np.nan)
    return pd.Series(shares, dtype=float).dropna()
