"""Writes the analysis of an experiment as two scripts that need nothing of this package: mixed models, in Python and in R."""

from __future__ import annotations

import json
import keyword
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from .data import ASIDE, WINDOW, Data
from .saving import is_changed, signed, write
from .words import label

#: Figures of lifts.csv that are analysed, unless the task measures the same.
_OF_LIFTS = ["peak_grip_rate_N_s", "static_grip_N", "safety_margin"]
#: Columns that distinguish the sessions of a study.
_OF_STUDY = ["study_session", "study_condition"]
#: Kinds of trials that do not show the late compensation of a block.
_PROBES = ["catch", "visual_clamp"]
#: Words of R that cannot be the names of columns in a formula.
_R_WORDS = {
    "if", "else", "repeat", "while", "function", "for", "next", "break", "in", "TRUE", "FALSE", "NULL", "Inf", "NaN", "NA",
}  # fmt: skip
#: Names that have a meaning of their own in patsy.
_PATSY_WORDS = {"C", "Q", "I", "T", "center", "standardize", "Treatment", "Sum", "Diff", "Poly", "Helmert"}
_WIDTH = 118
#: The script's last lines in Python, and in R, where effects are the same for all people that could differ.
_SAY_SHARED = """    if effects == MODELS[measure][-1][0]:
        for sentence in SHARED.get(measure, []):
            print(sentence)
"""
_SAY_SHARED_R = """  if (identical(model, tail(models[[measure]], 1)[[1]])) writeLines(as.character(shared[[measure]]))
"""
#: Between the terms of a model in R.
_R_LINE = ",\n                   "
#: Maximum number of parameters of an interaction.
_MOST_OF_PAIR = 12
#: Trials that each person's own effect needs, so that it can be told from the scatter of trials: for each level of words, and
#: for a slope over numbers.
_FEWEST_OF_LEVEL, _FEWEST_OF_SLOPE = 1.5, 3


def write_analyses(data: Data, folder: str | Path) -> list[Path]:
    """Writes `analysis.py` (statsmodels) and `analysis.R` (lme4) into the folder, and returns them. One that you have
    changed is left as it is, with a warning.

    Each is self-contained: it reads the tables that are written beside it (`analysis-trials.csv`, ...), fits a mixed
    model (REML) of each measure, and prints estimates with 95 % intervals, the numbers of people and of trials.
    Fixed effects are the factors of the design, with numbers centred and words compared with the first one. Each person has
    an intercept of their own and, of each factor that varies within people, an effect of their own, all independent of each
    other; without these, intervals are too narrow (Barr et al. 2013, doi:10.1016/j.jml.2012.11.001). Intervals use Student's t,
    with as many degrees of freedom as there are people less the parameters that differ between people. A second model adds
    the interaction of every two factors that the design crosses. For learning, the measure is the late compensation, by group
    and by round. Returns [] for one person, or for a design without factors.

    >>> from dihaptic import figures
    >>> figures.write_analyses(figures.read(lift_session), folder)
    []
    """
    if len(data.people) < 2:
        return []
    design = _of_learning(data) if data.has("adaptation") and data.has("fits") else _of_attempts(data)
    if design is None:
        return []
    into = Path(folder)
    into.mkdir(parents=True, exist_ok=True)
    written = []
    for language, text in ((".py", _python(data, design)), (".R", _r(data, design))):
        path = into / f"analysis{language}"
        written.append(path)
        if is_changed(path):
            kept = f"{path.name} has been changed, and is left as it is; remove it to have it written anew"
            warnings.warn(kept, stacklevel=2)
            continue
        write(path, (text + signed(text)).encode())
    for name in design.tables:
        path = into / f"analysis-{name}.csv"
        write(path, data.table(name).to_csv(index=False).encode())
        written.append(path)
    return written


