# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values of keys, such as gains, that are best on the worst of many rigs: bbsim.tune and `bbsim tune`."""

from __future__ import annotations

import re
import sys
import warnings
from types import SimpleNamespace
from typing import Any, Callable, Dict, List, Tuple

import numpy as np
from scipy.optimize import minimize

from . import _bbsim
from ._result import simulate
from ._scenario import (Array, InputError, Scenario, Settings, as_yaml, counted, fault, from_to, given, listed, require,
                        specification)  # fmt: skip
from ._task import (Progress, as_json, carry_out, files_of, read_free_key, refuse_free, refuse_twice, silent,
                    write_all)  # fmt: skip

_CASES, _MORE, _ROUNDS = 16, 8, 9  # cases of the first search, those that a round adds, rounds
_SCANNED, _STEPS, _RUNS = 8, 10, 8  # points of the scan, for each number and 1; steps from a point; least runs of one
_FIRST, _LATER, _LAST = 0.2, 0.08, 0.003  # radii of steps
_MARGIN, _LITTLE, _RIDGE = 1e-3, 3e-4, 0.05  # of requirements; a gain that ends the search; of the models' curvature
_SEARCHES, _TIGHTER = 4, 1.5  # a requirement is tightened by this times what it lacked on rigs held out
_LACKS_DRAW = "found, but no value is drawn; allowed: with --vary KEY=normal:MEAN:SD or uniform:FROM:TO"


def worst_of(scores: Array, share: float) -> Array:
    """The quantile over the cases: at least this share of them do not exceed it."""
    return np.sort(scores, axis=0)[max(1, int(np.ceil(share * len(scores) * (1 - 1e-12)))) - 1]


def merit_of(scores: Array, missed: Array, share: float) -> Tuple[float, float, float]:
    """Points are compared by their share of cases without a value, then by the excess, then by the objective."""
    worst = worst_of(scores, share)
    if np.isfinite(worst).all():
        return 0.0, float(worst[1:].max(initial=0)), float(worst[0])
    return float((~np.isfinite(scores).all(1) * (1 + missed)).mean()), 0.0, float(worst[0])


def _gains(before: Any, now: Any) -> bool:
    return any(new < old - _LITTLE * abs(new) for old, new in zip(before, now))


