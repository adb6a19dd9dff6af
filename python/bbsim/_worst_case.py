# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The point of the unit cube that is best on the worst of many cases, under requirements."""

from __future__ import annotations

import warnings
from typing import Any, Callable, List, Tuple

import numpy as np
from scipy.optimize import minimize

from ._scenario import Array

_CASES, _MORE, _ROUNDS = 16, 8, 9  # cases of the first search, those that a round adds, rounds
_SCANNED, _STEPS, _RUNS = 8, 10, 8  # points of the scan, for each number and 1; steps from a point; least runs of one
_FIRST, _LATER, _LAST = 0.2, 0.08, 0.003  # radii of steps
_MARGIN, _LITTLE, _RIDGE = 1e-3, 3e-4, 0.05  # of requirements; a gain that ends the search; of the models' curvature


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
        self.points: Array
        self.scores: Array
        self.merits: List[Any]

    def _in_all(self, point: Array, anew: bool = False) -> Any:
        """The merit of a point, and the cases that are worst by the objective and by each requirement, in turn."""
        scores, missed = (one[0] for one in self.score(point[None], self.all))
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
        merits, self.tried = [merit_of(*one, self.share) for one in zip(scores, missed)], self.tried + len(points)
        if self.share < 1:  # the cases that count depend on the point
            scores = np.stack([worst_of(one, self.share)[None] for one in scores])
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
                for one in dict.fromkeys([*order[: max(1, size // 2)], 0]):
                    self._descend(one, _FIRST)
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