@dataclass
class _Design:
    """What is fitted: the model of each measure, and what its factors are."""

    tables: list[str]
    models: dict[str, list[str]]  #: a measure's factors
    pairs: dict[str, list[tuple[str, str]]] = field(default_factory=dict)  #: pairs of these whose interaction can be estimated
    own: dict[str, list[tuple[str, ...]]] = field(default_factory=dict)  #: factors, and pairs, whose effects each person has
    between: dict[str, list[int]] = field(default_factory=dict)  #: numbers of each model's parameters that differ between people
    shared: dict[str, list[str]] = field(default_factory=dict)  #: sentences on effects that vary within people
    numbers: dict[str, str] = field(default_factory=dict)  #: a numeric factor's unit
    sizes: dict[str, str] = field(default_factory=dict)  #: a numeric factor's standard deviation
    words: dict[str, list[str]] = field(default_factory=dict)  #: levels in order
    of_lifts: list[str] = field(default_factory=list)  #: measures from lifts.csv
    late: dict[str, str] = field(default_factory=dict)  #: the block of each round that shows its late compensation
    unit: str = ""


def _of_attempts(data: Data) -> _Design | None:
    """The models of measures, and of lifts, over the last attempt at each trial."""
    trials = data.table("trials")
    if "attempt" not in trials:
        return None
    design = _Design(["trials"], {})
    own = [measure.column for measure in data.measures]
    if data.has("lifts"):
        lifts = data.table("lifts")
        design.of_lifts = [name for name in _OF_LIFTS if name in lifts and name not in trials and lifts[name].notna().any()]
        keys = [key for key in ("person", *_sitting(trials), "trial_num", "attempt") if key in lifts]
        trials = trials.merge(lifts[[*keys, *design.of_lifts]], on=keys, how="left")
        design.tables += ["lifts"] if design.of_lifts else []
    trials = trials.drop_duplicates(["person", *_sitting(trials), "trial_num"], keep="last")
    trials = trials[~trials["kind"].isin(ASIDE)]
    factors = data.factors or (["condition"] if trials["condition"].nunique() > 1 else [])
    _name_factors(data, trials, [*factors, "group", *_OF_STUDY], design)
    for measure in [*own, *design.of_lifts]:
        _add_model(trials, measure, design)
    return design if design.models else None


def _of_learning(data: Data) -> _Design | None:
    """The model of the late compensation over the last trials of the perturbed blocks, by group and by round."""
    table, fits = data.table("adaptation"), data.table("fits")
    if "late" not in fits or fits["late"].notna().sum() == 0:
        return None
    unit = str(fits.loc[fits["late"].notna(), "unit"].mode().iloc[0])
    table, fits = table[table["unit"] == unit].copy(), fits[fits["unit"] == unit].copy()
    for each in (table, fits):
        each["round"] = each["round"].fillna("").astype(str)
    late = _late_blocks(table, fits)
    design = _Design(["adaptation"], {}, late=late, unit=unit)
    table = table[(table["block"] == table["round"].map(late)) & ~table["kind"].isin(_PROBES)]
    table = table[table["compensation"].notna()].groupby(["person", *_sitting(table), "round"], sort=False).tail(WINDOW)
    _name_factors(data, table, ["group", "round", *_OF_STUDY], design)
    _add_model(table, "compensation", design)
    return design if design.models else None


def _add_model(rows: pd.DataFrame, measure: str, design: _Design) -> None:
    """Adds the model of a measure, unless its trials cannot separate any effect."""
    effects = _effects(rows, measure, design)
    if not effects:
        return
    design.models[measure] = effects
    design.pairs[measure] = pairs = _pairs(rows, measure, effects, design)
    known = rows.dropna(subset=[measure, *effects])
    meeting = (known.groupby("person")[effects].nunique() > 1).mean()  # the share of the people who meet several levels
    within = [name for name in effects if meeting[name] >= 0.5]
    of_one = [(name,) for name in within]
    both = [pair for pair in pairs if set(pair) <= set(within)]
    design.own[measure] = [names for names in [*of_one, *both] if _is_known_of_each(known, names, design)]
    between = [name for name in effects if name not in within]
    of_people = [pair for pair in pairs if set(pair) <= set(between)]
    design.between[measure] = [_parameters(known, between, [], design), _parameters(known, between, of_people, design)]
    reasons = {name: "few people meet several of its levels" for name in between if meeting[name] > 0}
    reasons.update({name: "each person has few trials" for name in within if (name,) not in design.own[measure]})
    design.shared[measure] = [_of_all_people(name, reason) for name, reason in reasons.items()]