class Search:
    """`score(points, cases)` gives arrays (points, cases, 1 + requirements) and (points, cases): the objective and what
    each requirement lacks, 0 or less if it is met, infinite without a value; and the part of a run that was missed."""

    def __init__(self, score: Callable[[Array, Array], Tuple[Array, Array]], count: int, share: float = 1.0) -> None:
        self.score, self.all, self.share, self.tried, self.spread = score, np.arange(count), share, 0, 0
        self.merit: Tuple[float, ...] = (np.inf,) * 3  # of the best point that was tried in all cases
        self.best: Any = None
        self.points = self.scores = np.empty(0)
        self.merits: List[Any] = []

    def _in_all(self, point: Array, anew: bool = False) -> Any:
        """The merit of a point, and the cases that are worst by the objective and by each requirement, in turn."""
        scores, missed = (of_points[0] for of_points in self.score(point[None], self.all))
        merit, self.tried = merit_of(scores, missed, self.share), self.tried + 1
        if anew or merit < self.merit:
            self.merit, self.best = merit, point
        orders = np.stack([np.lexsort((-missed, -score)) for score in scores.T], 1)
        return merit, [*dict.fromkeys(orders.ravel())][:_MORE]

    def _around(self, point: Array, radius: float, count: int) -> Array:
        """The next points of a sequence that fills a cube evenly: multiples of irrational numbers."""
        ratio = 2.0
        for _ in range(50):
            ratio = (1 + ratio) ** (1 / (len(point) + 1))
        self.spread += count
        multiples = np.outer(np.arange(self.spread - count, self.spread) + 1, ratio ** -np.arange(1.0, len(point) + 1))
        return np.clip(point + radius * (2 * ((0.5 + multiples) % 1) - 1), 0, 1)

    def _take(self, points: Array, anew: bool = False) -> int:
        """Tries points in the chosen cases; returns the best one's place. `anew`: forgets the others."""
        scores, missed = self.score(points, self.cases)
        merits, self.tried = [merit_of(*its, self.share) for its in zip(scores, missed)], self.tried + len(points)
        if self.share < 1:  # the cases that count depend on the point
            scores = np.stack([worst_of(of_point, self.share)[None] for of_point in scores])
        if not anew:
            points, scores = np.concatenate([self.points, points]), np.concatenate([self.scores, scores])
        self.points, self.scores, self.merits = points, scores, merits if anew else self.merits + merits
        return len(points) - len(merits) + merits.index(min(merits))

    def _lowest(self, at: int, radius: float) -> Array:
        """Where quadratic models of all scores are lowest, within parts of the radius. The greatest score has kinks,
        which no such model follows; the score of a case has none."""
        size, base = self.points.shape[1], self.merits[at][2] if np.isfinite(self.merits[at][2]) else 0.0
        values = np.minimum((self.scores[..., 0] - base) / (abs(base) or 1), 3)
        excess = np.clip(self.scores[..., 1:] + _MARGIN, -1, 2).reshape(len(values), -1)
        scores = np.column_stack([values, excess, [merit[0] or -0.1 for merit in self.merits]])
        is_value = np.arange(scores.shape[1]) < values.shape[1]
        moves, (i, j) = (self.points - self.points[at]) / radius, np.triu_indices(size)
        terms = np.column_stack([np.ones(len(moves)), moves, moves[:, i] * moves[:, j]])
        weights = np.exp(-(moves**2).sum(1, keepdims=True) / (4 * max(1, size / 2)))
        ridge = np.diag([0.0, *[_RIDGE / 10] * size, *[_RIDGE] * len(i)])
        wanted = np.concatenate([weights * (scores - scores[at]), np.zeros((len(ridge), len(is_value)))])
        fitted = np.linalg.lstsq(np.concatenate([weights * terms, ridge]), wanted, rcond=None)[0]
        level, slope, bend = fitted[0] + scores[at], fitted[1 : 1 + size].T, np.zeros((len(is_value), size, size))
        bend[:, i, j] = fitted[1 + size :].T

        def slack(z: Array) -> Array:  # z: the move, a bound on the values, and one on the excesses, which matter more
            return np.where(is_value, z[-2], z[-1]) - level - (slope + bend @ z[:-2]) @ z[:-2]

        start, found = [*[0.0] * size, level[is_value].max(), max(0, level[~is_value].max())], []
        for part in (1, 0.5, 0.25):
            box = np.clip([-self.points[at] / radius, (1 - self.points[at]) / radius], -part, part).T
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # SLSQP's, on differences beyond the bounds
                z = minimize(lambda z: z[-2] + 100 * z[-1], start, bounds=[*box, (None, None), (0, None)],
                             constraints={"type": "ineq", "fun": slack}, method="SLSQP", options={"maxiter": 50}).x
            found.append(np.clip(self.points[at] + radius * z[:-2], 0, 1))
        return np.array(found)

    def _descend(self, at: int, radius: float) -> None:
        steps, stalled = 0, 0
        while radius > _LAST and steps < _STEPS and stalled < 3:
            around = self._around(self.points[at], radius, max(2, -(-_RUNS // len(self.cases)) - 3))
            now = self._take(np.concatenate([self._lowest(at, radius), around]))
            if self.merits[now] >= self.merits[at]:
                now = at
            moved = float(np.abs(self.points[now] - self.points[at]).max())
            steps, stalled = steps + 1, 0 if _gains(self.merits[at], self.merits[now]) else stalled + 1
            at, radius = now, min(2 * _FIRST, 2 * moved) if moved > 0.7 * radius else radius / 2

    def run(self, start: Array, again: bool = False) -> None:
        """Searches from a point and from the best of a scan; or `again` near a point, for other scores."""
        self.merit, size, stalled = (np.inf,) * 3, len(start), 0
        _, worst = self._in_all(start, anew=True)
        if not again:  # the worst cases, and some from all over
            some = np.linspace(0, self.all[-1], _CASES + 1).astype(int)
            self.cases = self.all if self.share < 1 else np.array([*dict.fromkeys([*worst, *some])][:_CASES])
        for turn in range(_ROUNDS):
            if turn == 0 and not again:
                scan = self._around(np.full(size, 0.5), 0.5, _SCANNED * (1 + size))
                self._take(np.concatenate([start[None], scan]), anew=True)
                order = sorted(range(len(scan) + 1), key=self.merits.__getitem__)
                for place in dict.fromkeys([*order[: max(1, size // 2)], 0]):
                    self._descend(place, _FIRST)
            else:
                near = self._around(self.best, _LATER, 2 * size)
                self._descend(self._take(np.concatenate([self.best[None], near]), anew=True), _LATER)
            before, best = self.merit, self.merits.index(min(self.merits))
            merit, worst = self._in_all(self.points[best])
            stalled = 0 if _gains(before, self.merit) else stalled + 1
            if stalled == 2:
                return
            if any(new > old + 1e-6 * abs(old) for new, old in zip(merit, self.merits[best])):  # beyond rounding
                self.cases = np.union1d(self.cases, worst)


class _Tuning:
    """Reads what is asked, runs rigs, and sums up."""

    reason = ""  # why a rig was lost or has no value

    def __init__(self, base: _bbsim.Given, options: Dict[str, Any]) -> None:
        self.base, self.share, self.vary = base, options["quantile"], options["vary"]
        self.threads = options["threads"] or 0
        if self.threads < 0:
            raise fault(f"--threads: found {self.threads}; allowed: 0, for one per processor, or more")
        if not 0 < self.share <= 1:
            raise fault(f"--quantile: found {self.share:g}; allowed: a share above 0 and up to 1, such as 0.95")
        if not options["free"]:
            refuse_free("found nothing; allowed: at least one KEY=FROM:TO")
        require("minimize", options["minimize"], str, "a measure")
        self.keys: List[Tuple[str, str, float, int]] = []  # name, unit, factor, place of its number
        free = np.array([self._read(text, place) for place, text in enumerate(options["free"])]).T
        self.bounds, self.start, names = free[:2], free[2], [key[0] for key in self.keys]
        refuse_twice(names)
        self.logarithmic = (free[0] > 0) & (free[1] > 10 * free[0])  # positive numbers over more than a decade
        base.changed(self.settings(self.start)).remarks()  # reads these values together
        self.goals = [base.expectation("--require", text) for text in options["require"]]
        measure, self.unit = base.measure_name("--minimize", options["minimize"])
        self.measures = [options["minimize"], *(re.split("[<>]", goal.text)[0].strip() for goal in self.goals)]
        moves = not all(goal.of_loop for goal in [base.expectation("", f"{self.measures[0]} < 0"), *self.goals])
        self.asked = [*dict.fromkeys(self.measures), *["end_t"] * moves]
        self.hold_out, draws = options["hold_out"], any(re.search("= *(normal|uniform):", text) for text in self.vary)
        for option, number in (("--samples", options["samples"]), ("--hold-out", self.hold_out)):
            if number and not draws:
                raise fault(f"{option}: {_LACKS_DRAW}")
        self.rigs, self.others = self.draw(options["samples"], 1), self.draw(self.hold_out or options["samples"], 2)
        for name in self.rigs:
            if name in names:
                raise fault(f"--vary: {name}: found among the free keys, too; allowed: one of the two")
        self.quick = base.without_notes([*names, *self.rigs], [measure, *(goal.measure for goal in self.goals)])
        self.end = base.value("time.end") or 1.0
        self.scenario("", self.start)  # fails before the work if the text cannot be written

    def _read(self, text: str, place: int) -> Tuple[float, float, float]:
        names, equals, bounds = (part.strip() for part in text.partition("="))
        if not equals:
            refuse_free(f"{names}: found no range; allowed: KEY=FROM:TO, such as controller.gravity_compensation.kp=1:20")
        tied = _bbsim.tied_keys(names)
        if tied[0][1] != 1:
            refuse_free(f"{names}: found a factor before the first key; allowed: KEY,FACTOR*KEY=FROM:TO")
        first = read_free_key(f"{tied[0][0]}={bounds}", self.base)
        self.keys += [(name, self.base.key_facts(name).unit, factor, place) for name, factor in tied]
        return first.lower, first.upper, first.start

    def draw(self, samples: Any, seed: int) -> Any:
        return {name: np.array(values) for name, values in self.base.drawn(self.vary, samples, seed)}

    def scaled(self, numbers: Array) -> Array:
        return np.where(self.logarithmic, np.log(np.where(self.logarithmic, numbers, 1)), numbers)

    def numbers(self, points: Array) -> Array:
        """The numbers at points between 0 and 1."""
        low, high = self.scaled(self.bounds)
        scaled = low + points * (high - low)
        return np.clip(np.where(self.logarithmic, np.exp(np.where(self.logarithmic, scaled, 0)), scaled), *self.bounds)

    def settings(self, numbers: Array) -> List[Tuple[str, str]]:
        return [(name, f"{float(factor * numbers[at])!r} {unit}".strip()) for name, unit, factor, at in self.keys]

    def scenario(self, comments: str, numbers: Array) -> str:
        return self.base.edited(self.settings(numbers), comments)

    def measured(self, points: Array, rigs: Any) -> Tuple[Array, Array]:
        """The measures of all rigs at all points, NaN where a run does not reach its end; the part that it missed."""
        numbers, shape = self.numbers(points), (len(points), _count(rigs))
        cases = {name: np.tile(values, len(points)) for name, values in rigs.items()}
        cases.update((name, np.repeat(factor * numbers[:, at], shape[1])) for name, _, factor, at in self.keys)
        try:
            runs = simulate(self.quick, cases, [], measures=self.asked, threads=self.threads)
        except InputError as error:  # no rig has such a scenario
            self.reason = str(error)
            return np.full((*shape, len(self.measures)), np.nan), np.ones(shape)
        done = runs.status == "done"
        for i in [i for i, why in enumerate(runs.reason) if why][-1:]:
            self.reason = runs.reason[i] if done[i] else f"{runs.status[i]}: {runs.reason[i]}"
        missed = np.where(done, 0, 1 - np.nan_to_num(runs.measures.get("end_t", 0.0)) / self.end)
        values = np.stack([np.where(done, runs.measures[name], np.nan) for name in self.measures], 1)
        return values.reshape(*shape, -1), np.clip(missed, 0, 1).reshape(shape)

    def scores(self, values: Array) -> Array:
        """The objective, and what each requirement lacks relative to its bound; infinite without a value."""
        scores = np.where(np.isfinite(values), values, np.inf)
        for i, goal in enumerate(self.goals, 1):
            lacks = (1 if goal.upper else -1) * (scores[..., i] - goal.value) / (abs(goal.value) or 1)
            lacks = np.where(lacks == 0, 0 if goal.holds(goal.value) else 1e-300, lacks)
            lacks = np.where(np.isfinite(values[..., i]), lacks, np.inf)
            endless = goal.of_loop and not goal.upper  # a margin that no change of gain or delay uses up
            scores[..., i] = np.where(endless & (values[..., i] == np.inf), -1, lacks)
        return scores

    def find(self, progress: Any) -> Any:
        """Searches; if a requirement fails on rigs held out, tightens it, goes on, and tries others."""
        seen: Dict[bytes, Array] = {}
        low, high = self.scaled(self.bounds)
        tighter, tries = np.zeros(len(self.goals)), []  # type: Array, List[Any]
        start = np.clip((self.scaled(self.start) - low) / (high - low), 0, 1)

        def score(points: Array, cases: Array) -> Tuple[Array, Array]:
            done = search.tried / (60 * (1 + len(start)))
            progress(done / (0.2 + done), f"{self.measures[0]} {search.merit[-1]:.3g}")
            values, missed = self.measured(points, {name: drawn[cases] for name, drawn in self.rigs.items()})
            if len(cases) == len(search.all):
                seen.update((point.tobytes(), its) for point, its in zip(points, values))
            return self.scores(values) + [0, *tighter], missed

        found, search = SimpleNamespace(interrupted=False), Search(score, _count(self.rigs), self.share)
        try:
            for turn in range(_SEARCHES if self.hold_out else 1):
                search.run(search.best if turn else start, again=turn > 0)
                if not self.hold_out:
                    break
                progress(0.99, "rigs held out")
                others = self.draw(self.hold_out, 2 + turn) if turn else self.others
                values, missed = (of_points[0] for of_points in self.measured(search.best[None], others))
                scores, drawn = self.scores(values), self.scores(seen[search.best.tobytes()])
                kept, held = merit_of(drawn, np.zeros(len(drawn)), self.share), merit_of(scores, missed, self.share)
                passes = np.isfinite(scores[:, 0]) & (scores[:, 1:] <= 0).all(1)
                tries.append((kept[:2], held[:2], kept[2], turn, search.best, passes, tighter))
                if kept[:2] > (0, 0) or held[1] == 0:
                    break
                tighter = tighter + _TIGHTER * np.maximum(worst_of(scores, self.share)[1:], 0)
        except KeyboardInterrupt:
            found.interrupted = True
        except InputError:  # the rigs of another draw are refused; those of the first were not
            pass
        *_, found.point, found.passes, found.tighter = min(tries) if tries else (search.best, [], tighter)
        if found.point is None:
            raise KeyboardInterrupt
        found.before, found.after, found.tried = seen[start.tobytes()], seen[found.point.tobytes()], search.tried
        return found

    def worst(self, values: Array, i: int) -> Tuple[float, bool, int]:
        """A measure of the worst rig that counts, whether that is good enough, and how many rigs have no value."""
        scores, sign = self.scores(values)[:, i], 1 if i == 0 or self.goals[i - 1].upper else -1
        value = sign * worst_of(np.where(np.isfinite(scores), sign * values[:, i], np.inf), self.share)
        good = np.isfinite(value) if i == 0 else worst_of(scores, self.share) <= 0
        return float(value), bool(good), int((~np.isfinite(scores)).sum())

    def result(self, found: Any) -> Any:
        short, numbers, reasons, count = _bbsim.short_number, self.numbers(found.point), [], len(found.after)
        result = SimpleNamespace(parameters=[], objective=0.0, requirements=[], interrupted=found.interrupted)
        keys = [["key", "before", "tuned", "from", "to", "unit"]]
        for name, unit, factor, at in self.keys:
            result.parameters.append(SimpleNamespace(key=name, value=float(factor * numbers[at])))
            its = factor * np.array([self.start[at], numbers[at], *self.bounds[:, at]])
            keys.append([name, *map(short, its), unit or "1"])
        rigs = f"the worst of {count} rigs" if self.share == 1 else f"the {short(self.share)} quantile of {count} rigs"
        rigs = "one rig" if count == 1 else rigs
        comments = f"# Tuned by bbsim {_bbsim.__version__} on {rigs}\n"
        measures = [["measure", "before", "tuned", "unit", "holds"]]
        for i, name in enumerate([self.measures[0], *(goal.text for goal in self.goals)]):
            unit, (value, good, lacking) = self.goals[i - 1].unit if i else self.unit, self.worst(found.after, i)
            holds = ("yes" if i else "-") if good else "no"
            holds += f": no value on {counted(lacking, 'rig')}" if lacking else ""
            measures.append([name, f"{self.worst(found.before, i)[0]:.3g}", f"{value:.3g}", unit or "1", holds])
            fails = " (does not hold)" if i and not good else ""
            comments += f"#   {name}{fails}: {short(value)} {unit}".rstrip() + "\n"
            if i:
                result.requirements.append(SimpleNamespace(text=name, value=value, holds=good))
                reasons += [] if good else [f"{name}; the best has {short(value)} {unit}".rstrip()]
            else:
                result.objective = value
        if not reasons and not np.isfinite(result.objective):
            reasons.append(f"a finite {self.measures[0]}")
        lines = [f"tune: found no values with {reason}" for reason in reasons]
        lines += [f"  a rig: {self.reason}"] if reasons and self.reason else []
        if found.interrupted:
            lines.insert(0, f"tune: interrupted after {found.tried} tries; the result is the best of them")
        result.met, result.reason = not reasons, "\n".join(lines)
        result.report = f"{_bbsim.aligned(keys)}\n{_bbsim.aligned(measures)}\non {rigs}; {found.tried} tries\n"
        share = float(np.mean(found.passes)) if len(found.passes) else None
        result.hold_out = SimpleNamespace(cases=len(found.passes), share_that_holds=share)
        if share is not None:
            text = f"ll requirements hold on {_bbsim.rounded(100 * share, 4)} % of {len(found.passes)} rigs held out"
            result.report, comments = f"{result.report}a{text}\n", f"{comments}# A{text}.\n"
        for goal, part in zip(self.goals, found.tighter):
            if part:
                spare = _bbsim.rounded(100 * part, 2)
                result.report += f"searched for {goal.text} with {spare} % to spare, for rigs held out\n"
        result.scenario = self.scenario(comments, numbers)
        return result


def _count(rigs: Any) -> int:
    return len(next(iter(rigs.values()), [0]))


def tune(scenario: Scenario, free: Any, minimize: str, require: Any = (), vary: Any = (), samples: Any = None,
         hold_out: Any = None, quantile: float = 1, *, set: Settings = None, output: Any = None, json: Any = None,
         threads: int = 0) -> Any:  # fmt: skip
    """Finds the values of keys at which a measure is smallest on the worst of many rigs. Arguments are the options of
    ``bbsim tune``; `free` and `vary` may be dicts.

    The result has the names of the JSON, in SI units. `met` says whether all requirements hold and the measure is
    finite, `reason` why not; `report` is the printed text, `scenario` that of the tuned scenario. An interrupted search
    gives the best. Raises InputError and OutputError.
    """
    options = dict(locals())
    written = {"free": from_to, "require": as_yaml, "vary": specification}
    options.update((name, listed(name, options[name], its)) for name, its in written.items())
    return _carry_out(given(scenario, set), options, silent, lambda text: None)


def _carry_out(base: _bbsim.Given, options: Dict[str, Any], progress: Progress, say: Any) -> Any:
    files = files_of(options, base, {}, "output", "json")
    tuning = _Tuning(base, options)
    for remark in base.remarks():
        say(remark)
    result = tuning.result(tuning.find(progress))
    progress(1, "")
    told = {name: getattr(result, name) for name in ("parameters", "objective", "requirements", "hold_out")}
    write_all(base, files, {"output": result.scenario, "json": as_json(told)}, say)
    return result


def command(options: Dict[str, Any], say: Any) -> int:
    options["quantile"] = 1 if options["quantile"] is None else options["quantile"]
    result = carry_out("tune", _carry_out, options, say)
    sys.stderr.write(result.reason + "\n" if result and result.reason else "")
    return 130 if not result or result.interrupted else 0 if result.met else 1