def _of_all_people(name: str, reason: str) -> str:
    return (
        f"In this model, {name} has the same effect in all people, since {reason}. If people differ in it, its interval is too "
        "narrow."
    )


def _is_known_of_each(rows: pd.DataFrame, names: tuple[str, ...], design: _Design) -> bool:
    """Whether there are enough trials for an effect of each person's own."""
    words = [name for name in names if name in design.words]
    cells = rows.groupby(["person", *words], observed=True).size()
    return bool(cells.mean() >= (_FEWEST_OF_LEVEL if len(words) == len(names) else _FEWEST_OF_SLOPE))


def _late_blocks(table: pd.DataFrame, fits: pd.DataFrame) -> dict[str, str]:
    """For each round, the block whose last trials give the late mean of fits.csv; rounds without such a block are left out."""
    out = {}
    by = ["person", *_sitting(table)]
    for name, own in table[~table["kind"].isin(_PROBES) & table["compensation"].notna()].groupby("round", sort=False):
        late = fits[fits["round"] == name].set_index(by)["late"].dropna()
        for block, trials in own.groupby("block", sort=False):
            last = trials.groupby(by).tail(WINDOW).groupby(by)["compensation"].mean()
            both = pd.concat([last, late], axis=1, join="inner", keys=["last", "late"])
            if len(both) > 0 and np.allclose(both["last"], both["late"], rtol=1e-5, atol=1e-5):
                out[str(name)] = str(block)
    return out


def _sitting(table: pd.DataFrame) -> list[str]:
    """Columns that distinguish the sessions of a person, in which trials have the same numbers."""
    return [key for key in ("session", "study_session") if key in table]


def _name_factors(data: Data, rows: pd.DataFrame, names: list[str], design: _Design) -> None:
    """Notes the units of numeric factors, and the levels of the others in their order."""
    units = data.table(design.tables[0]).attrs.get("units", {})
    for name in dict.fromkeys(names):
        if name not in rows or rows[name].nunique() < 2:
            continue
        if pd.api.types.is_numeric_dtype(rows[name]):
            design.numbers[name] = str(units.get(name, "")) or "unit"
            design.sizes[name] = f"{rows[name].std():.3g}"
        else:
            known = data.levels(name) if name in data.table("trials") else list(rows[name].unique())
            levels = [str(value) for value in known if (rows[name] == value).any() and str(value)]
            if len(levels) > 1:
                design.words[name] = levels


def _effects(rows: pd.DataFrame, measure: str, design: _Design) -> list[str]:
    """The factors whose effects this measure's trials can separate; [] where it has too few trials, or people."""
    rows = rows[rows[measure].notna()]
    chosen: list[str] = []
    for name in [*design.words, *design.numbers]:
        # a factor that few of these trials have, such as one of another session of a study, is not used for this measure
        if rows[name].notna().sum() * 2 < len(rows):
            continue
        if _is_of_full_rank(rows, [*chosen, name], design):
            chosen.append(name)
    known = rows.dropna(subset=chosen)
    parameters = 3 + len(chosen)
    enough = known["person"].nunique() > 1 and len(known) > known["person"].nunique() + parameters
    return chosen if enough and known[measure].nunique() > 1 else []


def _pairs(rows: pd.DataFrame, measure: str, effects: list[str], design: _Design) -> list[tuple[str, str]]:
    """The pairs of a model's factors whose interactions can be separated from them and from each other."""
    rows = rows[rows[measure].notna()]
    chosen: list[tuple[str, str]] = []
    for pair in combinations(effects, 2):
        parameters = _parameters(rows, effects, [*chosen, pair], design)
        enough = len(rows.dropna(subset=effects)) > rows["person"].nunique() + parameters
        if enough and parameters - _parameters(rows, effects, chosen, design) <= _MOST_OF_PAIR:
            chosen += [pair] if _is_of_full_rank(rows, effects, design, [*chosen, pair]) else []
    return chosen


def _columns(
    rows: pd.DataFrame, names: list[str], design: _Design, pairs: Sequence[tuple[str, str]] = ()
) -> list[npt.NDArray[np.float64]]:
    """The columns of a model's matrix: of the intercept, of each factor, and of each interaction."""
    known = rows.dropna(subset=names)
    of: dict[str, list[npt.NDArray[np.float64]]] = {}
    for name in names:
        if name in design.numbers:
            centred = known[name] - known[name].mean()
            of[name] = [(centred / centred.std()).to_numpy()]
        else:
            present = [value for value in design.words[name] if (known[name].astype(str) == value).any()]
            of[name] = [(known[name].astype(str) == value).to_numpy(dtype=float) for value in present[1:]]
    products = [a * b for first, second in pairs for a in of[first] for b in of[second]]
    return [np.ones(len(known)), *(column for name in names for column in of[name]), *products]


def _parameters(rows: pd.DataFrame, names: list[str], pairs: list[tuple[str, str]], design: _Design) -> int:
    return len(_columns(rows, names, design, pairs))


def _is_of_full_rank(
    rows: pd.DataFrame, names: list[str], design: _Design, pairs: Sequence[tuple[str, str]] = ()
) -> bool:
    """Whether these effects can be separated."""
    known = rows.dropna(subset=names)
    if any(known[name].nunique() < 2 for name in names):
        return False
    columns = _columns(rows, names, design, pairs)
    return bool(np.linalg.matrix_rank(np.column_stack(columns)) == len(columns))


# Texts of both scripts


def _about(data: Data, design: _Design) -> list[str]:
    what = label("late compensation", design.unit) if design.late else "measures over attempts"
    return [
        f"Mixed models of {' '.join(data.title.split()) or 'an experiment'}: {what}, by the factors of the design.",
        "Each person has an intercept, and an effect of each factor that varies within people. Intervals are by Student's t.",
    ]


def _notes(design: _Design) -> list[str]:
    """Comments on the models."""
    notes = ["Numbers are centred, and words are compared with the first of them."]
    factors = [*design.words, *design.numbers]
    partial = [measure for measure, effects in design.models.items() if len(effects) < len(factors)]
    if partial:
        notes.append("Factors whose effects a measure's trials cannot separate are left out of its model.")
    if any(design.own.values()):
        notes.append("Where people hardly differ in an effect, statsmodels warns of a boundary, and lme4 of a singular fit.")
    if any(design.pairs.values()):
        notes.append("The second model of a measure adds interactions: how much the effect of one factor differs for the other.")
    return notes


def _formula_name(name: str, language: str) -> str:
    """A column's name as it is written in a formula."""
    plain = re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) is not None
    if language == "R":
        return name if plain and name not in _R_WORDS else f"`{name}`"
    return name if plain and not keyword.iskeyword(name) and name not in _PATSY_WORDS else f"Q({name!r})"


@dataclass
class _Model:
    """A model in a script's language."""

    effects: str  #: the formula of its fixed effects
    own: list[str]  #: the terms of a person's own effects
    between: int  #: number of parameters that differ between people


def _models(design: _Design, measure: str, language: str) -> list[_Model]:
    """The model of a measure's factors, and one that also has their interactions, if these can be estimated."""
    names = {name: _formula_name(name, language) for name in design.models[measure]}
    pairs = design.pairs[measure]
    out = []
    none: list[tuple[str, str]] = []
    for chosen, between in zip([none, pairs] if pairs else [none], design.between[measure]):
        effects = " + ".join([*names.values(), *(":".join(names[name] for name in pair) for pair in chosen)])
        own = [_own_effect(each, names, design, language) for each in design.own[measure] if len(each) == 1 or chosen]
        out.append(_Model(effects, own, between))
    return out


def _own_effect(factors: tuple[str, ...], names: dict[str, str], design: _Design, language: str) -> str:
    """The term of a person's own effect: of each level of words, and of numbers in units of their standard deviation."""
    words = [names[name] for name in factors if name in design.words]
    numbers = [f"I({names[name]} / {design.sizes[name]})" for name in factors if name in design.numbers]
    if language == "Python":
        return ":".join([*words, *numbers])
    return f"({'0 + ' + ':'.join(numbers) if numbers else '1'} | {':'.join(['person', *words])})"


def _laid_out(head: str, items: list[str], tail: str) -> str:
    """A list on one line if it fits there, and otherwise with an item on each line, farther to the right than its head."""
    line = f"{head}{', '.join(items)}{tail}"
    if len(line) <= _WIDTH:
        return line
    margin = "\n" + (len(head) - len(head.lstrip())) * " "
    return head + ",".join(f"{margin}    {item}" for item in items) + margin + tail


def _text(value: Any) -> str:
    """A string, in the notation that Python and R share."""
    return json.dumps(str(value), ensure_ascii=False)


def _items(values: list[str]) -> str:
    return ", ".join(map(_text, values))


def _vector(values: list[str]) -> str:
    """A vector of R."""
    return f"c({_items(values)})"


def _comment(notes: list[str]) -> str:
    return "\n".join(f"# {note}" for note in notes)


# In Python


def _python(data: Data, design: _Design) -> str:
    sitting = _sitting(data.table(design.tables[0]))
    about = "\n".join(line.replace("\\", "/").replace('"', "'") for line in _about(data, design))
    words = _laid_out("WORDS = {", [f"{_text(name)}: [{_items(levels)}]" for name, levels in design.words.items()], "}")
    numbers = _laid_out("NUMBERS = {", [f"{_text(name)}: {_text(unit)}" for name, unit in design.numbers.items()], "}")
    models = ""
    for name in design.models:
        each = [_python_model(model) for model in _models(design, name, "Python")]
        models += _laid_out(f"    {_text(name)}: [", each, "],") + "\n"
    rows = _python_late(design, sitting) if design.late else _python_attempts(design, sitting)
    shared = [f"{_text(name)}: [{_items(said)}]" for name, said in design.shared.items() if said]
    return f'''"""{about}
Run with python3 analysis.py; it needs the Debian package python3-statsmodels. analysis.R fits the same models.
"""

from pathlib import Path

import pandas as pd
import statsmodels.formula.api as smf
from patsy import dmatrix
from scipy.stats import t

{_comment(_notes(design))}
# Each model: its formula, the effects that differ from person to person, and the number of parameters between people.
{numbers}
{words}
MODELS = {{
{models}}}
{_laid_out("SHARED = {", shared, "}") + chr(10) if shared else ""}

def read(name):
    texts = {{column: str for column in ["person", "unit", *WORDS]}}
    return pd.read_csv(Path(__file__).resolve().parent / name, dtype=texts, keep_default_na=False, na_values=[""])


{rows}
for measure, (effects, own, between) in ((measure, of) for measure, each in MODELS.items() for of in each):
    known = rows[rows[measure].notna()].copy()
    scale = known[measure].std()  # the fit converges best where numbers are about 1
    known[measure] /= scale
    names = {{name: f"{{name}}, for each {{unit}}" for name, unit in NUMBERS.items()}}
    for name in NUMBERS:
        known[name] -= known[name].mean()
    for name, levels in WORDS.items():
        present = [level for level in levels if level in set(known[name])]
        known[name] = pd.Categorical(known[name], present)
        names.update({{f"{{name}}[T.{{level}}]": f"{{name}}: {{level}} - {{present[0]}}" for level in present[1:]}})
    known = known.loc[dmatrix(effects, known, return_type="dataframe").index]  # rows that have all of these factors
    of_person = {{term: f"0 + {{term}}" for term in own}}
    model = smf.mixedlm(f"{{measure}} ~ {{effects}}", known, groups="person", re_formula="1", vc_formula=of_person)
    fit = model.fit(reml=True, method="powell")
    half = t.ppf(0.975, max(1, model.n_groups - between)) * fit.bse_fe
    table = scale * pd.DataFrame({{"estimate": fit.fe_params, "low": fit.fe_params - half, "high": fit.fe_params + half}})
    what = "estimates"
    if effects != MODELS[measure][0][0]:
        what, table = "interactions", table.drop(index=["Intercept", *(name for name in names if name in table.index)])
    print(f"\\n{{measure}}: {{model.n_groups}} people, {{int(fit.nobs)}} trials; standard deviation between people")
    print(f"{{scale * fit.cov_re.iloc[0, 0] ** 0.5:.6g}}, within {{scale * fit.scale ** 0.5:.6g}}; {{what}} and 95 % intervals:")
    table.index = [names.get(row) or " x ".join(names.get(part, part) for part in row.split(":")) for row in table.index]
    print(table.to_string(float_format="{{:.6g}}".format))
{_SAY_SHARED if shared else ""}'''


def _python_model(model: _Model) -> str:
    formula, own = _text(model.effects), f"[{_items(model.own)}], {model.between}"
    line = f"({formula}, {own})"
    return line if len(line) < _WIDTH - 10 else f"({formula},\n         {own})"


def _python_attempts(design: _Design, sitting: list[str]) -> str:
    keys = ["person", *sitting, "trial_num"]
    text = f"""# The last attempt at each trial, without practice and catch trials
keys = [{_items(keys)}]
rows = read("analysis-trials.csv").drop_duplicates(keys, keep="last")
rows = rows[~rows["kind"].isin([{_items(ASIDE)}])]
"""
    if design.of_lifts:
        text += f"""lifts = read("analysis-lifts.csv")[[*keys, "attempt", {_items(design.of_lifts)}]]
rows = rows.merge(lifts, how="left")
"""
    return text


def _python_late(design: _Design, sitting: list[str]) -> str:
    late = ", ".join(f"{_text(name)}: {_text(block)}" for name, block in design.late.items())
    return f"""# The last {WINDOW} measured trials of the late block of each round
LATE = {{{late}}}
rows = read("analysis-adaptation.csv")
rows["round"] = rows["round"].fillna("").astype(str)
rows = rows[(rows["block"] == rows["round"].map(LATE)) & (rows["unit"] == {_text(design.unit)})]
rows = rows[~rows["kind"].isin([{_items(_PROBES)}])]
rows = rows.dropna(subset=["compensation"]).groupby([{_items(["person", *sitting, "round"])}]).tail({WINDOW})
"""


# In R


def _r(data: Data, design: _Design) -> str:
    sitting = _sitting(data.table(design.tables[0]))
    numbers = _laid_out("numbers <- c(", [f"`{name}` = {_text(unit)}" for name, unit in design.numbers.items()], ")")
    words = _laid_out("words <- list(", [f"`{name}` = {_vector(levels)}" for name, levels in design.words.items()], ")")
    models = ",\n".join(
        _laid_out(f"  `{name}` = list(", [_r_model(model) for model in _models(design, name, "R")], ")") for name in design.models
    )
    rows = _r_late(design, sitting) if design.late else _r_attempts(design, sitting)
    shared = [f"`{name}` = {_vector(said)}" for name, said in design.shared.items() if said]
    return f"""{_comment(_about(data, design))}
# Run with Rscript analysis.R; it needs the Debian package r-cran-lme4. analysis.py fits the same models.
suppressPackageStartupMessages(library(lme4))
options(width = 200)
script <- sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE))
if (length(script) == 1) setwd(dirname(gsub("~+~", " ", script, fixed = TRUE)))

{_comment(_notes(design))}
# Each model: its formula, the effects that differ from person to person, and the number of parameters between people.
{numbers}
{words}
models <- list(
{models}
)
{_laid_out("shared <- list(", shared, ")") + chr(10) if shared else ""}
read <- function(name) {{
  columns <- names(read.csv(name, nrows = 1, check.names = FALSE))
  texts <- intersect(c("person", "unit", names(words)), columns)
  read.csv(name, na.strings = "", check.names = FALSE, colClasses = sapply(texts, function(name) "character"))
}}

{rows}
for (measure in names(models)) for (model in models[[measure]]) {{
  known <- rows[!is.na(rows[[measure]]), ]
  for (name in names(numbers)) known[[name]] <- known[[name]] - mean(known[[name]], na.rm = TRUE)
  for (name in names(words)) known[[name]] <- droplevels(factor(known[[name]], levels = words[[name]]))
  formula <- paste(c(model$effects, "(1 | person)", model$own), collapse = " + ")
  fit <- lmer(as.formula(paste0("`", measure, "` ~ ", formula)), known, REML = TRUE)
  people <- ngrps(fit)[["person"]]
  half <- qt(0.975, max(1, people - model$between)) * sqrt(diag(as.matrix(vcov(fit))))
  table <- data.frame(estimate = fixef(fit), low = fixef(fit) - half, high = fixef(fit) + half)
  labels <- c("(Intercept)" = "Intercept")
  for (name in names(numbers)) labels[name] <- paste0(name, ", for each ", numbers[[name]])
  for (name in names(words)) for (level in levels(known[[name]])[-1])
    labels[paste0(name, level)] <- paste0(name, ": ", level, " - ", levels(known[[name]])[1])
  label <- function(row) if (row %in% names(labels)) labels[[row]] else row
  both <- function(row) paste(sapply(strsplit(row, ":", fixed = TRUE)[[1]], label), collapse = " x ")
  main <- model$effects == models[[measure]][[1]]$effects
  if (!main) table <- table[!rownames(table) %in% names(labels), ]
  rownames(table) <- sapply(rownames(table), if (main) label else both)
  cat("\\n", measure, ": ", people, " people, ", nobs(fit), " trials; standard deviation between people\\n", sep = "")
  variances <- as.data.frame(VarCorr(fit))
  between <- variances$sdcor[grepl("^person([.][0-9]+)?$", variances$grp) & variances$var1 == "(Intercept)"]
  cat(sprintf("%.6g, within %.6g; ", between, sigma(fit)))
  cat(if (main) "estimates" else "interactions", "and 95 % intervals:\\n")
  print(format(table, digits = 6, width = 10))
{_SAY_SHARED_R if shared else ""}}}
"""


def _r_model(model: _Model) -> str:
    own = f",\n           own = c({_R_LINE.join(map(_text, model.own))})" if model.own else ""
    return f"list(effects = {_text(model.effects)}, between = {model.between}{own})"


def _r_attempts(design: _Design, sitting: list[str]) -> str:
    keys = ["person", *sitting, "trial_num"]
    text = f"""# The last attempt at each trial, without practice and catch trials
keys <- {_vector(keys)}
rows <- read("analysis-trials.csv")
rows <- rows[!duplicated(rows[keys], fromLast = TRUE) & !rows$kind %in% {_vector(ASIDE)}, ]
"""
    if design.of_lifts:
        text += f"""lifts <- read("analysis-lifts.csv")[c(keys, "attempt", {_items(design.of_lifts)})]
rows <- merge(rows, lifts, all.x = TRUE)
"""
    return text


def _r_late(design: _Design, sitting: list[str]) -> str:
    order = ", ".join(f"rows${name}" for name in ["person", *sitting, "round"])
    return f"""# The last {WINDOW} measured trials of the late block of each round
rows <- read("analysis-adaptation.csv")
rows$round[is.na(rows$round)] <- ""
blocks <- {_vector(list(design.late.values()))}[match(rows$round, {_vector(list(design.late))})]
rows <- rows[!is.na(blocks) & rows$block == blocks & !rows$kind %in% {_vector(_PROBES)} & rows$unit == {_text(design.unit)}, ]
rows <- rows[!is.na(rows$compensation), ]
rows <- do.call(rbind, lapply(split(rows, list({order}), drop = TRUE), tail, {WINDOW}))
"""
